//! The transport bar: playback and time; while the timeline is open also keying, speed, frame rate
//! and range, while it is closed a ruler.

use egui::{ComboBox, Rect, RichText, Ui, vec2};

use super::time_scale::TimeScale;
use super::{keyboard, rows, ruler};
use crate::document::Timeline;
use crate::session::{Action, Actions, KeysEdit, PlaybackAction, Session, ViewAction};
use crate::ui::style;
use crate::ui::widgets::{self, DragNumber, Icon, IconButton, text};

/// Width of the bar in points up to which numbers have no labels.
const ROOMY: f32 = 1180.0;
const GAP: f32 = 8.0;
/// Space between groups where numbers have no labels.
const NARROW_GAP: f32 = 2.0;
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

/// Shows the whole range of the timeline as a ruler, with the playhead.
fn rail(ui: &mut Ui, session: &Session, rect: Rect, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let scale = TimeScale::showing(rect.x_range(), timeline.start, timeline.end);
    ruler::ground(ui, scale, timeline, rect);
    ruler::ui(ui, session, scale, rect, actions);
    ruler::playhead(ui, session, scale, rect, rect.bottom());
    ruler::auto_key_note(ui, session, scale, rect, actions);
    keyboard::focused(ui, session, actions);
}

/// Shows the bar of the open timeline.
pub(in crate::ui) fn whole(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let roomy = ui.available_width() > ROOMY;
    let gap = if roomy { GAP } else { NARROW_GAP };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.set_height(HEIGHT);
        buttons(ui, session, actions);
        ui.add_space(gap);
        time(ui, session, roomy, actions);
        ui.add_space(gap);
        keying(ui, session, actions);
        ui.add_space(gap);
        pace(ui, session, roomy, actions);
        ui.add_space(gap);
        ends(ui, session, roomy, actions);
        ui.add_space(gap);
        widgets::at_right(ui, |ui| {
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
    let playing = session.playback().is_playing();
    let (icon, name) = if playing { (Icon::Pause, "Pause") } else { (Icon::Play, "Play") };
    let tooltip = "Play or pause (Space)";
    let button = IconButton::new(icon, name, tooltip, nothing_to_play(session));
    if (IconButton { is_named: true, ..button }).show(ui) {
        actions.push(PlaybackAction::Play(!playing));
    }
}

/// Why the motion cannot be played; `None` if it can.
fn nothing_to_play(session: &Session) -> Option<&'static str> {
    let can_play = session.playback().is_playing() || session.document().is_moving();
    (!can_play).then_some("Nothing to play: add keys at two times (K) or move a target")
}

/// Distance of a label from the field before it, in points, so that it names the one after it.
const BEFORE_LABEL: f32 = 6.0;

/// A number field with a label.
struct TimeField<'a> {
    name: &'a str,
    /// Label, hidden in narrow windows.
    label: &'a str,
    value: f64,
    unit: &'a str,
    speed: f32,
    width: f32,
    digits: usize,
    tooltip: &'a str,
}

impl TimeField<'_> {
    fn show<A: Into<Action>>(
        self,
        ui: &mut Ui,
        roomy: bool,
        is_editing: bool,
        actions: &mut Actions,
        set: impl Fn(f64) -> A,
    ) {
        if roomy && !self.label.is_empty() {
            ui.add_space(BEFORE_LABEL);
            ui.add(egui::Label::new(RichText::new(self.label).weak()).selectable(false));
        }
        let Self { name, value, unit, speed, width, digits, .. } = self;
        let format = &|value| text::fixed(value, digits);
        let number = DragNumber { name, value, unit, speed, width, format };
        number.show(ui, is_editing, actions, set).on_hover_text(self.tooltip);
    }

    /// Shows a number that does not belong to the document, so that a drag of it opens no
    /// transaction.
    fn show_free<A: Into<Action>>(
        self,
        ui: &mut Ui,
        roomy: bool,
        actions: &mut Actions,
        set: impl Fn(f64) -> A,
    ) {
        let mut own = Actions::new();
        self.show(ui, roomy, true, &mut own, set);
        own.retain(|action| !matches!(action, Action::Transaction(_)));
        actions.extend(own);
    }
}

