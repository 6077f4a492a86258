//! Hints in the status bar: the effects of the mouse buttons at the mouse.

use std::borrow::Cow;

use egui::{Color32, Id, Painter, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::labels;
use crate::session::{Grip, Navigation, Session};

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
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session) {
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
        Grip::Hand(_) => "drag the hand",
        Grip::Pole(_) | Grip::LimbPole(..) => "drag the Pole",
        Grip::Root(_) => "drag the Root",
        Grip::Twist | Grip::Limb => "turn the elbow",
        Grip::UpperLimb => "turn the shoulder",
        Grip::HandRing(_) => "rotate the hand",
        Grip::Shoulder(_) | Grip::Bend => "rotate the joint",
        Grip::Ring(..) | Grip::Orientation(..) => return format!("rotate {name}").into(),
        Grip::Tip(..) | Grip::Target(..) => return format!("drag {name}").into(),
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
    use super::*;
    use crate::kinematics::skeleton::JointId;
    use crate::session::PointHandle;

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
        assert_eq!(spoken(Grip::Twist, ""), ["left drag: turn the elbow", "wheel: zoom"]);
        let tip = Grip::Tip(JointId::new(0), PointHandle::Free);
        assert_eq!(spoken(tip, "pelvis")[0], "left drag: drag pelvis");
    }
}
