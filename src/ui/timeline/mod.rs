//! The panel below the viewport: playing, and the keys in lanes or as curves.

mod dope_sheet;
mod graph_editor;
mod held;
mod icon;
mod keys;
mod menu;
mod names;
mod pointer;
mod rows;
mod ruler;
mod scale;
mod transport;

use egui::{Rect, Response, Ui, pos2};

use crate::session::{Action, Session};
pub(super) use keys::{everywhere, has_the_word, holds, leave_space};
pub(super) use names::channel;
use scale::Scale;

/// Of the column with the names.
const NAMES: f32 = 180.0;
const RULER: f32 = 24.0;
const ROW: f32 = 20.0;

pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    transport::ui(ui, session, actions);
    let areas = Areas::new(ui.available_rect_before_wrap());
    ui.expand_to_include_rect(areas.whole);
    let timeline = session.document().timeline;
    let mut scale = Scale::load(ui, timeline, areas.lanes.x_range());
    let is_panning = matches!(held::get(ui), Some(held::Held::Pan));
    let wheeled = Rect::from_min_max(areas.ruler.min, areas.lanes.max);
    scale.follow_input(ui, session, wheeled, is_panning);

    ruler::ground(ui, scale, timeline, wheeled);
    ruler::grid(ui, scale, timeline, areas.lanes);
    let ruler = ruler::ui(ui, session, scale, areas.ruler, actions);
    if session.preferences().curves {
        graph_editor::ui(ui, session, scale, &areas, &ruler, actions);
    } else {
        dope_sheet::ui(ui, session, scale, &areas, &ruler, actions);
    }
    ruler::playhead(ui, session, scale, areas.ruler, areas.lanes.bottom());
    keys::focused(ui, session, actions);
}

/// A press or a click in an area gives the ruler the keyboard for the whole timeline; a click beside
/// the ruler has just taken it away.
fn take_keyboard(ui: &Ui, area: &Response, ruler: &Response) {
    let touched = ui.input(|input| input.pointer.any_pressed() || input.pointer.any_click());
    if touched && area.contains_pointer() {
        ruler.request_focus();
    }
}

/// What is where in the panel.
struct Areas {
    whole: Rect,
    /// Beside the lanes.
    names: Rect,
    ruler: Rect,
    lanes: Rect,
}

impl Areas {
    fn new(whole: Rect) -> Self {
        let split = (whole.left() + NAMES).min(whole.right());
        let top = (whole.top() + RULER).min(whole.bottom());
        Self {
            whole,
            names: Rect::from_min_max(pos2(whole.left(), top), pos2(split, whole.bottom())),
            ruler: Rect::from_min_max(pos2(split, whole.top()), pos2(whole.right(), top)),
            lanes: Rect::from_min_max(pos2(split, top), whole.max),
        }
    }
}