fn time(ui: &mut Ui, session: &Session, roomy: bool, actions: &mut Actions) {
    seconds(ui, session, actions);
    let timeline = session.document().timeline;
    let frame = TimeField {
        name: "Frame",
        label: "Frame",
        value: timeline.number(session.playback().time()).round() + 0.0,
        // Without its label the number needs a unit.
        unit: if roomy { "" } else { " f" },
        speed: 0.25,
        width: 74.0,
        digits: 0,
        tooltip: "Set the time in frames: drag or type",
    };
    let set = |frame: f64| PlaybackAction::SetTime(timeline.time_of_number(frame.round()));
    frame.show_free(ui, roomy, actions, set);
}

fn seconds(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let rate = timeline.frame_rate;
    let is_dragged = ui.input(|input| input.pointer.any_down());
    let set =
        |time| PlaybackAction::SetTime(if is_dragged { timeline.snapped(time) } else { time });
    let seconds = TimeField {
        name: "Time",
        label: "",
        value: session.playback().time(),
        unit: " s",
        speed: 0.25 / rate as f32,
        width: 70.0,
        digits: 2,
        tooltip: "Set the time in seconds (left and right arrow in the timeline)",
    };
    seconds.show_free(ui, false, actions, set);
}

fn keying(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let channels = KeysEdit::channels_to_key(session);
    let nothing = "Nothing to key";
    let why = channels.is_empty().then_some(nothing);
    let tooltip = "Key the selection, else hand and Socket twist (K); Shift+K keys every channel";
    if widgets::button(ui, "Key", tooltip, why) {
        actions.push(KeysEdit::Key(channels));
    }
    let on = session.playback().is_auto_key();
    let accent = style::accent(ui);
    let text = RichText::new("Auto-key");
    let button = if on {
        let text = text.color(ui.visuals().panel_fill);
        egui::Button::selectable(true, text).fill(accent)
    } else {
        egui::Button::selectable(false, text).frame_when_inactive(true)
    };
    let tooltip = if on {
        "Stop adding keys with every edit"
    } else {
        "Add keys at the playhead with every edit"
    };
    if ui.add(button).on_hover_text(tooltip).clicked() {
        actions.push(PlaybackAction::SetAutoKey(!on));
    }
}

fn pace(ui: &mut Ui, session: &Session, roomy: bool, actions: &mut Actions) {
    let speed = TimeField {
        name: "Speed",
        label: "",
        value: session.playback().speed(),
        unit: "×",
        speed: 0.01,
        width: 52.0,
        digits: 2,
        tooltip: "Set the playback speed, 0.1 to 4",
    };
    speed.show_free(ui, roomy, actions, PlaybackAction::SetSpeed);
    frame_rate(ui, session, actions);
}

fn frame_rate(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let name = |rate: f64| format!("{} fps", (rate * 1000.0).round() / 1000.0);
    let combo = ComboBox::from_id_salt("frame rate")
        .selected_text(name(timeline.frame_rate))
        .width(72.0)
        .truncate();
    let mut rates = Timeline::FRAME_RATES.to_vec();
    if !rates.contains(&timeline.frame_rate) {
        rates.push(timeline.frame_rate);
    }
    let response = combo.show_ui(ui, |ui| {
        for frame_rate in rates {
            let chosen = frame_rate == timeline.frame_rate;
            if ui.selectable_label(chosen, name(frame_rate)).clicked() && !chosen {
                actions.push(KeysEdit::SetTimeline(Timeline { frame_rate, ..timeline }));
            }
        }
    });
    let response = response.response;
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Frame rate"));
    response.on_hover_text("Set frames per second, for snapping and export");
}

fn ends(ui: &mut Ui, session: &Session, roomy: bool, actions: &mut Actions) {
    let timeline = session.document().timeline;
    let field = |name, value, tooltip| TimeField {
        name,
        label: name,
        value,
        unit: " s",
        speed: 0.02,
        width: 70.0,
        digits: 2,
        tooltip,
    };
    let is_editing = session.history().is_editing();
    let start = field("Start", timeline.start, "Set the start of the timeline");
    start.show(ui, roomy, is_editing, actions, |start| {
        KeysEdit::SetTimeline(Timeline { start, ..timeline })
    });
    let end = field("End", timeline.end, "Set the end of the timeline");
    end.show(ui, roomy, is_editing, actions, |end| {
        KeysEdit::SetTimeline(Timeline { end, ..timeline })
    });
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
