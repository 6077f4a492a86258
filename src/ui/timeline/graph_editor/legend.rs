//! The names in the graph editor: joints, unless only one has keys, and below each its channels with the
//! colours of their curves; beside each lane those of its curves, where they have room there.

use std::collections::BTreeSet;

use egui::{
    Align2, Color32, Id, Rect, Response, Role, ScrollArea, Sense, TextStyle, Ui, UiBuilder, Vec2,
    WidgetInfo, pos2, vec2,
};

use crate::document::Channel;
use crate::kinematics::skeleton::JointId;
use crate::session::{Actions, SelectAction, Session};
use crate::ui::labels;
use crate::ui::timeline::context_menu;
use crate::ui::timeline::rows::{self, ROW, TimelineAreas, VALUES};
use crate::ui::timeline::value_scale::{Lanes, ValueKind};
use crate::ui::widgets::AXES;

/// Width in points of one colour beside a name, and of a letter x, y or z in its colour.
const SWATCH: f32 = 10.0;
/// Size of the square of a colour.
const SQUARE: f32 = 8.0;
const LETTER: f32 = 10.0;

/// A listed channel, with the colours of its curves.
pub(in crate::ui::timeline) struct LegendEntry {
    pub channel: Channel,
    pub colours: Vec<Color32>,
    /// True if its curves are drawn.
    pub is_drawn: bool,
}

pub(in crate::ui::timeline) fn ui(
    ui: &mut Ui,
    session: &Session,
    (areas, lanes): (&TimelineAreas, Lanes),
    entries: &[LegendEntry],
    ruler: &Response,
    actions: &mut Actions,
) {
    let names = areas.names.with_max_x(areas.names.right() - VALUES);
    let document = session.document();
    let joints = document.keys.tracks().map(|(channel, _)| document.joint_of(channel));
    let joints: BTreeSet<_> = joints.collect();
    let has_headings = joints.len() > 1;
    let parts = beside_lanes(session, names, lanes, entries);
    for (rect, entries) in parts.unwrap_or_else(|| vec![(names, entries.iter().collect())]) {
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            let top = rect.top().to_bits();
            ScrollArea::vertical().id_salt(("legend", top)).auto_shrink(false).show(ui, |ui| {
                list(ui, session, &entries, has_headings, ruler, actions);
            });
        });
    }
}

/// The place beside each lane with the names of its curves; `None` if some have no room there, or no
/// lane.
fn beside_lanes<'a>(
    session: &Session,
    names: Rect,
    lanes: Lanes,
    entries: &'a [LegendEntry],
) -> Option<Vec<(Rect, Vec<&'a LegendEntry>)>> {
    if !entries.iter().all(|entry| entry.is_drawn) {
        return None;
    }
    let parts = lanes.kinds().map(|kind| {
        let is_in = |entry: &&LegendEntry| ValueKind::of(entry.channel) == kind;
        let entries: Vec<_> = entries.iter().filter(is_in).collect();
        let joints = entries.iter().map(|entry| session.document().joint_of(entry.channel));
        let headings = joints.flatten().collect::<BTreeSet<_>>();
        let lane = lanes.lane(kind, names);
        let rows = entries.len() + headings.len();
        (ROW * rows as f32 <= lane.height()).then_some((lane, entries))
    });
    parts.collect()
}

/// Lists channels, with a heading for each joint but the one of the channel above, if `has_headings`.
fn list(
    ui: &mut Ui,
    session: &Session,
    entries: &[&LegendEntry],
    has_headings: bool,
    ruler: &Response,
    actions: &mut Actions,
) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut above = None;
    for entry in entries {
        let joint = session.document().joint_of(entry.channel);
        if has_headings
            && joint != above
            && let Some(joint) = joint
        {
            joint_name(ui, session, joint, ruler, actions);
        }
        above = joint;
        let indent = if has_headings && joint.is_some() { 18.0 } else { 10.0 };
        channel_name(ui, session, entry, indent, ruler, actions);
    }
}

