//! The panels: functions that read a session and push actions. They use neither a window nor a GPU.

mod commands;
mod dialogs;
mod embedded;
mod frame_times;
mod gizmo;
mod glossary;
mod keyboard;
mod labels;
mod menu_bar;
mod panels;
mod parts;
mod pose_summary;
mod status_bar;
pub mod style;
mod timeline;
mod tour;
mod viewport;
mod widgets;

pub use frame_times::{FrameTime, FrameTimes, Machine, TimeSpread};
pub use keyboard::{hold_typed, strokes};
pub use parts::Parts;

use egui::{CentralPanel, Panel, Rect, Ui, UiBuilder};

use crate::session::{Actions, Dialog, SelectAction, Session};
use panels::crowd;

/// Least height of the view beside an open timeline, in points.
const VIEW_HEIGHT: f32 = 360.0;

/// Shows all panels, or those of a part of another page, and returns the rectangle of the viewport in
/// points. The viewport is left empty: the scene is drawn there before the panels.
pub fn show(ui: &mut Ui, session: &Session, machine: &Machine, actions: &mut Actions) -> Rect {
    if let Some(parts) = machine.parts {
        return embedded::show(ui, session, parts, actions);
    }
    keyboard::focus::begin(ui);
    keyboard::global(ui, session, actions);
    tour::open_section(ui, session);
    Panel::top("menu").show(ui, |ui| menu_bar::ui(ui, session, actions));
    let status = reserve(Panel::bottom("status"), ui, Some(status_bar::HEIGHT));
    let transport = reserve(Panel::bottom("transport"), ui, Some(timeline::TRANSPORT_HEIGHT));
    let keys = session.preferences().shows_timeline(session.document()).then(|| {
        // In a low window the timeline gives way to the view.
        let most = (ui.available_height() - VIEW_HEIGHT).clamp(88.0, 328.0);
        let height = timeline::height(ui, session).clamp(88.0, most);
        // Curves need more height than rows, so each of both keeps its own.
        let id = if session.preferences().curves { "curves" } else { "keys" };
        let panel = Panel::bottom(id).default_size(height).size_range(88.0..=most);
        reserve(panel.resizable(true), ui, None)
    });
    Panel::left("controls")
        .resizable(true)
        .default_size(272.0)
        .size_range(232.0..=420.0)
        .show(ui, |ui| panels::left(ui, session, actions));
    let explain = (session.preferences().explain && panels::has_room(ui)).then(|| {
        let panel = Panel::right("explain").default_size(284.0).size_range(284.0..=460.0);
        reserve(panel.resizable(true), ui, None)
    });
    if let Some(step) = session.tour() {
        let height = tour::height(ui.available_width());
        Panel::bottom("tour").exact_size(height).show(ui, |ui| {
            tour::card(ui, session, step, actions);
        });
    }
    let viewport = CentralPanel::no_frame().show(ui, |ui| viewport::ui(ui, session, actions)).inner;
    let figure = explain.and_then(|explain| panels::right(&mut explain.ui(ui), session, actions));
    if figure != session.selection().figure() {
        actions.push(SelectAction::Figure(figure));
    }
    if let Some(keys) = keys {
        timeline::ui(&mut keys.ui(ui), session, actions);
    }
    timeline::transport(&mut transport.ui(ui), session, actions);
    status_bar::ui(&mut status.ui(ui), session, actions);
    let is_covered = session.shell().dialog().is_some_and(Dialog::is_modal);
    if session.preferences().offers_tour && session.tour().is_none() && !is_covered {
        tour::offer(ui, viewport, actions);
    }
    crowd::ui(ui, viewport, session, machine, actions);
    dialogs::ui(ui, session, machine, viewport, actions);
    keyboard::focus::end(ui);
    viewport
}

/// The inside of a panel whose contents come later.
///
/// egui lays panels out from the edges of the window to its centre, but Tab goes through widgets in
/// the order in which they are added, and that should be the order of reading.
struct Reserved {
    rect: Rect,
    clip: Rect,
}

/// Shows an empty panel. `height` is that of its contents; `None` if the panel is resizable.
fn reserve(panel: Panel, ui: &mut Ui, height: Option<f32>) -> Reserved {
    let shown = panel.show(ui, |ui| {
        if let Some(height) = height {
            ui.set_height(height);
        }
        let rect = ui.max_rect();
        ui.expand_to_include_rect(rect);
        Reserved { rect, clip: ui.clip_rect() }
    });
    shown.inner
}

impl Reserved {
    /// A part of `ui` for the contents of the panel.
    fn ui(self, ui: &mut Ui) -> Ui {
        let mut inside = ui.new_child(UiBuilder::new().max_rect(self.rect));
        inside.set_clip_rect(self.clip);
        inside
    }
}
