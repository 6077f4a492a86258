//! The panels beside and over the viewport. On the left are the rig's settings, guides and display;
//! on the right are pages that explain the pose.

pub(in crate::ui) mod crowd;
mod explain;
mod limb;
mod skeleton;
mod solver;
pub(in crate::ui) mod statistics;

use egui::{CentralPanel, ScrollArea, Ui};

use super::parts::Parts;
use super::widgets;
use crate::document::Overlay;
use crate::session::{Actions, DisplayEdit, LimbFigure, PanelTab, Session, ViewAction};
pub(super) use explain::{globe_legend, triangle};
use limb::LimbTarget;
pub(super) use skeleton::{ADD_TARGETS, BIND, may_be_person, target_name};

pub(super) fn left(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let height = ui.available_height();
    skeleton::outliner(ui, session, actions);
    CentralPanel::no_frame().show(ui, |ui| {
        let note = skeleton::noted(session);
        let room = ui.available_height() - note.map_or(0.0, |_| skeleton::note_height(height));
        let rows = ScrollArea::vertical().auto_shrink(false).max_height(room);
        rows.show(ui, |ui| widgets::whole_rows(ui, |ui| properties(ui, session, actions)));
        if let Some(target) = note {
            skeleton::note(ui, session, &target, actions);
        }
    });
}

/// Shows what is selected, the rig, the guides and the display.
fn properties(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let limb = LimbTarget::sole(session);
    match limb {
        Some(limb) => limb::ui(ui, limb, actions),
        None => {
            skeleton::selected(ui, session, actions);
            skeleton::ui(ui, session, actions);
        }
    }
    if let Some(limb) = limb {
        guides(ui, session, true, actions);
        limb::more(ui, limb, actions);
        skeleton::skin_section(ui, session, actions);
        skeleton::selected(ui, session, actions);
    }
    let bodies = [Overlay::Cylinders, Overlay::Hand, Overlay::Paths];
    let display: Vec<_> = Overlay::SURROUNDINGS.into_iter().chain(bodies).collect();
    widgets::folded_section(ui, "Display", |ui| {
        widgets::check_boxes(ui, session, 3, &display, None, actions);
        if limb.is_none() {
            guides(ui, session, false, actions);
        }
    });
    resets(ui, actions);
    ui.add_space(8.0);
}

/// Shows the controls of a part of another page.
pub(super) fn of_parts(ui: &mut Ui, session: &Session, parts: Parts, actions: &mut Actions) {
    let limb = LimbTarget::sole(session);
    if let Some(limb) = limb.filter(|_| parts.hand) {
        limb::hand_section(ui, limb, actions);
    }
    if let Some(limb) = limb.filter(|_| parts.twist) {
        limb::twist_section(ui, limb, actions);
    }
    if parts.guides {
        guides(ui, session, limb.is_some(), actions);
    }
}

fn guides(ui: &mut Ui, session: &Session, is_limb: bool, actions: &mut Actions) {
    if is_limb {
        widgets::section(ui, "Guides", |ui| {
            let globe = [Overlay::SingularityGlobe];
            let all: Vec<_> = Overlay::GUIDES.into_iter().chain(globe).collect();
            widgets::check_boxes(ui, session, 2, &all, None, actions);
        });
    } else {
        widgets::named_section(ui, "guides of a figure", "Guides", |ui| {
            widgets::check_boxes(ui, session, 2, &FIGURE_GUIDES, None, actions);
        });
    }
}

/// Guides of a figure.
const FIGURE_GUIDES: [Overlay; 11] = [
    Overlay::Cursor,
    Overlay::Pointer,
    Overlay::InnerLimit,
    Overlay::OuterLimit,
    Overlay::ElbowCircle,
    Overlay::FkPose,
    Overlay::ByItself,
    Overlay::Stiffness,
    Overlay::Balance,
    Overlay::ReachRegion,
    Overlay::JointLimits,
];

fn resets(ui: &mut Ui, actions: &mut Actions) {
    ui.horizontal(|ui| {
        let tooltip = "Reset the arm; set every joint angle of a figure to 0";
        if widgets::button(ui, "Reset pose", tooltip, None) {
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
    let tabs: Vec<_> = tabs(session).map(|tab| (tab, tab.name(), tooltip(tab))).collect();
    actions.extend(widgets::tabs(ui, shown, &tabs).map(ViewAction::ShowTab));
    ui.separator();
    // Each page is scrolled on its own.
    let mut figure = None;
    ScrollArea::vertical().id_salt(shown).auto_shrink(false).show(ui, |ui| {
        figure = widgets::whole_rows(ui, |ui| page(ui, session, shown, actions));
    });
    figure
}

fn page(
    ui: &mut Ui,
    session: &Session,
    shown: PanelTab,
    actions: &mut Actions,
) -> Option<LimbFigure> {
    let mut figure = None;
    match shown {
        PanelTab::Triangle => figure = explain::triangle(ui, session, actions),
        PanelTab::Twist => explain::twist(ui, session, actions),
        PanelTab::Reach => explain::reach(ui, session, actions),
        PanelTab::Pops => explain::pops(ui, session, actions),
        PanelTab::Solver => {
            if session.rig().sole_limb().is_some() {
                explain::closed_form(ui, session);
                ui.separator();
            }
            solver::solver(ui, session, actions);
        }
        PanelTab::Race => solver::race(ui, session, actions),
        PanelTab::Skin => skeleton::skin_areas(ui, session),
    }
    ui.add_space(8.0);
    figure
}

/// The tabs: those of limbs if the figure has one, that of the race if it is more than one limb,
/// that of the skin while the skin is compared.
fn tabs(session: &Session) -> impl Iterator<Item = PanelTab> + use<> {
    let compares = session.shown().compares_skinning();
    let has_limb = session.limb().is_some();
    let is_limb = session.rig().sole_limb().is_some();
    PanelTab::ALL.into_iter().filter(move |tab| match tab {
        PanelTab::Skin => compares,
        PanelTab::Race => !is_limb,
        tab => has_limb || !tab.is_of_limb(),
    })
}

/// The chosen tab, or the solver's if the chosen one is not there.
fn shown(session: &Session) -> PanelTab {
    let chosen = session.preferences().tab;
    if tabs(session).any(|tab| tab == chosen) { chosen } else { PanelTab::Solver }
}

fn tooltip(tab: PanelTab) -> &'static str {
    match tab {
        PanelTab::Triangle => "Show the triangle of shoulder, elbow and hand",
        PanelTab::Twist => "Compare what the Socket twist can be measured from",
        PanelTab::Reach => "Show how near and how far the hand can be",
        PanelTab::Pops => "Show where joints jump, targets are lost and feet slide, and why",
        PanelTab::Solver => "Watch a solver bring the tips to their targets",
        PanelTab::Race => "Run all solvers on the same targets",
        PanelTab::Skin => "Plot the skin's cross-section for each way of blending joints",
    }
}
