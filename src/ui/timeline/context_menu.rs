//! Context menus of the timeline.

use egui::{Button, Id, Response, Ui};

use super::dope_sheet::mouse::DopeSheetView;
use super::drag;
use super::rows::DopeSheetRow;
use crate::document::Channel;
use crate::kinematics::spline::Interpolation;
use crate::session::{Actions, KeysEdit, PlaybackAction, SelectAction, Session};
use crate::ui::{labels, widgets};

/// Row, and time in seconds, of the right click; the row is `None` below the last row.
#[derive(Clone, Copy)]
struct MenuTarget {
    row: Option<DopeSheetRow>,
    time: f64,
}

/// Shows the context menu of the dope sheet.
pub(in crate::ui) fn of_rows(
    ui: &Ui,
    sheet: &DopeSheetView<'_>,
    body: &Response,
    actions: &mut Actions,
) {
    let id = Id::unique("timeline menu target");
    let session = sheet.session;
    if body.secondary_clicked()
        && let Some(at) = ui.input(|input| input.pointer.interact_pos())
    {
        let time = drag::pointed_time(ui, session, sheet.scale, at);
        ui.data_mut(|data| data.insert_temp(id, MenuTarget { row: sheet.row(at), time }));
    }
    let Some(MenuTarget { row, time }) = ui.data(|data| data.get_temp(id)) else {
        return;
    };
    body.context_menu(|ui| {
        if let Some(row) = row
            && widgets::button(ui, "Add key here", "Add keys at this time", None)
        {
            actions.push(PlaybackAction::SetTime(time));
            actions.push(KeysEdit::Key(row.channels(session)));
            ui.close();
        }
        of_keys(ui, session, actions);
        let nothing = (!session.selection().can_paste()).then_some("Copy keys first");
        if widgets::button(ui, "Paste here", "Paste the copied keys from this time on", nothing) {
            actions.push(PlaybackAction::SetTime(time));
            actions.push(KeysEdit::PasteKeys);
            ui.close();
        }
        if let Some(DopeSheetRow::Channel { channel, .. }) = row {
            clear(ui, session, channel, actions);
        }
    });
}

/// Shows the context menu of a channel's name.
pub(in crate::ui) fn of_channel(
    response: &Response,
    session: &Session,
    channel: Channel,
    actions: &mut Actions,
) {
    response.context_menu(|ui| {
        if widgets::button(ui, "Add key", "Add a key at the playhead", None) {
            actions.push(KeysEdit::Key(vec![channel]));
            ui.close();
        }
        clear(ui, session, channel, actions);
    });
}

/// Shows the context menu of the graph editor.
pub(in crate::ui) fn of_curves(area: &Response, session: &Session, actions: &mut Actions) {
    area.context_menu(|ui| of_keys(ui, session, actions));
}

/// The reason why items that act on the selected keys are disabled; `None` if there are any.
fn none_selected(session: &Session) -> Option<&'static str> {
    session.selection().keys().is_empty().then_some("Select keys first: click or draw a box")
}

/// Shows the items that choose the curve after the selected keys and their tangents.
fn shape(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let keys = session.selection().keys();
    let document = session.document();
    let chosen = |interpolation| {
        let mut all = keys.iter().filter_map(|(channel, time)| document.keys.key(*channel, *time));
        !keys.is_empty() && all.all(|key| key.interpolation == interpolation)
    };
    let has_others = keys.iter().any(|(channel, _)| !channel.is_rotation());
    let no_angles = has_others.then_some("Only angles of joints turn the shortest way");
    let are_switches = keys.iter().all(|(channel, _)| channel.is_switch());
    let switches = are_switches.then_some("Switches keep their value until the next key");
    let none = none_selected(session).or(switches);
    for (interpolation, tooltip) in [
        (Interpolation::Auto, "Follow a smooth curve that stays between the two keys"),
        (Interpolation::Smooth, "Follow a smooth curve that may swing beyond the keys"),
        (Interpolation::Linear, "Follow a straight line to the next key"),
        (Interpolation::Step, "Keep the value until the next key"),
        (Interpolation::Slerp, "Turn the shortest way to the next key, at constant speed"),
    ] {
        let button = Button::selectable(chosen(interpolation), interpolation.title());
        let why_not = none.or(no_angles.filter(|_| interpolation == Interpolation::Slerp));
        let item = ui.add_enabled(why_not.is_none(), button);
        if widgets::explained(item, tooltip, why_not).clicked() {
            actions.push(KeysEdit::SetInterpolation(keys.to_vec(), interpolation));
            ui.close();
        }
    }
    let tooltip = "Let the neighbouring keys set the slopes again";
    if widgets::button(ui, "Automatic tangents", tooltip, none) {
        actions.push(KeysEdit::SetSlopes(keys.to_vec(), None));
        ui.close();
    }
    ui.separator();
}

fn of_keys(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    shape(ui, session, actions);
    let keys = session.selection().keys();
    let none = none_selected(session);
    if widgets::button(ui, "Copy keys", "Copy the selected keys (Ctrl+C)", none) {
        actions.push(SelectAction::CopyKeys);
        ui.close();
    }
    if widgets::button(ui, "Delete keys", "Delete the selected keys (Delete)", none) {
        actions.push(KeysEdit::DeleteKeys(keys.to_vec()));
        ui.close();
    }
}

fn clear(ui: &mut Ui, session: &Session, channel: Channel, actions: &mut Actions) {
    let name = labels::channel(session, channel);
    let tooltip = format!("Delete all keys of {name}");
    if widgets::button(ui, "Delete all keys of channel", &tooltip, None) {
        actions.push(KeysEdit::ClearChannels(vec![channel]));
        ui.close();
    }
}
