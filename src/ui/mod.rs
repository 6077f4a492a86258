//! The panels: functions that read a session and push actions. They know no window and no GPU.

mod arm;
mod arm_grips;
mod comparison;
mod compass;
mod controls;
mod convergence;
mod crowd;
mod dialogs;
mod elbow;
mod explain;
mod export;
mod figure;
mod fk_ik;
mod frame_times;
mod grips;
mod handles;
mod joint;
mod keyboard;
mod limits;
mod menu;
mod motion;
mod number;
mod outliner;
mod plot;
mod point;
mod pops;
mod reach_curve;
mod references;
mod ring;
mod shortcuts;
mod slider;
mod solver;
mod statistics;
mod status;
mod strokes;
pub mod style;
mod symbol;
mod targets;
mod timeline;
mod triangle;
mod viewport;
mod widgets;
mod wrist;

use egui::{CentralPanel, Panel, Rect, TextureId, Ui};

pub use frame_times::{Frame, FrameTimes, Spread};
pub use strokes::{hold_typed, strokes};

use crate::document::RigKind;
use crate::render::Counts;
use crate::rig::CrowdTimes;
use crate::session::{Action, Session};

/// What the panels show of the machine they run on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machine {
    /// The graphics adapter.
    pub adapter: String,
    /// Whether it measures its own time.
    pub has_clock: bool,
    /// How long the last drawn frames took.
    pub times: FrameTimes,
    /// What is in the scene that was drawn last.
    pub counts: Option<Counts>,
    /// How long the crowd took that is shown.
    pub crowd: Option<CrowdTimes>,
    /// Whether the menu Help has what is for tests of the program.
    pub shows_debug_actions: bool,
}

/// Shows everything. Returns where the scene is to be drawn, in points; `picture` is the scene as
/// last drawn there.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    machine: &Machine,
    picture: Option<TextureId>,
    actions: &mut Vec<Action>,
) -> Rect {
    keyboard::global(ui, session, actions);
    Panel::top("menu").show(ui, |ui| menu::ui(ui, session, machine, actions));
    Panel::bottom("status").show(ui, |ui| status::ui(ui, session, machine, actions));
    if session.preferences().timeline {
        Panel::bottom("timeline")
            .resizable(true)
            .default_size(152.0)
            .size_range(120.0..=360.0)
            .show(ui, |ui| timeline::ui(ui, session, actions));
    }
    Panel::left("controls")
        .resizable(true)
        .default_size(272.0)
        .size_range(232.0..=420.0)
        .show(ui, |ui| controls::ui(ui, session, actions));
    if session.preferences().explain {
        Panel::right("explain").resizable(true).default_size(272.0).size_range(232.0..=460.0).show(
            ui,
            |ui| match session.rig() {
                RigKind::Arm => explain::ui(ui, session, actions),
                RigKind::Skeleton => solver::ui(ui, session, actions),
            },
        );
    }
    let viewport =
        CentralPanel::no_frame().show(ui, |ui| viewport::ui(ui, session, picture, actions)).inner;
    crowd::ui(ui, viewport, session, machine, actions);
    dialogs::ui(ui, session, machine, viewport, actions);
    keyboard::remember(ui);
    viewport
}

/// Whether the change under way is a slider's, not that of something held in the viewport.
fn is_sliding(session: &Session) -> bool {
    session.is_editing() && session.drag().is_none()
}
