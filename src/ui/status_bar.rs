//! The status bar: the offset and shortcuts of a drag, the current message, or a description of the
//! pose; and what the mouse buttons do.

use std::borrow::Cow;
use std::time::Duration;

use egui::{
    Align, Color32, Id, Label, Layout, Painter, Pos2, ProgressBar, Rect, Role, Sense, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};

use super::widgets::{self, text};
use super::{labels, pose_summary};
use crate::kinematics::chain_ik::Swing;
use crate::kinematics::skeleton::Joint;
use crate::session::{
    Actions, Drag, DragLimit, ExportJob, FileAction, Grip, JointEdit, Navigation, PointDrag,
    Session, ShellAction, TurnDrag, WiggleTarget, WiggleView,
};

/// Height in points.
pub(in crate::ui) const HEIGHT: f32 = 24.0;

/// Seconds for which a message stays, and for which an error does.
const MESSAGE_SECONDS: f64 = 12.0;
const ERROR_SECONDS: f64 = 30.0;

/// A message with the time at which it was first shown, in seconds.
#[derive(Clone, Default, PartialEq)]
struct ShownMessage {
    text: String,
    since: f64,
}

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    expire(ui, session, actions);
    ui.horizontal(|ui| {
        ui.set_height(HEIGHT);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            // The keys of a drag need the whole line.
            if session.history().drag().is_none() {
                mouse_hints(ui, session);
            }
            if let Some(job) = session.files().job() {
                show_job(ui, job, actions);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if session.files().seems_z_up() && session.history().drag().is_none() {
                    offer_turn(ui, actions);
                }
                let is_error = session.history().drag().is_none() && session.shell().has_failed();
                if is_error {
                    widgets::error_label(ui, &line(session));
                } else {
                    ui.add(Label::new(line(session)).truncate().selectable(false));
                }
            });
        });
    });
}

/// Removes the message once its time is over.
fn expire(ui: &Ui, session: &Session, actions: &mut Actions) {
    let (id, now) = (Id::unique("shown message"), ui.input(|input| input.time));
    let Some(text) = session.shell().message() else {
        return ui.data_mut(|data| data.remove::<ShownMessage>(id));
    };
    let shown: ShownMessage = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    if shown.text != text {
        let shown = ShownMessage { text: text.to_owned(), since: now };
        ui.data_mut(|data| data.insert_temp(id, shown));
        return expire(ui, session, actions);
    }
    let stays = if session.shell().has_failed() { ERROR_SECONDS } else { MESSAGE_SECONDS };
    let left = shown.since + stays - now;
    if left > 0.0 {
        ui.ctx().request_repaint_after(Duration::from_secs_f64(left));
    } else {
        actions.push(ShellAction::ClearMessage);
    }
}

/// Offers to turn a skeleton that stands along z.
fn offer_turn(ui: &mut Ui, actions: &mut Actions) {
    ui.add(Label::new("z seems to point up:").selectable(false));
    let tooltip = "Turn the skeleton by −90° about x";
    if ui.small_button("Turn to y up").on_hover_text(tooltip).clicked() {
        actions.push(JointEdit::TurnYUp);
    }
    if ui.small_button("Leave").on_hover_text("Keep the axes of the file").clicked() {
        actions.push(FileAction::DeclineTurn);
    }
    ui.separator();
}

/// Shows the progress of an export, and a button that cancels it.
fn show_job(ui: &mut Ui, job: &ExportJob, actions: &mut Actions) {
    ui.ctx().request_repaint_after(Duration::from_millis(100));
    if ui.small_button("Cancel").on_hover_text("Cancel the export; no file is written").clicked() {
        actions.push(FileAction::CancelExport);
    }
    let name = job.path.file_name().unwrap_or(job.path.as_os_str()).to_string_lossy();
    let part = job.progress.part();
    let bar = ProgressBar::new(part).desired_width(140.0).text(format!("{:.0} %", part * 100.0));
    ui.add(bar).on_hover_text(format!("Exporting {}", job.path.display()));
    ui.add(Label::new(format!("Exporting {name}")).selectable(false));
}

