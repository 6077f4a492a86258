//! Choices: tabs, a row of buttons of which one is chosen, a labelled drop-down list, and check
//! boxes of overlays.

use egui::{
    Align, Button, Checkbox, Color32, ComboBox, Layout, Rect, RichText, Role, Stroke, Ui,
    WidgetInfo, vec2,
};

use crate::document::Overlay;
use crate::session::{Actions, DisplayEdit, Session};
use crate::ui::{labels, style, widgets};

/// A tab that can be chosen.
pub(in crate::ui) struct Tab<'a, T> {
    pub name: &'a str,
    pub tooltip: &'a str,
    pub value: T,
}

/// Shows a row of tabs, the chosen one underlined, and returns the value of one that was pressed
/// and is not `now`.
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
            let colour = if is_now {
                ui.visuals().strong_text_color()
            } else {
                ui.visuals().weak_text_color()
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

/// One of the buttons.
pub(in crate::ui) struct Segment<'a, T> {
    pub name: &'a str,
    pub tooltip: &'a str,
    pub value: T,
}

/// Shows the buttons, all as wide, and returns the value of one that was pressed and is not `now`.
pub(in crate::ui) fn segments<T: PartialEq + Copy>(
    ui: &mut Ui,
    now: T,
    choices: &[Segment<'_, T>],
) -> Option<T> {
    let mut pressed = None;
    ui.columns(choices.len(), |columns| {
        for (column, Segment { name, tooltip, value }) in columns.iter_mut().zip(choices) {
            let is_now = *value == now;
            column.with_layout(Layout::top_down_justified(Align::Center), |ui| {
                let button = ui.add(Button::selectable(is_now, *name).frame_when_inactive(true));
                if button.on_hover_text(*tooltip).clicked() && !is_now {
                    pressed = Some(*value);
                }
            });
        }
    });
    pressed
}

/// A drop-down list with a label on its left.
pub(in crate::ui) struct Choice<'a> {
    pub label: &'a str,
    /// Accessible name.
    pub name: &'a str,
    pub tooltip: &'a str,
    /// Text of the present choice.
    pub shown: &'a str,
}

/// The items of an open list.
pub(in crate::ui) struct ChoiceList<'a>(&'a mut Ui);

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
    /// Shows an item and returns whether the user chose it and it was not the present choice. An
    /// empty `tooltip` shows none. `disabled` is the reason why the item cannot be chosen.
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

/// Shows check boxes of overlays in `count` columns. `disabled` is the reason why they are
/// disabled; `None` enables them.
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
                actions.push(DisplayEdit::ShowOverlay(*overlay, shown));
            }
        }
    });
}
