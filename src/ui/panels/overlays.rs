//! Check boxes of overlays.

use egui::{Checkbox, Ui};

use crate::document::Overlay;
use crate::session::{Actions, EditAction, Session};
use crate::ui::labels;

/// Shows check boxes of overlays in `count` columns. `disabled` is the reason why they are disabled;
/// `None` enables them.
pub(in crate::ui) fn check_boxes(
    ui: &mut Ui,
    session: &Session,
    count: usize,
    overlays: &[Overlay],
    disabled: Option<&str>,
    actions: &mut Actions,
) {
    ui.columns(count, |columns| {
        for (index, overlay) in overlays.iter().enumerate() {
            let (name, tooltip) = labels::overlay(session.rig(), *overlay);
            let mut shown = session.shown().display.shows(*overlay);
            let check_box = Checkbox::new(&mut shown, name);
            let check_box = columns[index % count].add_enabled(disabled.is_none(), check_box);
            let check_box = check_box.on_hover_text(tooltip);
            if check_box.on_disabled_hover_text(disabled.unwrap_or_default()).changed() {
                actions.push(EditAction::ShowOverlay(*overlay, shown));
            }
        }
    });
}
