//! The transport bar: playback and time; while the timeline is open also keying and the settings of
//! playback, while it is closed a ruler.

use egui::{Button, Grid, Popup, PopupCloseBehavior, Rect, RichText, Ui, vec2};

use super::time_scale::TimeScale;
use super::{keyboard, rows, ruler};
use crate::document::Timeline;
use crate::session::{Action, Actions, KeysEdit, PlaybackAction, Session, ViewAction};
use crate::ui::widgets::{self, DragNumber, Icon, IconButton, text};

const GAP: f32 = 8.0;
/// Height of the bar in points.
pub(in crate::ui) const HEIGHT: f32 = 28.0;

/// Shows the bar of the closed timeline.
pub(in crate::ui) fn slim(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    /// Width in points of the button at the right end.
    const OPEN: f32 = 70.0;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.set_height(HEIGHT);
        to_start(ui, session, actions);
        play(ui, session, actions);
        to_end(ui, session, actions);
        repeat(ui, session, actions);
        ui.add_space(GAP);
        seconds(ui, session, actions);
        ui.add_space(GAP);
        let width = ui.available_width() - GAP - OPEN;
        let (_, rect) = ui.allocate_space(vec2(width.max(0.0), rows::RULER));
        rail(ui, session, rect, actions);
        ui.add_space(GAP);
        let tooltip = "Show keys over time";
        if widgets::button(ui, "Timeline", tooltip, None) {
            actions.push(ViewAction::ShowTimeline(true));
        }
    });
}

/// Shows the whole range of the timeline as a ruler, with the playhead, or a note if nothing moves.
fn rail(ui: &mut Ui, session: &Session, rect: Rect, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let scale = TimeScale::showing(rect.x_range(), timeline.start, timeline.end);
    ruler::ground(ui, scale, timeline, rect);
    let is_empty = nothing_to_play(session).is_some();
    ruler::ui(ui, session, scale, (rect, !is_empty), actions);
    if is_empty {
        let note = "No animation yet: add keys in the timeline";
        ui.put(rect, egui::Label::new(RichText::new(note).weak()).selectable(false));
    }
    ruler::playhead(ui, session, scale, rect, rect.bottom());
    ruler::auto_key_note(ui, session, scale, rect, actions);
    keyboard::focused(ui, session, actions);
}

/// Shows the bar of the open timeline.
pub(in crate::ui) fn whole(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.set_height(HEIGHT);
        buttons(ui, session, actions);
        ui.add_space(GAP);
        time(ui, session, actions);
        ui.add_space(GAP);
        keying(ui, session, actions);
        ui.add_space(GAP);
        widgets::at_right(ui, |ui| {
            settings(ui, session, actions);
            curves(ui, session, actions);
            let hide = ui.button("Hide").on_hover_text("Hide the keys");
            widgets::name(ui, &hide, "Hide timeline");
            if hide.clicked() {
                actions.push(ViewAction::ShowTimeline(false));
            }
        });
    });
}

fn buttons(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    to_start(ui, session, actions);
    let before = keyboard::key_before(session);
    let tooltip = "Go to the previous key (up arrow in the timeline)";
    let why = before.is_none().then_some("No key before the playhead");
    if IconButton::new(Icon::PreviousKey, "Previous key", tooltip, why).show(ui) {
        actions.extend(before.map(PlaybackAction::SetTime));
    }
    play(ui, session, actions);
    let after = keyboard::key_after(session);
    let tooltip = "Go to the next key (down arrow in the timeline)";
    let why = after.is_none().then_some("No key after the playhead");
    if IconButton::new(Icon::NextKey, "Next key", tooltip, why).show(ui) {
        actions.extend(after.map(PlaybackAction::SetTime));
    }
    to_end(ui, session, actions);
    repeat(ui, session, actions);
}

fn to_start(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let tooltip = "Go to the start (Home in the timeline)";
    if IconButton::new(Icon::Start, "To start", tooltip, None).show(ui) {
        actions.push(PlaybackAction::SetTime(session.document().timeline.start));
    }
}

