//! The panels beside and over the viewport. On the left are the rig's settings, guides and display;
//! on the right are pages that explain the pose of the arm or of the skeleton.

mod arm;
pub(in crate::ui) mod crowd;
mod explain;
mod skeleton;
mod solver;
pub(in crate::ui) mod statistics;

use egui::{ScrollArea, Ui};

use super::widgets;
use crate::document::{Overlay, RigKind};
use crate::session::{Actions, DisplayEdit, LimbFigure, PanelTab, Session, ViewAction};

pub(super) fn left(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    ui.add_space(4.0);
    rig(ui, session, actions);
    ui.add_space(2.0);
    let note = skeleton::noted(session);
    let height = ui.available_height();
    let room = height - note.map_or(0.0, |_| skeleton::note_height(height));
    let rows = ScrollArea::vertical().auto_shrink(false).max_height(room);
    rows.show(ui, |ui| {
        match session.rig() {
            RigKind::Arm => arm::ui(ui, session, actions),
            RigKind::Skeleton => skeleton::ui(ui, session, actions),
        }
        widgets::section(ui, "Guides", |ui| {
            widgets::check_boxes(ui, session, 2, guides(session), None, actions);
        });
        if session.rig() == RigKind::Arm {
            arm::more(ui, session, actions);
        }
        let hand = (session.rig() == RigKind::Arm).then_some(Overlay::Hand);
        let surroundings: Vec<_> = Overlay::SURROUNDINGS.into_iter().chain(hand).collect();
        widgets::folded_section(ui, "Display", |ui| {
            widgets::check_boxes(ui, session, 3, &surroundings, None, actions);
        });
        resets(ui, session, actions);
        ui.add_space(8.0);
    });
    if let Some(target) = note {
        skeleton::note(ui, session, &target, actions);
    }
}

fn rig(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rigs = [
        (RigKind::Arm, "Arm", "Pose an arm of two limbs, solved in closed form"),
        (RigKind::Skeleton, "Skeleton", "Pose a tree of joints, solved by iteration"),
    ];
    let chosen = widgets::segments(ui, session.rig(), &rigs);
    actions.extend(chosen.map(DisplayEdit::ShowRig));
}

fn guides(session: &Session) -> &'static [Overlay] {
    match session.rig() {
        RigKind::Arm => &Overlay::GUIDES,
        RigKind::Skeleton => &[
            Overlay::Cursor,
            Overlay::Pointer,
            Overlay::InnerLimit,
            Overlay::OuterLimit,
            Overlay::ElbowCircle,
            Overlay::FkPose,
            Overlay::ByItself,
        ],
    }
}

fn resets(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let (name, tooltip) = match session.rig() {
        RigKind::Arm => ("Reset pose", "Reset everything that poses the arm"),
        RigKind::Skeleton => ("Reset to bind pose", "Set every joint rotation to 0"),
    };
    ui.horizontal(|ui| {
        if widgets::button(ui, name, tooltip, None) {
            actions.push(DisplayEdit::ResetPose);
        }
        let tooltip = "Reset pose, guides, display and view; hide the crowd";
        if widgets::button(ui, "Reset all", tooltip, None) {
            actions.push(DisplayEdit::ResetAll);
        }
    });
}

/// Least width of the window with this panel, in points.
const WINDOW_WIDTH: f32 = 760.0;

/// True if the window is wide enough for the panel: in a narrow one, it gives way to the view.
pub(super) fn has_room(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() >= WINDOW_WIDTH
}

/// Shows the chosen page, and returns the limb's figure under the mouse.
pub(super) fn right(ui: &mut Ui, session: &Session, actions: &mut Actions) -> Option<LimbFigure> {
    let shown = shown(session);
    ui.add_space(4.0);
    let tabs: Vec<_> =
        tabs(session).map(|tab| (tab, tab.name(), tooltip(session.rig(), tab))).collect();
    actions.extend(widgets::tabs(ui, shown, &tabs).map(ViewAction::ShowTab));
    ui.separator();
    // Each page is scrolled on its own.
    let mut figure = None;
    ScrollArea::vertical().id_salt(shown).auto_shrink(false).show(ui, |ui| {
        match shown {
            PanelTab::Triangle => figure = explain::triangle(ui, session, actions),
            PanelTab::Twist => explain::twist(ui, session, actions),
            PanelTab::Reach => explain::reach(ui, session),
            PanelTab::Pops => explain::pops(ui, session, actions),
            PanelTab::Solver if session.rig() == RigKind::Arm => explain::closed_form(ui, session),
            PanelTab::Solver => solver::solver(ui, session, actions),
            PanelTab::Race => solver::race(ui, session, actions),
            PanelTab::Skin => skeleton::skin_areas(ui, session),
        }
        ui.add_space(8.0);
    });
    figure
}

/// The tabs of the rig. The page of the skin is there while the skin is compared.
fn tabs(session: &Session) -> impl Iterator<Item = PanelTab> + use<> {
    let compares = session.shown().compares_skinning();
    let tabs = PanelTab::of(session.rig()).iter().copied();
    tabs.filter(move |tab| *tab != PanelTab::Skin || compares)
}

/// The chosen tab, or the first if the chosen one is not there.
fn shown(session: &Session) -> PanelTab {
    let chosen = session.preferences().tab(session.rig());
    let mut all = tabs(session);
    let first = all.next().unwrap_or(chosen);
    if all.any(|tab| tab == chosen) { chosen } else { first }
}

fn tooltip(rig: RigKind, tab: PanelTab) -> &'static str {
    match (rig, tab) {
        (_, PanelTab::Triangle) => "Show the triangle of shoulder, elbow and hand",
        (_, PanelTab::Twist) => "Compare what the Socket twist can be measured from",
        (_, PanelTab::Reach) => "Show how near and how far the hand can be",
        (RigKind::Arm, PanelTab::Pops) => "Show where the elbow jumped, and why",
        (RigKind::Skeleton, PanelTab::Pops) => {
            "Show where joints jump, targets are lost and feet slide, and why"
        }
        (RigKind::Arm, PanelTab::Solver) => "Show why the arm needs no iterations",
        (RigKind::Skeleton, PanelTab::Solver) => "Watch a solver bring the tips to their targets",
        (_, PanelTab::Race) => "Run all solvers on the same targets",
        (_, PanelTab::Skin) => "Plot the skin's cross-section for each way of blending joints",
    }
}