fn line(session: &Session) -> String {
    if let Some(drag) = session.history().drag() {
        return describe_drag(session, drag);
    }
    if let Some(wiggle) = session.view().wiggle_view(session.posed()) {
        return describe_wiggle(session, &wiggle);
    }
    session.shell().message().map_or_else(|| pose_summary::describe(session), ToOwned::to_owned)
}

/// Describes the angle that swings, and how the residual changes with it.
fn describe_wiggle(session: &Session, wiggle: &WiggleView) -> String {
    let Swing { joint, axis, .. } = wiggle.swing;
    let name = session.skeleton().joint(joint).map_or("", |joint| &joint.name);
    let by = wiggle.by.to_degrees();
    let turn = format!("Wiggle {name} about {axis}: {by:+.1}°");
    match wiggle.target {
        Some(WiggleTarget { before, now, predicted, .. }) => format!(
            "{turn}, error {:+.4}; the Jacobian predicts {:+.4}",
            now - before,
            predicted - before
        ),
        None => turn,
    }
}

fn describe_drag(session: &Session, drag: &Drag) -> String {
    match (drag.point(), drag.turn()) {
        (Some(point), _) => describe_move(session, drag, point),
        (_, Some(turn)) => describe_turn(session, drag.grip(), turn),
        (None, None) => String::new(),
    }
}

fn describe_move(session: &Session, whole: &Drag, drag: &PointDrag) -> String {
    let grip = whole.grip();
    let moved = drag.moved();
    let how = drag.constraint().map_or("freely".to_owned(), |constraint| constraint.to_string());
    let name = labels::grip(session, grip);
    let verb = match grip {
        Grip::Tip(joint, _)
            if session.skeleton().joint(joint).is_some_and(Joint::is_root_point) =>
        {
            format!("Move {name}")
        }
        Grip::Tip(..) | Grip::Bone(_) => format!("Pose {name}"),
        Grip::Target(..) => "Target".to_owned(),
        Grip::Head(..) => "Head".to_owned(),
        Grip::LimbPole(..) => "Pole".to_owned(),
        Grip::Aim(..) => "Aim".to_owned(),
        _ => "Move".to_owned(),
    };
    // A figure is measured in metres, a measured limb in smaller units.
    let step = if session.shown().measured_limb().is_some() { 0.1 } else { 1.0 };
    let digits = text::decimals_of_cell(session.shown().grid_cell() * step);
    let [x, y, z] = moved.to_array().map(|way| {
        if text::has_overflowed(way.into()) {
            text::OVERFLOW.to_owned()
        } else {
            format!("{way:+.digits$}")
        }
    });
    let held = whole.limit().map_or_else(String::new, |limit| held(session, limit));
    format!(
        "{verb} {how}: {x}, {y}, {z}{held}{}     Shift precise · Ctrl snap · X Y Z lock · digits type · Enter accept · Esc cancel",
        typed(drag.typed()),
    )
}

/// Says that the targets of a body keep the dragged point from the mouse; empty if they do not.
fn held(session: &Session, limit: &DragLimit) -> String {
    /// Distance, as a part of the figure's reach, that can be seen.
    const SEEN: f32 = 2e-3;
    if limit.short <= SEEN * session.rig().reach() {
        return String::new();
    }
    format!(" · its targets hold it {} short", text::short(limit.short))
}