fn to_end(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let tooltip = "Go to the end (End in the timeline)";
    if IconButton::new(Icon::End, "To end", tooltip, None).show(ui) {
        actions.push(PlaybackAction::SetTime(session.document().timeline.end));
    }
}

fn repeat(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let looping = session.playback().is_looping();
    let tooltip = "Repeat from the start when playback reaches the end";
    let (on, disabled) = (Some(looping), nothing_to_play(session));
    if (IconButton { on, ..IconButton::new(Icon::Loop, "Loop", tooltip, disabled) }).show(ui) {
        actions.push(PlaybackAction::SetLooping(!looping));
    }
}

fn play(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    /// In points, the same for both names.
    const WIDTH: f32 = 74.0;
    let playing = session.playback().is_playing();
    let (icon, name) = if playing { (Icon::Pause, "Pause") } else { (Icon::Play, "Play") };
    let tooltip = "Play or pause (Space)";
    let button = IconButton::new(icon, name, tooltip, nothing_to_play(session));
    if (IconButton { named: Some(WIDTH), ..button }).show(ui) {
        actions.push(PlaybackAction::Play(!playing));
    }
}

/// Why the motion cannot be played; `None` if it can.
fn nothing_to_play(session: &Session) -> Option<&'static str> {
    let can_play = session.playback().is_playing() || session.document().is_moving();
    (!can_play).then_some("Nothing to play: add keys at two times (K) or move a target")
}

/// A number field.
struct TimeField<'a> {
    name: &'a str,
    value: f64,
    unit: &'a str,
    speed: f32,
    digits: usize,
    tooltip: &'a str,
}

impl TimeField<'_> {
    /// In points.
    const WIDTH: f32 = 74.0;

    fn show<A: Into<Action>>(
        self,
        ui: &mut Ui,
        is_editing: bool,
        actions: &mut Actions,
        set: impl Fn(f64) -> A,
    ) {
        let Self { name, value, unit, speed, digits, .. } = self;
        let format = &|value| text::fixed(value, digits);
        let number = DragNumber { name, value, unit, speed, width: Self::WIDTH, format };
        number.show(ui, is_editing, actions, set).on_hover_text(self.tooltip);
    }

    /// Shows a number that does not belong to the document, so that a drag of it opens no
    /// transaction.
    fn show_free<A: Into<Action>>(
        self,
        ui: &mut Ui,
        actions: &mut Actions,
        set: impl Fn(f64) -> A,
    ) {
        let mut own = Actions::new();
        self.show(ui, true, &mut own, set);
        own.retain(|action| !matches!(action, Action::Transaction(_)));
        actions.extend(own);
    }
}

fn label(ui: &mut Ui, text: &str) {
    ui.add(egui::Label::new(RichText::new(text).weak()).selectable(false));
}

fn time(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    seconds(ui, session, actions);
    ui.add_space(GAP);
    label(ui, "Frame");
    let timeline = session.document().timeline;
    let frame = TimeField {
        name: "Frame",
        value: timeline.number(session.playback().time()).round() + 0.0,
        unit: "",
        speed: 0.25,
        digits: 0,
        tooltip: "Set the time in frames: drag or type",
    };
    let set = |frame: f64| PlaybackAction::SetTime(timeline.time_of_number(frame.round()));
    frame.show_free(ui, actions, set);
}

fn seconds(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let rate = timeline.frame_rate;
    let is_dragged = ui.input(|input| input.pointer.any_down());
    let set =
        |time| PlaybackAction::SetTime(if is_dragged { timeline.snapped(time) } else { time });
    let seconds = TimeField {
        name: "Time",
        value: session.playback().time(),
        unit: " s",
        speed: 0.25 / rate as f32,
        digits: 2,
        tooltip: "Set the time in seconds (left and right arrow in the timeline)",
    };
    seconds.show_free(ui, actions, set);
}

