//! The layout of the window.

use egui::{CentralPanel, Panel, Rect, TextureId, Ui};

use super::panels::{crowd, left, right};
use super::{Machine, dialogs, keyboard, menu_bar, status_bar, timeline, tour, viewport};
use crate::session::{Actions, Session};

/// Least height of the view beside an open timeline, in points.
const VIEW_HEIGHT: f32 = 360.0;

/// Shows all panels and returns the rectangle of the viewport in points. `picture` is the texture
/// into which the scene is rendered; `None` while there is no graphics device.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    machine: &Machine,
    picture: Option<TextureId>,
    actions: &mut Actions,
) -> Rect {
    keyboard::focus::begin(ui);
    keyboard::global(ui, session, actions);
    tour::open_section(ui, session);
    Panel::top("menu").show(ui, |ui| menu_bar::ui(ui, session, actions));
    Panel::bottom("status").show(ui, |ui| status_bar::ui(ui, session, actions));
    Panel::bottom("transport").show(ui, |ui| timeline::transport(ui, session, actions));
    if session.shows_timeline() {
        // In a low window the timeline gives way to the view.
        let most = (ui.available_height() - VIEW_HEIGHT).clamp(88.0, 328.0);
        Panel::bottom("keys")
            .resizable(true)
            .default_size(120.0)
            .size_range(88.0..=most)
            .show(ui, |ui| timeline::ui(ui, session, actions));
    }
    Panel::left("controls")
        .resizable(true)
        .default_size(272.0)
        .size_range(232.0..=420.0)
        .show(ui, |ui| left::ui(ui, session, actions));
    if session.preferences().explain && right::has_room(ui) {
        Panel::right("explain")
            .resizable(true)
            .default_size(272.0)
            .size_range(232.0..=460.0)
            .show(ui, |ui| right::ui(ui, session, actions));
    }
    if let Some(step) = session.tour() {
        let height = tour::height(ui.available_width());
        Panel::bottom("tour").exact_size(height).show(ui, |ui| {
            tour::card(ui, session, step, actions);
        });
    }
    let viewport =
        CentralPanel::no_frame().show(ui, |ui| viewport::ui(ui, session, picture, actions)).inner;
    if session.preferences().offers_tour && session.tour().is_none() {
        tour::offer(ui, viewport, actions);
    }
    crowd::ui(ui, viewport, session, machine, actions);
    dialogs::ui(ui, session, machine, viewport, actions);
    keyboard::focus::end(ui);
    viewport
}