/// Describes a rotation: the applied angle, which at a joint limit is less than the angle of the
/// mouse, and the shortcuts of the drag.
fn describe_turn(session: &Session, grip: Grip, drag: &TurnDrag) -> String {
    const AT_LIMIT: f32 = 1e-5;
    let joints = session.skeleton().joints();
    let angle = match grip {
        Grip::Ring(joint, axis) => {
            joints.get(joint.index()).map(|joint| joint.rotation[axis.index()])
        }
        Grip::Limit(joint, end) => {
            joints.get(joint.index()).and_then(|joint| joint.angle_of_end(end))
        }
        _ => None,
    };
    let turned = angle.map_or(drag.turned(), |angle| drag.turned_to(angle));
    let limit = if (turned - drag.turned()).abs() > AT_LIMIT { ", at its limit" } else { "" };
    let verb = match grip {
        Grip::Ring(_, axis) | Grip::Orientation(_, axis) => format!("Rotate about {axis}"),
        Grip::LimbTwist(_) | Grip::Bone(_) => "Socket twist".to_owned(),
        Grip::Limit(_, end) => text::capitalized(&labels::limit_end(end)),
        _ => "Bend".to_owned(),
    };
    format!(
        "{verb}: {:+.1}°{limit}{}     Shift precise · Ctrl snap · digits type · Enter accept · Esc cancel",
        turned.to_degrees(),
        typed(drag.typed()),
    )
}

fn typed(typed: &str) -> String {
    match typed {
        "" => String::new(),
        typed => format!(" · typed {typed}"),
    }
}

/// Size of the icon of a mouse in points.
const ICON: egui::Vec2 = vec2(11.0, 15.0);

/// A part of the mouse that is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MousePart {
    Left,
    Middle,
    Right,
    Wheel,
    /// Fingers on a trackpad.
    Fingers,
}

/// One use of the mouse: keys held, part of the mouse, and effect.
type MouseHint = (&'static str, MousePart, Cow<'static, str>);

/// Remembers the handle at the mouse for the status bar, which is laid out before the viewport.
pub(in crate::ui) fn set_pointed(ui: &Ui, pointed: Option<Grip>) {
    let before = ui.data_mut(|data| data.get_temp::<Option<Grip>>(id()).flatten());
    if before != pointed {
        ui.data_mut(|data| data.insert_temp(id(), pointed));
        ui.request_repaint();
    }
}

fn id() -> Id {
    Id::unique("handle at the mouse")
}

/// Shows the hints from right to left.
fn mouse_hints(ui: &mut Ui, session: &Session) {
    let pointed = ui.data(|data| data.get_temp::<Option<Grip>>(id()).flatten());
    let named = pointed.map(|grip| (grip, labels::grip(session, grip)));
    let named = named.as_ref().map(|(grip, name)| (*grip, name.as_str()));
    let hints = hints(session.preferences().navigation, named);
    for hint in hints.into_iter().rev() {
        show(ui, &hint);
    }
}

/// The hints at a place, or over a grip with a name.
fn hints(navigation: Navigation, pointed: Option<(Grip, &str)>) -> Vec<MouseHint> {
    use MousePart::{Fingers, Left, Middle, Right, Wheel};
    let view = match navigation {
        Navigation::Default => [("", Left, "orbit"), ("", Right, "pan"), ("", Wheel, "zoom")],
        Navigation::Blender => {
            [("", Middle, "orbit"), ("Shift+", Middle, "pan"), ("", Wheel, "zoom")]
        }
        Navigation::Maya => [("Alt+", Left, "orbit"), ("Alt+", Middle, "pan"), ("", Wheel, "zoom")],
        Navigation::Trackpad => [
            ("", Fingers, "two fingers: orbit"),
            ("Shift+", Fingers, "pan"),
            ("", Fingers, "pinch: zoom"),
        ],
    };
    let [orbit, pan, zoom] = view.map(|(keys, part, effect)| (keys, part, Cow::from(effect)));
    match pointed {
        Some((grip @ Grip::Ring(..), name)) => {
            vec![("", Left, drag_of(grip, name)), ("Alt: ", Fingers, "wiggle".into()), zoom]
        }
        Some((grip, name)) => vec![("", Left, drag_of(grip, name)), zoom],
        None => vec![orbit, pan, zoom],
    }
}

