//! Figures and formulas of a limb with the numbers of the current pose; its hierarchy as a tree,
//! each part with what places it in its parent.

mod figure_pops;
mod figures;
mod pointer;
mod pops;
mod reach;
mod triangle;
mod twist_references;

use egui::{Align, Label, Layout, Pos2, RichText, Stroke, Ui, vec2};

use crate::document::Overlay;
use crate::kinematics::soft_reach::ReachLimits;
use crate::kinematics::two_bone::Reach;
use crate::rig::LimbPart;
use crate::session::{Actions, LimbFigure, SelectAction, Session, ShownLimb, TourState};
use crate::ui::widgets::Choice;
use crate::ui::widgets::text::capitalized;
use crate::ui::{labels, pose_summary, widgets};
use crate::words::LimbWords;
pub(in crate::ui) use twist_references::globe_legend;

use figures::{Lit, degrees, figure_colour, length, point};

/// The triangle of a limb, a sentence on its pose, and its angles and lengths. Returns the figure
/// under the mouse.
pub(in crate::ui) fn triangle(
    ui: &mut Ui,
    session: &Session,
    actions: &mut Actions,
) -> Option<LimbFigure> {
    let limb = titled_limb(ui, session, actions)?;
    let lit = &mut Lit::new(session);
    triangle::ui(ui, session, limb, lit);
    sentence(ui, session, limb);
    widgets::folded_section(ui, "Hierarchy", |ui| hierarchy(ui, session, limb, lit, actions));
    widgets::folded_section(ui, "Pointer", |ui| pointer::ui(ui, limb, lit));
    let title = format!("{} triangle", capitalized(limb.words.middle));
    widgets::named_folded_section(ui, "triangle", &title, |ui| triangle::quantities(ui, limb, lit));
    widgets::folded_section(ui, "Law of cosines", |ui| triangle::law_of_cosines(ui, limb, lit));
    widgets::folded_section(ui, "Positions", |ui| triangle::positions(ui, limb, lit));
    lit.pointed()
}

/// The references from which a limb's twist can be measured.
pub(super) fn twist(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    if let Some(limb) = titled_limb(ui, session, actions) {
        twist_references::ui(ui, session, limb, actions);
    }
}

/// The distances that the hand can have, and those that it has.
pub(super) fn reach(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let Some(limb) = titled_limb(ui, session, actions) else { return };
    reach::meter(ui, limb);
    sentence(ui, session, limb);
    // A step of the tour asks for what this section shows.
    if session.tour().is_none_or(TourState::shows_result) {
        widgets::section(ui, "Same step, two poses", |ui| reach::same_step(ui, limb));
    }
    widgets::section(ui, "Reach curve", |ui| reach::curve(ui, limb));
}

/// The pops of a limb in the latest drag, and those along the motion of a figure.
pub(super) fn pops(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let moves = session.document().is_posed_over_time();
    if let Some(limb) = session.limb().filter(|_| session.rig().sole_limb().is_some()) {
        pops::ui(ui, session, limb, actions);
        if moves {
            widgets::section(ui, "Along the motion", |ui| figure_pops::ui(ui, session, actions));
        }
        return;
    }
    figure_pops::ui(ui, session, actions);
    if let Some(limb) = session.limb() {
        let title = format!("Latest drag of {}", name(session, limb));
        widgets::named_section(ui, "latest drag", &title, |ui| {
            pops::ui(ui, session, limb, actions);
        });
    }
}

/// Shows the name of the limb of a figure, which chooses another one, and returns the limb; without
/// one, a sentence that says how to make one.
fn titled_limb<'a>(
    ui: &mut Ui,
    session: &'a Session,
    actions: &mut Actions,
) -> Option<&'a ShownLimb> {
    let limb = session.limb();
    match limb {
        Some(limb) if session.rig().sole_limb().is_none() => {
            choose_limb(ui, session, limb, actions);
            why_this_limb(ui, session);
        }
        Some(_) => {}
        None => {
            ui.label(
                "There is no limb. Add a target to a hand or foot: this page is then about its two bones.",
            );
        }
    }
    limb
}

/// Shows a list of a figure's limbs. Choosing one selects its end.
fn choose_limb(ui: &mut Ui, session: &Session, limb: &ShownLimb, actions: &mut Actions) {
    let rig = session.rig();
    let shown = name(session, limb);
    let tooltip = "Choose the limb that this page is about; selecting one of its joints does, too";
    let choice = Choice { label: "Limb of", name: "Limb", tooltip, shown: &shown };
    choice.show(ui, |list| {
        for target in rig.limb_targets() {
            let end = rig.end_of(target);
            let is_shown = target.joint == limb.target;
            if list.item(is_shown, &rig.skeleton[end].name, "", None) {
                actions.push(SelectAction::Joints(vec![end]));
            }
        }
    });
    ui.add_space(4.0);
}

/// Says why this limb of a figure is shown.
fn why_this_limb(ui: &mut Ui, session: &Session) {
    let (rig, selected) = (session.rig(), session.selection().active());
    let outside = selected.filter(|joint| rig.limb_target_of(*joint).is_none());
    let why = match outside.and_then(|joint| rig.skeleton.joint(joint)) {
        Some(joint) => {
            format!("{} belongs to no limb. This page shows the one named above.", joint.name)
        }
        None if selected.is_some() => {
            "The limb of the selected joint; its bones are coloured in the view.".to_owned()
        }
        None => {
            "Its bones are coloured in the view. Select a joint of another limb to see that one."
                .to_owned()
        }
    };
    ui.weak(why);
    ui.add_space(4.0);
}

