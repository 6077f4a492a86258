//! The outliner: the tree of joints, their selection, a filter, and what edits the tree.

use std::collections::HashMap;

use egui::collapsing_header::{CollapsingState, paint_default_icon};
use egui::{
    Align2, Color32, Frame, Id, Key, Margin, Panel, Rect, Response, RichText, Role, ScrollArea,
    Sense, Stroke, TextEdit, TextStyle, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use crate::document::SkeletonRig;
use crate::kinematics::skeleton::JointId;
use crate::session::{Actions, JointEdit, SelectAction, Session};
use crate::ui::keyboard::{focus, viewport};
use crate::ui::widgets;
use crate::ui::{commands, style};

const ROW: f32 = 20.0;
const INDENT: f32 = 13.0;
/// Width of the word at the right of a row.
const MARK: f32 = 48.0;
/// Width of the place of a triangle that folds a row.
const TRIANGLE: f32 = 14.0;
/// Number of children from which a joint that has a parent is folded at first: fingers, for example.
const FOLDED_FROM: usize = 4;
/// Number of joints up to which a figure is shown whole at first, and number of rows to which a
/// larger one is folded; fewer in a low window.
const MOST_ROWS: usize = 12;

const ADD_CHILD: &str = "Add a child joint (A, or Ctrl+click in the viewport)";
const ADD_ROOT: &str = "Add a joint that starts a tree";
const NONE_SELECTED: &str = "Select a joint first";

/// Shows the outliner in a panel of its own: as high as the joints of a small figure, and for others
/// with a height that can be dragged. It is folded at first for a figure that is one limb.
pub(in crate::ui) fn panel(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let is_limb = session.rig().sole_limb().is_some();
    let state = ui.make_persistent_id(("outliner", is_limb));
    let mut state = CollapsingState::load_with_default_open(ui, state, !is_limb);
    let [first, most] = [0.5, 0.6].map(|part| whole_rows(part * ui.available_height()));
    // The panel around it has a margin.
    let frame = Frame::side_top_panel(ui.style());
    let whole = AROUND + ROW * session.skeleton().joints().len() as f32;
    let is_whole = whole <= HEIGHT.min(first);
    let most_rows = if is_whole { MOST_ROWS } else { ((first - AROUND) / ROW) as usize };
    let at_first = AtFirst::new(session.rig(), most_rows.min(MOST_ROWS));
    let open = frame.inner_margin(Margin::symmetric(0, 4));
    let panel = match state.is_open() {
        true if is_whole => {
            Panel::top("whole outliner").resizable(false).exact_size(whole).frame(open)
        }
        true => Panel::top(Id::unique(("outliner", at_first.rows)))
            .resizable(true)
            .default_size((AROUND + ROW * at_first.rows as f32).min(first))
            .size_range(whole_rows(0.0)..=most)
            .frame(open),
        false => Panel::top("folded outliner")
            .resizable(false)
            .frame(frame.inner_margin(Margin { bottom: 6, ..Margin::ZERO })),
    };
    panel.show_separator_line(false).show(ui, |ui| {
        heading(ui, session, &mut state, actions);
        if state.is_open() {
            let filter = filter(ui);
            tree(ui, session, &filter, &at_first, actions);
        }
    });
    state.store(ui);
}

/// Height around the tree in the open panel: title, filter and margins, in points.
const AROUND: f32 = 78.0;
/// Least number of rows of the open panel, and its greatest height at first in points.
const LEAST_ROWS: f32 = 3.0;
const HEIGHT: f32 = AROUND + MOST_ROWS as f32 * ROW;

/// The height in points of a panel that ends at a whole row, at most `height`.
fn whole_rows(height: f32) -> f32 {
    AROUND + ROW * ((height - AROUND) / ROW).floor().max(LEAST_ROWS)
}

/// Shows the title and, while the tree is open, the buttons that edit it.
fn heading(ui: &mut Ui, session: &Session, state: &mut CollapsingState, actions: &mut Actions) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        let title = format!("Joints ({})", session.skeleton().joints().len());
        let is_open = state.is_open();
        let (rect, triangle) = ui.allocate_exact_size(vec2(TRIANGLE + 2.0, ROW), Sense::CLICK);
        paint_default_icon(
            ui,
            state.openness(ui),
            &triangle.clone().with_new_rect(rect.shrink2(vec2(2.5, 5.5))),
        );
        let label = ui.add(egui::Label::new(RichText::new(title).strong()).sense(Sense::click()));
        label.widget_info(|| WidgetInfo::selected(Role::Button, true, is_open, "Joints"));
        let tooltip = if is_open { "Hide the joints" } else { "Show the joints as a tree" };
        if label.on_hover_text(tooltip).clicked() || triangle.clicked() {
            state.toggle(ui);
        }
        if is_open {
            widgets::at_right(ui, |ui| buttons(ui, session, actions));
        }
    });
}

