//! The outliner: the tree of joints, their selection, and buttons that edit the tree.

use egui::{
    Align2, Color32, Key, Painter, Pos2, Response, RichText, Role, ScrollArea, Sense, TextStyle,
    Ui, WidgetInfo, pos2, vec2,
};

use crate::kinematics::skeleton::JointId;
use crate::session::{Actions, JointEdit, SelectAction, Session};
use crate::ui::keyboard::{focus, viewport};
use crate::ui::{commands, style, widgets};

const ROW: f32 = 20.0;
const INDENT: f32 = 13.0;
const ROWS: f32 = 9.0;

const NONE_SELECTED: &str = "Select a joint first";

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    // The buttons are above the tree: below it they would move under the mouse as the tree grows.
    buttons(ui, session, actions);
    ui.add_space(4.0);
    tree(ui, session, actions);
}

/// True if a row of the tree had the keyboard focus in the previous frame.
#[derive(Clone, Copy, Default)]
struct OutlinerFocus(bool);

/// A joint with its depth in the tree.
struct OutlinerRow {
    joint: JointId,
    depth: usize,
    /// Influence of the targets that turn the joint.
    influence: f32,
    /// True if the target that ends here is enabled; `None` without a target.
    target: Option<bool>,
}

fn tree(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rows = rows(session);
    let height = ROW * ROWS.min(rows.len().max(1) as f32);
    let area = ScrollArea::both().auto_shrink([false, false]).max_height(height);
    let mut pointed = None;
    area.id_salt("joints").show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut focused = OutlinerFocus(false);
        for row in &rows {
            let response = show(ui, session, row);
            if response.hovered() {
                pointed = Some(row.joint);
            }
            focused.0 |= response.has_focus();
            respond(ui, session, &rows, row, &response, actions);
        }
        ui.data_mut(|data| data.insert_temp(ui.scope_id(), focused));
    });
    let said = ui.make_persistent_id("pointed in the tree");
    let was = ui.data(|data| data.get_temp::<bool>(said)).unwrap_or(false);
    if pointed.is_some() && pointed != session.selection().hovered() || was && pointed.is_none() {
        actions.push(SelectAction::Hover(pointed));
    }
    ui.data_mut(|data| data.insert_temp(said, pointed.is_some()));
    if rows.is_empty() {
        ui.weak("No joints. Add a root to start.");
    } else {
        legend(ui);
    }
}

/// Rows in depth-first order, so that children follow their parent.
fn rows(session: &Session) -> Vec<OutlinerRow> {
    let skeleton = session.skeleton();
    let mut children = vec![Vec::new(); skeleton.joints().len()];
    let mut open = Vec::new();
    for (joint, it) in skeleton.iter().rev() {
        match it.parent {
            Some(parent) => children[parent.index()].push(joint),
            None => open.push((joint, 0)),
        }
    }
    let rig = session.rig();
    let influences = rig.influences();
    let mut targets = vec![None; children.len()];
    for target in &rig.targets {
        targets[rig.end_of(target).index()] = Some(target.enabled);
    }
    let mut rows = Vec::with_capacity(children.len());
    while let Some((joint, depth)) = open.pop() {
        open.extend(children[joint.index()].iter().map(|&child| (child, depth + 1)));
        let (influence, target) = (influences[joint.index()], targets[joint.index()]);
        rows.push(OutlinerRow { joint, depth, influence, target });
    }
    rows
}

fn show(ui: &mut Ui, session: &Session, row: &OutlinerRow) -> Response {
    let rig = session.rig();
    let joint = &rig.skeleton[row.joint];
    let selected = session.selection().joints().contains(&row.joint);
    let indent = INDENT * row.depth.min(12) as f32;
    let font = TextStyle::Body.resolve(ui.style());
    let width = ui.fonts_mut(|fonts| {
        let white = egui::Color32::WHITE;
        fonts.layout_no_wrap(joint.name.clone(), font.clone(), white).size().x
    });
    let marks = if row.target.is_some() { 44.0 } else { 24.0 };
    let size = vec2(ui.available_width().max(indent + width + marks), ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(Role::Button, true, selected, format!("Joint {}", joint.name))
    });
    if !ui.is_rect_visible(rect) {
        reveal(ui, session, row, &response);
        return response;
    }
    let visuals = ui.visuals();
    let painter = ui.painter();
    if selected {
        painter.rect_filled(rect, 4.0, visuals.selection.bg_fill);
    } else if response.hovered() || session.selection().hovered() == Some(row.joint) {
        painter.rect_filled(rect, 4.0, visuals.widgets.hovered.weak_bg_fill);
    }
    if response.has_focus() {
        let inside = rect.shrink(1.0);
        painter.rect_stroke(inside, 4.0, visuals.selection.stroke, egui::StrokeKind::Inside);
    }
    for depth in 0..row.depth.min(12) {
        let x = rect.left() + 8.0 + INDENT * depth as f32;
        painter.vline(x, rect.y_range(), visuals.widgets.noninteractive.bg_stroke);
    }
    let at = pos2(rect.left() + indent + 8.0, rect.center().y);
    let palette = style::palette(ui);
    if joint.locked {
        locked_dot(painter, at, style::colour(palette.joint));
    } else {
        let colour = palette.upper.mixed(palette.accent, row.influence);
        free_dot(painter, at, style::colour(colour));
    }
    let text = if selected { visuals.strong_text_color() } else { visuals.text_color() };
    painter.text(at + vec2(9.0, 0.0), Align2::LEFT_CENTER, &joint.name, font, text);
    if let Some(enabled) = row.target {
        let colour = if enabled { style::accent(ui) } else { visuals.weak_text_color() };
        let centre = pos2(rect.left() + indent + width + 30.0, rect.center().y);
        target_mark(painter, centre, colour);
    }
    reveal(ui, session, row, &response);
    let mut said = vec![format!("Select {}", joint.name)];
    if joint.locked {
        said.push("locked".to_owned());
    }
    if row.influence > 0.0 {
        said.push("posed by a target".to_owned());
    }
    if row.target.is_some() {
        said.push("has a target".to_owned());
    }
    response.on_hover_text(format!("{}. Double-click to rename", said.join(", ")))
}

