//! A button that can be disabled.

use egui::{Ui, WidgetText};

/// Shows a button and returns whether it was pressed. `disabled` is the reason why the button is
/// disabled, shown as its tooltip; `None` enables the button.
pub(in crate::ui) fn button(
    ui: &mut Ui,
    name: impl Into<WidgetText>,
    tooltip: &str,
    disabled: Option<&str>,
) -> bool {
    let button = ui.add_enabled(disabled.is_none(), egui::Button::new(name.into()));
    let button = button.on_hover_text(tooltip);
    match disabled {
        Some(why) => button.on_disabled_hover_text(why).clicked(),
        None => button.clicked(),
    }
}