/// Shows the filter, and returns what is typed there.
fn filter(ui: &mut Ui) -> String {
    let typed = ui.make_persistent_id("filter of joints");
    let mut filter: String = ui.data(|data| data.get_temp(typed)).unwrap_or_default();
    let edit = TextEdit::singleline(&mut filter).hint_text("Filter");
    let edit = ui.add(edit.desired_width(f32::INFINITY));
    widgets::name(ui, &edit, "Filter joints");
    edit.on_hover_text("Show only joints whose names contain this text");
    ui.data_mut(|data| data.insert_temp(typed, filter.clone()));
    filter
}

/// True if a row of the tree had the keyboard focus in the previous frame.
#[derive(Clone, Copy, Default)]
struct OutlinerFocus(bool);

/// Which joints are folded or unfolded by the user, by their names.
#[derive(Clone, Default)]
struct Folds(HashMap<String, bool>);

/// A joint with its depth in the tree.
struct OutlinerRow {
    joint: JointId,
    depth: usize,
    /// True if its children are hidden; `None` without children.
    is_folded: Option<bool>,
    /// False if it is there only because a joint below it is found by the filter.
    is_found: bool,
    /// Influence of the targets that turn the joint.
    influence: f32,
    has_target: bool,
}

/// What is seen of the tree before the user folds or unfolds anything: all joints down to a depth, and
/// the first limb, which the pages are about at first.
struct AtFirst {
    /// Depth from which joints are folded.
    deepest: usize,
    /// True for a joint above the end of the first limb.
    is_open: Vec<bool>,
    /// Number of rows.
    rows: usize,
}

impl AtFirst {
    /// As deep as gives at most this number of rows, if that can be.
    fn new(rig: &SkeletonRig, most: usize) -> Self {
        let skeleton = &rig.skeleton;
        let count = skeleton.joints().len();
        let (mut depths, mut children) = (Vec::with_capacity(count), vec![0; count]);
        for joint in skeleton.joints() {
            depths.push(joint.parent.map_or(0, |parent| depths[parent.index()] + 1));
            joint.parent.into_iter().for_each(|parent| children[parent.index()] += 1);
        }
        let mut is_open = vec![false; count];
        let end = rig.limb_targets().next().map(|target| rig.end_of(target));
        for joint in end.into_iter().flat_map(|end| skeleton.ancestors(end).skip(1)) {
            is_open[joint.index()] = true;
        }
        let mut found = Self { deepest: 0, is_open, rows: 0 };
        for deepest in 0..=depths.iter().copied().max().unwrap_or(0) {
            let deeper = Self { deepest, ..found };
            let mut seen = Vec::with_capacity(count);
            for joint in skeleton.joints() {
                let is_seen = joint.parent.is_none_or(|it| {
                    let at = it.index();
                    seen[at] && !deeper.is_folded(it, depths[at], children[at])
                });
                seen.push(is_seen);
            }
            let rows = seen.into_iter().filter(|is_seen| *is_seen).count();
            if deepest > 0 && rows > most {
                return Self { deepest: deepest - 1, ..deeper };
            }
            found = Self { rows, ..deeper };
        }
        found
    }