/// Shows the name of a joint. A click selects the joint, with Shift or Ctrl besides the others; a
/// click on the only selected joint selects none.
fn joint_name(
    ui: &mut Ui,
    session: &Session,
    joint: JointId,
    ruler: &Response,
    actions: &mut Actions,
) {
    let rig = session.rig();
    let name = rig.skeleton.joint(joint).map_or("–", |joint| &joint.name);
    let selected = session.selection().joints();
    let said = format!("Curves of joint {name}");
    let (rect, response) = item(ui, ui.next_auto_id(), selected.contains(&joint), &said);
    rows::line(ui, rect, name, ui.visuals().strong_text_color());
    if response.clicked() {
        ruler.request_focus();
        actions.push(SelectAction::Joints(rows::after_click(ui, selected, joint)));
    }
    response.on_hover_text(format!(
        "Show the curves of {name} alone, or of all joints again; Shift or Ctrl adds it"
    ));
}

/// Shows the name of a channel. A click shows its curves alone, with Shift or Ctrl besides the
/// others.
fn channel_name(
    ui: &mut Ui,
    session: &Session,
    entry: &LegendEntry,
    indent: f32,
    ruler: &Response,
    actions: &mut Actions,
) {
    let LegendEntry { channel, colours, is_drawn } = entry;
    let full = labels::channel(session, *channel);
    let is_selected = session.selection().channels().contains(channel);
    let id = ("timeline curve", *channel);
    let (rect, response) = item(ui, id, is_selected, &format!("Curve of {full}"));
    let colour = match (is_selected || response.hovered(), is_drawn) {
        (true, _) => ui.visuals().strong_text_color(),
        (false, true) => ui.visuals().text_color(),
        (false, false) => ui.visuals().weak_text_color(),
    };
    let (y, font) = (rect.center().y, TextStyle::Body.resolve(ui.style()));
    let metres = session.document().metres_per_unit();
    // The numbers beside it have the sign of degrees.
    let unit = match ValueKind::of(*channel) {
        ValueKind::Angle => "",
        kind => kind.unit(metres).1,
    };
    let (right, weak) = (pos2(rect.right() - 4.0, y), ui.visuals().weak_text_color());
    let unit = ui.painter().text(right, Align2::RIGHT_CENTER, unit, font.clone(), weak);
    let has_axes = colours.len() == AXES.len();
    let swatch = if has_axes { LETTER } else { SWATCH };
    let name = labels::channel_alone(session, *channel);
    let width = ui.painter().layout_no_wrap(name.clone(), font.clone(), colour).size().x;
    let most = unit.left() - 8.0 - swatch * colours.len() as f32;
    let beside = rect.with_min_x(rect.left() + indent - 10.0).with_max_x(most + 4.0);
    rows::line(ui, beside, &name, colour);
    let left = (rect.left() + indent + width + 6.0).min(most);
    for (place, colour) in colours.iter().enumerate() {
        let x = left + swatch * place as f32;
        let colour = if *is_drawn { *colour } else { colour.gamma_multiply(0.35) };
        if has_axes {
            ui.painter().text(pos2(x, y), Align2::LEFT_CENTER, AXES[place], font.clone(), colour);
        } else {
            let square = Rect::from_center_size(pos2(x + 0.5 * swatch, y), Vec2::splat(SQUARE));
            ui.painter().rect_filled(square, 2.0, colour);
        }
    }
    if response.clicked() {
        ruler.request_focus();
        let channels = rows::after_click(ui, session.selection().channels(), *channel);
        actions.push(SelectAction::Channels(channels));
    }
    context_menu::of_channel(&response, session, *channel, actions);
    let axes = if colours.len() == 3 { ", x, y and z in axis colours" } else { "" };
    response.on_hover_text(format!(
        "Show {full} alone{axes}, or all curves again; Shift or Ctrl adds it"
    ));
}

/// A row that can be clicked.
fn item(
    ui: &mut Ui,
    id: impl std::hash::Hash + std::fmt::Debug,
    is_selected: bool,
    said: &str,
) -> (Rect, Response) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let response = ui.interact(rect, Id::unique(id), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_selected, said.to_owned()));
    rows::paint_state(ui, rect, is_selected, &response);
    (rect, response)
}