/// The name of what a limb's target moves.
fn name(session: &Session, limb: &ShownLimb) -> String {
    let rig = session.rig();
    let end = rig.end_of_target(limb.target).and_then(|end| rig.skeleton.joint(end));
    end.map_or_else(String::new, |joint| joint.name.clone())
}

/// A text on why a limb needs no solver that iterates.
pub(in crate::ui) fn closed_form(ui: &mut Ui, session: &Session) {
    let Some(limb) = session.limb() else { return };
    let (bones, lengths) = (limb.frames.bones(), limb.lengths());
    let [upper, lower] = [bones.upper(), bones.lower()].map(|it| lengths.show(it));
    let distance = lengths.show(limb.frames.pose().distance);
    ui.label(format!(
        "Two limbs need no iterations. Their lengths {upper} and {lower} and the distance {distance} from \
         shoulder to hand are the three sides of a triangle, and three sides fix all its angles."
    ));
    ui.add_space(4.0);
    ui.label(
        "A longer chain has many poses with its tip at the target. A solver finds one of them step by \
         step. The solvers below do so for these two limbs, too.",
    );
}

fn sentence(ui: &mut Ui, session: &Session, limb: &ShownLimb) {
    // Always as high as the longest sentence, so that nothing below moves.
    let height = 3.0 * ui.text_style_height(&egui::TextStyle::Body) + 4.0;
    ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
        ui.set_min_height(height);
        let sentence = ui.label(pose_summary::sentence_on_limb(session, limb));
        let is_short = sentence.rect.height() < 0.5 * height;
        if is_short && limb.frames.pose().reach == Some(Reach::Reached) {
            let ReachLimits { inner, outer } = limb.frames.limits;
            let [inner, outer] = [inner, outer].map(|it| limb.lengths().show(it));
            let (_, unit) = labels::unit_of_length(session.document().metres_per_unit());
            ui.weak(format!("Its reach is {inner} to {outer} {unit}."));
        }
    });
}

const ROW: f32 = 20.0;
const INDENT: f32 = 16.0;

/// A part of the hierarchy.
struct HierarchyRow {
    name: &'static str,
    depth: u8,
    figure: LimbFigure,
    value: String,
    meaning: String,
}

fn hierarchy(
    ui: &mut Ui,
    session: &Session,
    limb: &ShownLimb,
    lit: &mut Lit,
    actions: &mut Actions,
) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for part in parts(limb) {
            lit.row(ui, part.figure, |ui| show(ui, &part));
        }
    });
    let (name, tooltip) = ("Axes in the view", "Show the axes of Root, Limb and Socket");
    widgets::overlay_check_box(ui, session, Overlay::Frames, name, tooltip, None, actions);
}

fn parts(limb: &ShownLimb) -> [HierarchyRow; 5] {
    let pose = limb.frames.pose();
    let LimbWords { base, middle, end } = limb.words;
    let [upper, lower] = [limb.frames.bones().upper(), limb.frames.bones().lower()]
        .map(|it| length(limb, it * pose.stretch));
    [
        HierarchyRow {
            name: "Root",
            depth: 0,
            figure: LimbFigure::Root,
            value: point(limb, limb.frames.origin(LimbPart::Root)),
            meaning: format!("The Root places the {base} in the world"),
        },
        HierarchyRow {
            name: "Limb",
            depth: 1,
            figure: LimbFigure::Limb,
            value: format!("yaw {}, pitch {}", degrees(pose.yaw()), degrees(pose.pitch())),
            meaning:
                "The Limb turns in the Root until its x axis, the Pointer, goes through the Cursor"
                    .to_owned(),
        },
        HierarchyRow {
            name: "Socket",
            depth: 2,
            figure: LimbFigure::Socket,
            value: format!("twist {}", degrees(pose.twist)),
            meaning: format!(
                "The Socket turns in the Limb about the Pointer and takes the {middle} along"
            ),
        },
        HierarchyRow {
            name: "Upper limb",
            depth: 3,
            figure: LimbFigure::Upper,
            value: format!("length {upper}"),
            meaning: format!(
                "The Upper limb leads from the {base} to the {middle}, in the Socket's xy-plane"
            ),
        },
        HierarchyRow {
            name: "Lower limb",
            depth: 3,
            figure: LimbFigure::Lower,
            value: format!("length {lower}"),
            meaning: format!(
                "The Lower limb leads from the {middle} to the {end}, in the Socket's xy-plane"
            ),
        },
    ]
}

/// Shows a row, with a line from its parent's, and returns its rectangle.
fn show(ui: &mut Ui, part: &HierarchyRow) -> egui::Rect {
    let size = vec2(ui.available_width(), ROW);
    let row = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        let left = ui.max_rect().left_center();
        ui.add_space(INDENT * f32::from(part.depth));
        if part.depth > 0 {
            paint_branch(ui, left + vec2(INDENT * (f32::from(part.depth) - 0.5), 0.0));
        }
        let colour = figure_colour(ui, Some(part.figure));
        let name = Label::new(RichText::new(part.name).color(colour)).selectable(false);
        ui.add(name).on_hover_text(&part.meaning);
        widgets::value(ui, &part.value);
    });
    row.response.rect
}

/// Paints the branch of a tree, from the row above to the right of `corner`.
fn paint_branch(ui: &Ui, corner: Pos2) {
    let stroke = Stroke::new(1.0, ui.visuals().weak_text_color());
    let top = corner - vec2(0.0, 0.5 * ROW);
    ui.painter().line(vec![top, corner, corner + vec2(0.35 * INDENT, 0.0)], stroke);
}
