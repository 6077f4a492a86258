//! The program as a part of another page: the view, with some of its controls.

use egui::{CentralPanel, Panel, Rect, ScrollArea, Ui};

use super::parts::Parts;
use super::{keyboard, panels, viewport};
use crate::session::{Actions, SelectAction, Session};

/// Width of the window below which controls are below the view instead of beside it, in points.
const NARROW: f32 = 560.0;
/// Width of the controls and of the triangle beside the view, in points.
const CONTROLS: f32 = 250.0;
const TRIANGLE: f32 = 284.0;

/// Shows the view with these parts, and returns the rectangle of the view in points.
pub(super) fn show(ui: &mut Ui, session: &Session, parts: Parts, actions: &mut Actions) -> Rect {
    keyboard::focus::begin(ui);
    keyboard::global(ui, session, actions);
    let size = ui.available_size();
    let is_narrow = size.x < NARROW;
    let controls = |ui: &mut Ui, actions: &mut Actions| {
        ScrollArea::vertical().auto_shrink([false, true]).show(ui, |ui| {
            ui.add_space(4.0);
            panels::of_parts(ui, session, parts, actions);
        });
    };
    if parts.has_controls() && is_narrow {
        Panel::bottom("controls of the part")
            .max_size(0.45 * size.y)
            .show(ui, |ui| controls(ui, actions));
    } else if parts.has_controls() {
        Panel::left("controls of the part")
            .exact_size(CONTROLS)
            .show(ui, |ui| controls(ui, actions));
    }
    let mut figure = None;
    if parts.triangle && !is_narrow {
        Panel::right("triangle of the part").exact_size(TRIANGLE).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.add_space(4.0);
                figure = panels::triangle(ui, session, actions);
            });
        });
    }
    if figure != session.selection().figure() {
        actions.push(SelectAction::Figure(figure));
    }
    let viewport = CentralPanel::no_frame().show(ui, |ui| viewport::ui(ui, session, actions)).inner;
    keyboard::focus::end(ui);
    viewport
}
