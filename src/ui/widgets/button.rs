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

/// Shows the button that most users press, in the accent colour. `disabled` is the reason why it is
/// disabled, shown as its tooltip; `None` enables it.
pub(in crate::ui) fn primary_button(ui: &mut Ui, name: &str, disabled: Option<&str>) -> Response {
    let Some(why) = disabled else {
        let text = RichText::new(name).color(ui.visuals().panel_fill).strong();
        return ui.add(Button::new(text).fill(style::accent(ui)));
    };
    ui.add_enabled(false, Button::new(name)).on_disabled_hover_text(why)
}
