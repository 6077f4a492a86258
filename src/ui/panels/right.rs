//! The panel on the right: pages that explain the pose of the arm or of the skeleton.

use egui::{ScrollArea, Ui};

use super::{explain, solver};
use crate::document::RigKind;
use crate::session::{Actions, ArmFigure, PanelTab, Session, ViewAction};
use crate::ui::widgets::{self, Tab};

/// Least width of the window with this panel, in points.
const WINDOW_WIDTH: f32 = 760.0;

/// Whether the window is wide enough for the panel: in a narrow one, it gives way to the view.
pub(in crate::ui) fn has_room(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() >= WINDOW_WIDTH
}

/// Shows the chosen page, and returns the arm's figure under the mouse.
pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    actions: &mut Actions,
) -> Option<ArmFigure> {
    let shown = shown(session);
    ui.add_space(4.0);
    let tabs: Vec<_> = tabs(session)
        .map(|value| Tab { name: value.name(), tooltip: tooltip(session.rig(), value), value })
        .collect();
    actions.extend(widgets::tabs(ui, shown, &tabs).map(ViewAction::ShowTab));
    ui.separator();
    // Each page is scrolled on its own.
    let mut figure = None;
    ScrollArea::vertical().id_salt(shown).auto_shrink(false).show(ui, |ui| {
        match (session.rig(), shown) {
            (RigKind::Arm, PanelTab::Solver) => explain::closed_form(ui, session),
            (RigKind::Arm, PanelTab::Twist) => explain::twist(ui, session, actions),
            (RigKind::Arm, PanelTab::Reach) => explain::reach(ui, session),
            (RigKind::Arm, PanelTab::Pops) => explain::pops(ui, session, actions),
            (RigKind::Arm, _) => figure = explain::triangle(ui, session, actions),
            (RigKind::Skeleton, PanelTab::Race) => solver::race(ui, session, actions),
            (RigKind::Skeleton, PanelTab::Skin) => solver::skin(ui, session),
            (RigKind::Skeleton, _) => solver::solver(ui, session, actions),
        }
        ui.add_space(8.0);
    });
    figure
}

/// The tabs of the rig. The page of the skin is there while the skin is compared.
fn tabs(session: &Session) -> impl Iterator<Item = PanelTab> + use<> {
    let compares = session.compares_skinning();
    let tabs = PanelTab::of(session.rig()).iter().copied();
    tabs.filter(move |tab| *tab != PanelTab::Skin || compares)
}

/// The chosen tab, or the first if the chosen one is not there.
fn shown(session: &Session) -> PanelTab {
    let chosen = session.tab();
    let mut all = tabs(session);
    let first = all.next().unwrap_or(chosen);
    if all.any(|tab| tab == chosen) { chosen } else { first }
}

fn tooltip(rig: RigKind, tab: PanelTab) -> &'static str {
    match (rig, tab) {
        (_, PanelTab::Triangle) => "Show the triangle of shoulder, elbow and hand",
        (_, PanelTab::Twist) => "Compare what the Socket twist can be measured from",
        (_, PanelTab::Reach) => "Show how near and how far the hand can be",
        (_, PanelTab::Pops) => "Show where the elbow jumped, and why",
        (RigKind::Arm, PanelTab::Solver) => "Show why the arm needs no iterations",
        (RigKind::Skeleton, PanelTab::Solver) => "Watch a solver bring the tips to their targets",
        (_, PanelTab::Race) => "Run all solvers on the same targets",
        (_, PanelTab::Skin) => "Plot the skin's cross-section for each way of blending joints",
    }
}
