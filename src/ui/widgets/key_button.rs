//! A button with a diamond that keys a value.

use egui::{Color32, Response, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

use super::icon_button::diamond;
use crate::document::Channel;
use crate::session::{Actions, EditAction, Session};
use crate::ui::style;

/// Distance in points from the centre of the diamond to a corner.
const SIZE: f32 = 4.5;

/// A diamond that adds a key of a channel at the playhead, or deletes the key that is there. It is
/// filled at a key, and has the accent colour there and while the channel has an unkeyed change.
pub(in crate::ui) struct KeyButton {
    pub channel: Channel,
    /// Channels that get keys together with `channel`.
    pub others: Vec<Channel>,
}

impl KeyButton {
    /// Width in points of the button.
    pub const WIDTH: f32 = 16.0;

    /// Shows the button, named after the value that it keys.
    pub fn show(self, ui: &mut Ui, session: &Session, name: &str, actions: &mut Actions) {
        let (channel, time) = (self.channel, session.time());
        let track = session.document().keys.track(channel);
        let is_at_key = track.is_some_and(|track| track.get(time).is_some());
        let response = self.button(ui, session, name, is_at_key, track.is_some());
        if response.clicked() {
            actions.push(match is_at_key {
                true => EditAction::DeleteKeys(vec![(channel, time)]),
                false => EditAction::Key([vec![channel], self.others].concat()),
            });
        }
        response.on_hover_text(match is_at_key {
            true => "Delete the key at the playhead",
            false => "Add a key at the playhead",
        });
    }

    fn button(
        &self,
        ui: &mut Ui,
        session: &Session,
        name: &str,
        is_at_key: bool,
        is_keyed: bool,
    ) -> Response {
        let (rect, response) = ui.allocate_exact_size(vec2(Self::WIDTH, 18.0), Sense::click());
        let name = format!("Key {name}");
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_at_key, &name));
        let is_changed = session.is_overridden(self.channel);
        let stands_out = response.hovered() || response.has_focus();
        let visuals = ui.visuals();
        let colour = match (is_at_key || is_changed, is_keyed || stands_out) {
            (true, _) => style::accent(ui),
            (false, true) => visuals.text_color(),
            (false, false) => visuals.weak_text_color(),
        };
        let fill = if is_at_key { colour } else { Color32::TRANSPARENT };
        let size = if stands_out { SIZE + 1.0 } else { SIZE };
        ui.painter().add(diamond(rect.center(), size, fill, Stroke::new(1.2, colour)));
        response
    }
}
