//! A button that can be disabled, and one that stands out.

use egui::{Button, Response, RichText, Ui, WidgetText};

use crate::ui::style;

/// Shows a button and returns whether it was pressed. `disabled` is the reason why the button is
/// disabled, shown as its tooltip; `None` enables the button.
pub(in crate::ui) fn button(
    ui: &mut Ui,
    name: impl Into<WidgetText>,
    tooltip: &str,
    disabled: Option<&str>,
) -> bool {
    let button = ui.add_enabled(disabled.is_none(), Button::new(name.into()));
    let button = button.on_hover_text(tooltip);
    match disabled {
        Some(why) => button.on_disabled_hover_text(why).clicked(),
        None => button.clicked(),
    }
}

/// Shows the button that most users press, in the accent colour.
pub(in crate::ui) fn primary_button(ui: &mut Ui, name: &str) -> Response {
    let text = RichText::new(name).color(ui.visuals().panel_fill).strong();
    ui.add(Button::new(text).fill(style::accent(ui)))
}
