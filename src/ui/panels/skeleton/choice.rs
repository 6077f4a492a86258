//! A labelled drop-down list.

use egui::{Button, ComboBox, Ui};

use crate::ui::widgets;

/// A drop-down list with a label on its left.
pub(super) struct Choice<'a> {
    pub label: &'a str,
    /// Accessible name.
    pub name: &'a str,
    pub tooltip: &'a str,
    /// Text of the present choice.
    pub shown: &'a str,
}

/// The items of an open list.
pub(super) struct ChoiceList<'a>(&'a mut Ui);

impl Choice<'_> {
    /// Shows the list; `items` adds its items while it is open.
    pub fn show(&self, ui: &mut Ui, items: impl FnOnce(&mut ChoiceList<'_>)) {
        widgets::pair(ui, self.label, |ui| {
            let combo = ComboBox::from_id_salt(self.name)
                .selected_text(self.shown)
                .width(ui.available_width().min(150.0))
                .truncate();
            let response = combo.show_ui(ui, |ui| items(&mut ChoiceList(ui))).response;
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(self.name));
            response.on_hover_text(self.tooltip);
        });
    }
}

impl ChoiceList<'_> {
    /// Shows an item and returns whether the user chose it and it was not the present choice. An empty
    /// `tooltip` shows none. `disabled` is the reason why the item cannot be chosen.
    pub fn item(
        &mut self,
        is_now: bool,
        name: &str,
        tooltip: &str,
        disabled: Option<&str>,
    ) -> bool {
        let button = Button::selectable(is_now, name);
        let response = self.0.add_enabled(disabled.is_none(), button);
        let response = if tooltip.is_empty() { response } else { response.on_hover_text(tooltip) };
        let response = match disabled {
            Some(reason) => response.on_disabled_hover_text(reason),
            None => response,
        };
        response.clicked() && !is_now
    }
}