fn keying(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let channels = KeysEdit::channels_to_key(session);
    let nothing = "Nothing to key";
    let why = channels.is_empty().then_some(nothing);
    let tooltip = "Key the selection, else hand and Socket twist (K); Shift+K keys every channel";
    if widgets::button(ui, "Key", tooltip, why) {
        actions.push(KeysEdit::Key(channels));
    }
    auto_key(ui, session, actions);
}

fn auto_key(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    /// In points.
    const WIDTH: f32 = 88.0;
    let on = session.playback().is_auto_key();
    let tooltip = if on {
        "Stop adding keys with every edit"
    } else {
        "Add keys at the playhead with every edit"
    };
    let button = IconButton::new(Icon::Record, "Auto-key", tooltip, None);
    if (IconButton { on: Some(on), named: Some(WIDTH), ..button }).show(ui) {
        actions.push(PlaybackAction::SetAutoKey(!on));
    }
}

/// Shows the button that opens speed, range and frame rate.
fn settings(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let button = ui.button("Playback").on_hover_text("Set speed, start, end and frame rate");
    let popup = Popup::from_toggle_button_response(&button);
    popup.close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        Grid::new("playback").num_columns(2).spacing(vec2(GAP, GAP)).show(ui, |ui| {
            label(ui, "Speed");
            speed(ui, session, actions);
            ui.end_row();
            ends(ui, session, actions);
        });
        ui.add_space(GAP);
        label(ui, "Frame rate");
        frame_rate(ui, session, actions);
    });
}

fn speed(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let speed = TimeField {
        name: "Speed",
        value: session.playback().speed(),
        unit: "×",
        speed: 0.01,
        digits: 2,
        tooltip: "Set the playback speed, 0.1 to 4",
    };
    speed.show_free(ui, actions, PlaybackAction::SetSpeed);
}

fn frame_rate(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    const COLUMNS: usize = 3;
    /// In points.
    const WIDTH: f32 = 80.0;
    let timeline = session.document().timeline;
    let name = |rate: f64| format!("{} fps", (rate * 1000.0).round() / 1000.0);
    let mut rates = Timeline::FRAME_RATES.to_vec();
    if !rates.contains(&timeline.frame_rate) {
        rates.push(timeline.frame_rate);
    }
    Grid::new("frame rates").num_columns(COLUMNS).spacing(vec2(4.0, 4.0)).show(ui, |ui| {
        for row in rates.chunks(COLUMNS) {
            for frame_rate in row.iter().copied() {
                let chosen = frame_rate == timeline.frame_rate;
                let button = Button::selectable(chosen, name(frame_rate));
                let button = ui.add(button.min_size(vec2(WIDTH, 0.0)).frame_when_inactive(true));
                let button = button.on_hover_text("Set frames per second, for snapping and export");
                if button.clicked() && !chosen {
                    actions.push(KeysEdit::SetTimeline(Timeline { frame_rate, ..timeline }));
                }
            }
            ui.end_row();
        }
    });
}

fn ends(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let field = |name, value, tooltip| TimeField {
        name,
        value,
        unit: " s",
        speed: 0.02,
        digits: 2,
        tooltip,
    };
    let is_editing = session.history().is_editing();
    label(ui, "Start");
    let start = field("Start", timeline.start, "Set the start of the timeline");
    start.show(ui, is_editing, actions, |start| {
        KeysEdit::SetTimeline(Timeline { start, ..timeline })
    });
    ui.end_row();
    label(ui, "End");
    let end = field("End", timeline.end, "Set the end of the timeline");
    end.show(ui, is_editing, actions, |end| KeysEdit::SetTimeline(Timeline { end, ..timeline }));
    ui.end_row();
}

fn curves(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let on = session.preferences().curves;
    let button = egui::Button::selectable(on, "Graph editor").frame_when_inactive(true);
    let tooltip =
        if on { "Show keys in a dope sheet" } else { "Show the selected channels as curves" };
    if ui.add(button).on_hover_text(tooltip).clicked() {
        actions.push(ViewAction::ShowGraphEditor(!on));
    }
}
