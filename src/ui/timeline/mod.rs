//! The transport bar, and above it the timeline: ruler, and dope sheet or graph editor.

mod context_menu;
mod dope_sheet;
mod drag;
mod graph_editor;
mod keyboard;
mod rows;
mod ruler;
mod time_scale;
mod transport_bar;
mod value_scale;

pub(in crate::ui) use keyboard::{everywhere, has_the_word, holds};
pub(in crate::ui) use transport_bar::HEIGHT as TRANSPORT_HEIGHT;

use egui::{Rect, Ui};

use crate::session::{Actions, Session};
use rows::{Folds, TimelineAreas};
use time_scale::TimeScale;

/// Shows the transport bar, with a ruler of its own while the timeline is closed.
pub(in crate::ui) fn transport(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    if session.preferences().shows_timeline(session.document()) {
        transport_bar::whole(ui, session, actions);
    } else {
        transport_bar::slim(ui, session, actions);
    }
}

/// Height at first of the timeline of a document, in points: enough for its rows, up to some whole
/// rows, and for curves to be read.
pub(in crate::ui) fn height(ui: &Ui, session: &Session) -> f32 {
    const ROWS: (usize, usize) = (4, 7);
    const OF_CURVES: usize = 10;
    let rows = match session.preferences().curves {
        true => OF_CURVES,
        false => rows::rows(session, &Folds::kept(ui)).len(),
    };
    let most = if session.preferences().curves { OF_CURVES } else { ROWS.1 };
    rows::RULER + rows::ROW * rows.clamp(ROWS.0, most) as f32 + 8.0
}

/// Shows the timeline.
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let curves = session.preferences().curves;
    let areas = TimelineAreas::new(ui.available_rect_before_wrap());
    ui.expand_to_include_rect(areas.whole);
    let timeline = session.document().timeline;
    let mut scale = TimeScale::load(ui, session, areas.keys.x_range());
    let wheeled = Rect::from_min_max(areas.ruler.min, areas.keys.max);
    scale.follow_input(ui, session, wheeled, curves.then_some(areas.keys), drag::is_panning(ui));

    // First, so that Tab goes through it before the keys below it.
    ruler::auto_key_note(ui, session, scale, areas.ruler, actions);
    ruler::ground(ui, scale, timeline, wheeled);
    ruler::grid(ui, scale, timeline, areas.keys);
    let ruler = ruler::ui(ui, session, scale, (areas.ruler, true), actions);
    if curves {
        graph_editor::ui(ui, session, scale, &areas, &ruler, actions);
    } else {
        dope_sheet::ui(ui, session, scale, &areas, &ruler, actions);
    }
    ruler::playhead(ui, session, scale, areas.ruler, areas.keys.bottom());
    keyboard::focused(ui, session, actions);
}