/// Effect of a drag of a grip with a name.
fn drag_of(grip: Grip, name: &str) -> Cow<'static, str> {
    let effect = match grip {
        Grip::LimbPole(..) => "drag the Pole",
        Grip::Ring(..) | Grip::Orientation(..) => return format!("rotate {name}").into(),
        Grip::LimbTwist(_) => return format!("turn {name} about its Pointer").into(),
        Grip::Limit(..) => return format!("move {name}").into(),
        Grip::Tip(..) | Grip::Bone(_) | Grip::Target(..) | Grip::Aim(..) => {
            return format!("drag {name}").into();
        }
        Grip::Head(..) => "drag the head",
    };
    effect.into()
}

fn show(ui: &mut Ui, hint: &MouseHint) {
    let (keys, part, effect) = hint;
    let font = egui::TextStyle::Body.resolve(ui.style());
    let colour = ui.visuals().weak_text_color();
    let layout = |text: &str| ui.painter().layout_no_wrap(text.to_owned(), font.clone(), colour);
    let (before, after) = (layout(keys), layout(effect));
    let has_icon = *part != MousePart::Fingers;
    let icon = if has_icon { ICON.x + 5.0 } else { 0.0 };
    let size = vec2(before.size().x + icon + after.size().x + 6.0, ui.available_height());
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, spoken(hint)));
    let top = rect.center().y - before.size().y / 2.0;
    let middle = rect.left() + before.size().x;
    let place = pos2(middle + icon, top);
    let painter = ui.painter();
    painter.galley(pos2(rect.left(), top), before, colour);
    painter.galley(place, after, colour);
    if has_icon {
        paint(painter, pos2(middle + 1.0, rect.center().y - ICON.y / 2.0), *part, colour);
    }
}

fn spoken((keys, part, effect): &MouseHint) -> String {
    let part = match part {
        MousePart::Left => "left drag: ",
        MousePart::Middle => "middle drag: ",
        MousePart::Right => "right drag: ",
        MousePart::Wheel => "wheel: ",
        MousePart::Fingers => "",
    };
    format!("{keys}{part}{effect}")
}

/// Draws a mouse with one part filled. `at` is the upper left corner.
fn paint(painter: &Painter, at: Pos2, part: MousePart, colour: Color32) {
    let mouse = Rect::from_min_size(at, ICON);
    let middle = mouse.center().x;
    let buttons = mouse.top() + 6.5;
    let filled = match part {
        MousePart::Left => Some((mouse.left(), middle)),
        MousePart::Right => Some((middle, mouse.right())),
        MousePart::Middle | MousePart::Wheel | MousePart::Fingers => None,
    };
    if let Some((left, right)) = filled {
        let button = Rect::from_min_max(pos2(left, mouse.top()), pos2(right, buttons));
        painter.with_clip_rect(button).rect_filled(mouse, 5.0, colour);
    } else {
        let wheel = Rect::from_center_size(pos2(middle, mouse.top() + 4.5), vec2(3.0, 6.0));
        painter.rect_filled(wheel, 1.5, colour);
    }
    let line = Stroke::new(1.0, colour);
    painter.rect_stroke(mouse, 5.0, line, egui::StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use crate::kinematics::skeleton::JointId;
    use crate::session::PointHandle;
    use crate::ui::status_bar::*;

    #[test]
    fn each_navigation_tells_how_to_orbit_pan_and_zoom() {
        for navigation in Navigation::ALL {
            let spoken: Vec<_> = hints(navigation, None).iter().map(spoken).collect();
            for (hint, effect) in spoken.iter().zip(["orbit", "pan", "zoom"]) {
                assert!(hint.ends_with(effect), "{navigation:?}: {hint}");
            }
        }
    }

    #[test]
    fn at_a_handle_the_hints_tell_what_a_drag_of_it_does() {
        let spoken = |grip, name| -> Vec<_> {
            hints(Navigation::Default, Some((grip, name))).iter().map(spoken).collect()
        };
        let twist = Grip::LimbTwist(JointId::default());
        assert_eq!(
            spoken(twist, "the arm"),
            ["left drag: turn the arm about its Pointer", "wheel: zoom"]
        );
        let tip = Grip::Tip(JointId::new(0), PointHandle::Free);
        assert_eq!(spoken(tip, "pelvis")[0], "left drag: drag pelvis");
    }
}
