//! A row of tabs.

use egui::{Button, Color32, Rect, RichText, Role, Stroke, Ui, WidgetInfo, vec2};

use crate::ui::style;

/// A tab that can be chosen.
pub(in crate::ui) struct Tab<'a, T> {
    pub name: &'a str,
    pub tooltip: &'a str,
    pub value: T,
}

/// Shows a row of tabs, the chosen one underlined, and returns the value of one that was pressed and is
/// not `now`.
pub(in crate::ui) fn tabs<T: PartialEq + Copy>(
    ui: &mut Ui,
    now: T,
    tabs: &[Tab<'_, T>],
) -> Option<T> {
    let mut pressed = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().button_padding = vec2(6.0, 5.0);
        for Tab { name, tooltip, value } in tabs {
            let is_now = *value == now;
            let colour = match is_now {
                true => ui.visuals().strong_text_color(),
                false => ui.visuals().weak_text_color(),
            };
            let text = RichText::new(*name).color(colour);
            let tab = ui.add(Button::new(text).fill(Color32::TRANSPARENT));
            tab.widget_info(|| WidgetInfo::selected(Role::Tab, true, is_now, name));
            if is_now {
                underline(ui, tab.rect);
            }
            if tab.on_hover_text(*tooltip).clicked() && !is_now {
                pressed = Some(*value);
            }
        }
    });
    pressed
}

fn underline(ui: &Ui, tab: Rect) {
    let y = tab.bottom() - 1.0;
    ui.painter().hline(tab.x_range().shrink(6.0), y, Stroke::new(2.0, style::accent(ui)));
}