fn free_dot(painter: &Painter, at: Pos2, colour: Color32) {
    painter.circle_filled(at, 3.0, colour);
}

fn locked_dot(painter: &Painter, at: Pos2, colour: Color32) {
    painter.circle_stroke(at, 2.5, (1.2, colour));
}

fn target_mark(painter: &Painter, at: Pos2, colour: Color32) {
    painter.circle_stroke(at, 4.5, (1.5, colour));
    painter.circle_filled(at, 1.5, colour);
}

/// Says what the marks of the rows mean.
fn legend(ui: &mut Ui) {
    let palette = style::palette(ui);
    let [free, posed, locked] = [palette.upper, palette.accent, palette.joint].map(style::colour);
    type MarkPainter = fn(&Painter, Pos2, Color32);
    let marks: [(MarkPainter, Color32, &str); 4] = [
        (free_dot, free, "by angles"),
        (free_dot, posed, "by target"),
        (locked_dot, locked, "locked"),
        (target_mark, posed, "target"),
    ];
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 2.0);
        for (mark, colour, meaning) in marks {
            let (rect, _) = ui.allocate_exact_size(vec2(12.0, 14.0), Sense::hover());
            mark(ui.painter(), rect.center(), colour);
            ui.label(RichText::new(meaning).weak().size(11.0));
            ui.add_space(2.0);
        }
    });
}

/// Scrolls to the row when its joint becomes selected, and moves the keyboard focus to the row if
/// the tree has the focus.
fn reveal(ui: &Ui, session: &Session, row: &OutlinerRow, response: &Response) {
    let seen = response.id.with("selected");
    let is_new = session.selection().active() == Some(row.joint);
    let was = ui.data(|data| data.get_temp::<bool>(seen)).unwrap_or(false);
    if is_new && !was {
        ui.scroll_to_rect(response.rect.expand2(vec2(0.0, ROW)), None);
        if ui
            .data(|data| data.get_temp::<OutlinerFocus>(ui.scope_id()))
            .is_some_and(|focused| focused.0)
        {
            response.request_focus();
        }
    }
    ui.data_mut(|data| data.insert_temp(seen, is_new));
}

fn respond(
    ui: &Ui,
    session: &Session,
    rows: &[OutlinerRow],
    row: &OutlinerRow,
    response: &Response,
    actions: &mut Actions,
) {
    // egui reports Space on the focused row as a click, but here Space plays or pauses.
    let by_space = response.has_focus() && ui.input(|input| input.key_pressed(Key::Space));
    if response.double_clicked() {
        actions.push(commands::rename(session, row.joint));
    } else if response.clicked() && !by_space {
        response.request_focus();
        let modifiers = ui.input(|input| input.modifiers);
        let mut selection = session.selection().joints().to_vec();
        let was_selected = selection.contains(&row.joint);
        if modifiers.shift || modifiers.command {
            selection.retain(|joint| *joint != row.joint);
            if !was_selected {
                selection.push(row.joint);
            }
        } else {
            selection = vec![row.joint];
        }
        actions.push(SelectAction::Joints(selection));
    }
    if !response.has_focus() {
        return;
    }
    focus::leave_letters(ui, response.id);
    let arrows = egui::EventFilter { vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    viewport::viewport(ui, session, actions);
    let presses = |key| ui.input(|input| input.num_presses(key)) as isize;
    let by = presses(Key::ArrowDown) - presses(Key::ArrowUp);
    let from = session.selection().active().unwrap_or(row.joint);
    let here = rows.iter().position(|row| row.joint == from).unwrap_or(0);
    if by != 0 {
        let to = here.saturating_add_signed(by).min(rows.len() - 1);
        actions.push(SelectAction::Joints(vec![rows[to].joint]));
    }
}

fn buttons(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let selected = session.selection().active();
    let none = selected.is_none().then_some(NONE_SELECTED);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(6.0, 6.0);
        let tooltip = "Add a child joint (A, or Ctrl+click in the viewport)";
        if widgets::button(ui, "Add child", tooltip, None) {
            actions.push(JointEdit::AddJoint { tip: None });
        }
        if widgets::button(ui, "Add root", "Add a root joint, the start of another tree", None) {
            actions.push(JointEdit::AddRoot);
        }
        let tooltip = "Delete the selected joints (Delete)";
        if widgets::button(ui, "Delete", tooltip, none) {
            actions.push(commands::delete(session));
        }
        if widgets::button(ui, "Rename…", "Rename the selected joint (F2)", none)
            && let Some(joint) = selected
        {
            actions.push(commands::rename(session, joint));
        }
        target_button(ui, session, actions);
    });
}

fn target_button(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let selected = session.selection().active();
    let none = selected.is_none().then_some(NONE_SELECTED);
    let has_target = selected.is_some_and(|joint| session.rig().target_of_end(joint).is_some());
    let (name, tooltip) = if has_target {
        ("Remove target", "Remove the target of the selected joint (T)")
    } else {
        ("Add target", "Add a target for the selected joint's tip (T)")
    };
    if widgets::button(ui, name, tooltip, none) {
        actions.extend(commands::toggle_target(session));
    }
}