    /// True if the children of a joint at a depth are hidden at first.
    fn is_folded(&self, joint: JointId, depth: usize, children: usize) -> bool {
        let is_deep = depth >= self.deepest || depth > 0 && children >= FOLDED_FROM;
        is_deep && !self.is_open[joint.index()]
    }
}

/// Shows the tree.
fn tree(ui: &mut Ui, session: &Session, filter: &str, at_first: &AtFirst, actions: &mut Actions) {
    let kept = ui.make_persistent_id("folded joints");
    let mut folds: Folds = ui.data(|data| data.get_temp(kept)).unwrap_or_default();
    unfold_above_new(ui, session, &mut folds);
    let rows = rows(session, filter, at_first, &folds);
    // Contents that were higher than the panel would make it grow.
    let whole = ui.available_rect_before_wrap();
    let inside = whole.shrink2(vec2(0.0, LIST_MARGIN));
    // Whole rows.
    let above = inside.with_max_y(inside.top() + (inside.height() / ROW).floor() * ROW);
    ui.painter().rect_filled(whole, 6.0, ui.visuals().extreme_bg_color);
    let list = ui.interact(above, ui.make_persistent_id("list of joints"), Sense::hover());
    list.widget_info(|| WidgetInfo::labeled(Role::List, true, "Joints as a tree"));
    let mut inside = ui.new_child(UiBuilder::new().max_rect(above));
    let area = ScrollArea::both().auto_shrink([false, false]);
    let mut pointed = None;
    area.id_salt("joints").show(&mut inside, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut focused = OutlinerFocus(false);
        for row in &rows {
            let response = show(ui, session, row, &mut folds);
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
    ui.data_mut(|data| {
        data.insert_temp(said, pointed.is_some());
        data.insert_temp(kept, folds);
    });
    let mut inside = ui.new_child(UiBuilder::new().max_rect(above));
    if session.skeleton().joints().is_empty() {
        inside.weak("No joints. Add a root to start.");
    } else if rows.is_empty() {
        inside.weak("No joint has such a name.");
    }
    ui.advance_cursor_after_rect(whole);
}

/// Space above and below the rows, in points.
const LIST_MARGIN: f32 = 4.0;

/// Unfolds the joints above one that has just been selected.
fn unfold_above_new(ui: &Ui, session: &Session, folds: &mut Folds) {
    let seen = ui.make_persistent_id("selected in the tree");
    let active = session.selection().active();
    let was = ui.data(|data| data.get_temp::<Option<JointId>>(seen)).flatten();
    if active == was {
        return;
    }
    ui.data_mut(|data| data.insert_temp(seen, active));
    let skeleton = session.skeleton();
    let above = active.into_iter().flat_map(|joint| skeleton.ancestors(joint).skip(1));
    for joint in above {
        folds.0.insert(skeleton[joint].name.clone(), false);
    }
}

/// Rows in depth-first order, so that children follow their parent: all that are not in a folded
/// joint or, with a filter, those that it finds and the joints above them.
fn rows(session: &Session, filter: &str, at_first: &AtFirst, folds: &Folds) -> Vec<OutlinerRow> {
    let filter = filter.trim().to_lowercase();
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
    let mut has_target = vec![false; children.len()];
    for target in &rig.targets {
        has_target[rig.end_of(target).index()] = true;
    }
    let (found, has_found_below) = found(session, &filter);
    let mut rows = Vec::with_capacity(children.len());
    while let Some((joint, depth)) = open.pop() {
        let (index, below) = (joint.index(), &children[joint.index()]);
        let is_first = at_first.is_folded(joint, depth, below.len());
        let is_folded =
            filter.is_empty() && *folds.0.get(&skeleton[joint].name).unwrap_or(&is_first);
        if !is_folded {
            open.extend(below.iter().map(|&child| (child, depth + 1)));
        }
        if !found[index] && !has_found_below[index] {
            continue;
        }
        rows.push(OutlinerRow {
            joint,
            depth,
            is_folded: (!below.is_empty()).then_some(is_folded),
            is_found: found[index],
            influence: influences[index],
            has_target: has_target[index],
        });
    }
    rows
}

/// For each joint whether its name contains the filter, and whether that of a joint below it does; all
/// joints are found by an empty filter.
fn found(session: &Session, filter: &str) -> (Vec<bool>, Vec<bool>) {
    let skeleton = session.skeleton();
    if filter.is_empty() {
        let joints = skeleton.joints().len();
        return (vec![true; joints], vec![false; joints]);
    }
    let names = skeleton.joints().iter().map(|joint| &joint.name);
    let found: Vec<bool> = names.map(|name| name.to_lowercase().contains(filter)).collect();
    let mut below = vec![false; found.len()];
    for (joint, it) in skeleton.iter().rev() {
        if let Some(parent) = it.parent {
            below[parent.index()] |= found[joint.index()] || below[joint.index()];
        }
    }
    (found, below)
}

fn show(ui: &mut Ui, session: &Session, row: &OutlinerRow, folds: &mut Folds) -> Response {
    let rig = session.rig();
    let joint = &rig.skeleton[row.joint];
    let selected = session.selection().joints().contains(&row.joint);
    let indent = INDENT * row.depth.min(12) as f32;
    let font = TextStyle::Body.resolve(ui.style());
    let width = ui.fonts_mut(|fonts| {
        let white = egui::Color32::WHITE;
        fonts.layout_no_wrap(joint.name.clone(), font.clone(), white).size().x
    });
    let size = vec2(ui.available_width().max(indent + width + TRIANGLE + MARK), ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let triangle = Rect::from_min_size(pos2(rect.left() + indent, rect.top()), vec2(TRIANGLE, ROW));
    let triangle = row.is_folded.map(|is_folded| {
        let verb = if is_folded { "Show" } else { "Hide" };
        let mark = ui.interact(triangle, response.id.with("fold"), Sense::CLICK);
        let clicked = mark.on_hover_text(format!("{verb} the joints below")).clicked();
        if clicked || response.has_focus() && toggles(ui, is_folded) {
            folds.0.insert(joint.name.clone(), !is_folded);
        }
        (triangle, is_folded)
    });
    response.widget_info(|| {
        WidgetInfo::selected(Role::Button, true, selected, format!("Joint {}", joint.name))
    });
    if !ui.is_rect_visible(rect) {
        reveal(ui, session, row, &response);
        return response;
    }
    let visuals = ui.visuals();
    let painter = ui.painter();
    for depth in 0..row.depth.min(12) {
        let x = rect.left() + 0.5 * TRIANGLE + INDENT * depth as f32;
        painter.vline(x, rect.y_range(), visuals.widgets.noninteractive.bg_stroke);
    }
    if selected {
        painter.rect_filled(rect, 4.0, visuals.selection.bg_fill);
    } else if response.hovered() || session.selection().hovered() == Some(row.joint) {
        painter.rect_filled(rect, 4.0, visuals.widgets.hovered.weak_bg_fill);
    }
    if response.has_focus() {
        let inside = rect.shrink(1.0);
        let stroke = Stroke::new(1.0, style::accent(ui));
        painter.rect_stroke(inside, 4.0, stroke, egui::StrokeKind::Inside);
    }
    if let Some((triangle, is_folded)) = triangle {
        widgets::fold_mark(painter, triangle.center(), is_folded, visuals.weak_text_color());
    }
    if let Some((mark, colour)) = mark(ui, session, row.joint) {
        let small = TextStyle::Small.resolve(ui.style());
        let at = pos2(rect.right() - 8.0, rect.center().y);
        painter.text(at, Align2::RIGHT_CENTER, mark, small, colour);
    }
    let text = match (selected, row.is_found) {
        (true, _) => visuals.strong_text_color(),
        (false, true) => visuals.text_color(),
        (false, false) => visuals.weak_text_color(),
    };
    let at = pos2(rect.left() + indent + TRIANGLE + 2.0, rect.center().y);
    painter.text(at, Align2::LEFT_CENTER, &joint.name, font, text);
    reveal(ui, session, row, &response);
    let select = format!("Select {}", joint.name);
    let mut said = vec![select.as_str()];
    said.push(match (joint.locked, row.influence > 0.0) {
        (true, _) => "locked to its parent",
        (false, true) => "posed by a target (IK)",
        (false, false) => "posed by its own angles (FK)",
    });
    said.extend(row.has_target.then_some("has a target"));
    response.on_hover_text(format!("{}. Double-click to rename", said.join(", ")))
}

/// True if the arrow key is pressed that folds or unfolds a row.
fn toggles(ui: &Ui, is_folded: bool) -> bool {
    let key = if is_folded { Key::ArrowRight } else { Key::ArrowLeft };
    ui.input(|input| input.key_pressed(key))
}

/// The word at the right of a joint's row, and its colour: for the bones of the limb that a page is
/// about the names that they have there.
fn mark(ui: &Ui, session: &Session, joint: JointId) -> Option<(&'static str, Color32)> {
    let palette = style::palette(ui);
    let limb = session.limb_of_page()?.joints;
    match joint {
        _ if joint == limb.upper => Some(("upper", style::colour(palette.upper))),
        _ if joint == limb.lower => Some(("lower", style::colour(palette.lower))),
        _ => None,
    }
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
    response.context_menu(|ui| menu(ui, session, actions));
    // egui reports Space on the focused row as a click, but here Space plays or pauses.
    let by_space = response.has_focus() && ui.input(|input| input.key_pressed(Key::Space));
    if response.double_clicked() {
        actions.push(commands::rename(session, row.joint));
    } else if response.secondary_clicked() && !session.selection().joints().contains(&row.joint) {
        actions.push(SelectAction::Joints(vec![row.joint]));
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
    focus::take_arrows(ui, response.id);
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
    ui.spacing_mut().item_spacing.x = 4.0;
    let (name, tooltip, edit) = match session.skeleton().joints().is_empty() {
        true => ("Add root", ADD_ROOT, JointEdit::AddRoot),
        false => ("Add child", ADD_CHILD, JointEdit::AddJoint { tip: None }),
    };
    if widgets::button(ui, name, tooltip, None) {
        actions.push(edit);
    }
    let more = ui.menu_button("More", |ui| menu(ui, session, actions));
    more.response.on_hover_text("Rename or delete joints, and give them targets");
}

/// Shows the items that edit the selected joints.
fn menu(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let selected = session.selection().active();
    let none = selected.is_none().then_some(NONE_SELECTED);
    if widgets::menu_item(ui, "Add root", "", ADD_ROOT, None) {
        actions.push(JointEdit::AddRoot);
    }
    let has_target = selected.is_some_and(|joint| session.rig().target_of_end(joint).is_some());
    let (name, tooltip) = match has_target {
        true => {
            ("Remove target", "Remove the target of the selected joint: its own angles pose it")
        }
        false => ("Add target", "Add a point that the selected joint's tip should reach"),
    };
    if widgets::menu_item(ui, name, "T", tooltip, none) {
        actions.extend(commands::toggle_target(session));
    }
    ui.separator();
    if widgets::menu_item(ui, "Rename…", "F2", "", none)
        && let Some(joint) = selected
    {
        actions.push(commands::rename(session, joint));
    }
    if widgets::menu_item(ui, "Delete", "Delete", "", none) {
        actions.push(commands::delete(session));
    }
}
