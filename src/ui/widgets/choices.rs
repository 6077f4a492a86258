//! Choices: tabs, a row of buttons of which one is chosen, a drop-down list with a label, and check
//! boxes.

use egui::{
    Align, Button, Checkbox, Color32, ComboBox, Layout, Rect, Response, RichText, Role, Stroke,
    TextStyle, Ui, WidgetInfo, vec2,
};

use crate::document::Overlay;
use crate::session::{Actions, DisplayEdit, Session};
use crate::ui::{labels, style, widgets};

/// A value that can be chosen, its name and its tooltip.
pub(in crate::ui) type Alternative<'a, T> = (T, &'a str, &'a str);

/// Shows a row of tabs, the chosen one underlined, and returns the value of one that was pressed
/// and is not `now`.
pub(in crate::ui) fn tabs<T: PartialEq + Copy>(
    ui: &mut Ui,
    now: T,
    tabs: &[Alternative<'_, T>],
) -> Option<T> {
    let mut pressed = None;
    let font = TextStyle::Button.resolve(ui.style());
    let width = |name: &str| {
        let colour = Color32::PLACEHOLDER;
        ui.painter().layout_no_wrap(name.to_owned(), font.clone(), colour).size().x
    };
    let names: f32 = tabs.iter().map(|(_, name, _)| width(name) + 2.0 * PADDING).sum();
    let gaps = tabs.len().saturating_sub(1).max(1) as f32;
    // Widths of tabs are whole points.
    let gap = ((ui.available_width() - names) / gaps - 1.0).floor().clamp(0.0, GAP);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(gap, 0.0);
        ui.spacing_mut().button_padding = vec2(PADDING, 5.0);
        for &(value, name, tooltip) in tabs {
            let is_now = value == now;
            let colour = if is_now {
                ui.visuals().strong_text_color()
            } else {
                ui.visuals().weak_text_color()
            };
            let text = RichText::new(name).color(colour);
            let tab = ui.add(Button::new(text).fill(Color32::TRANSPARENT));
            tab.widget_info(|| WidgetInfo::selected(Role::Tab, true, is_now, name));
            if is_now {
                underline(ui, tab.rect);
            }
            if tab.on_hover_text(tooltip).clicked() && !is_now {
                pressed = Some(value);
            }
        }
    });
    pressed
}

/// Space beside the name of a tab, in points: six tabs have room in a row of the page.
const PADDING: f32 = 2.75;
/// Greatest space between two tabs, in points.
const GAP: f32 = 16.0;

fn underline(ui: &Ui, tab: Rect) {
    let y = tab.bottom() - 1.0;
    ui.painter().hline(tab.x_range().shrink(PADDING), y, Stroke::new(2.0, style::accent(ui)));
}

/// Shows buttons, all as wide, and returns the value of one that was pressed and is not `now`.
pub(in crate::ui) fn segments<T: PartialEq + Copy>(
    ui: &mut Ui,
    now: T,
    choices: &[Alternative<'_, T>],
) -> Option<T> {
    let mut pressed = None;
    ui.columns(choices.len(), |columns| {
        for (column, &(value, name, tooltip)) in columns.iter_mut().zip(choices) {
            column.with_layout(Layout::top_down_justified(Align::Center), |ui| {
                let is_now = value == now;
                if segment(ui, is_now, name, tooltip).clicked() && !is_now {
                    pressed = Some(value);
                }
            });
        }
    });
    pressed
}

/// Shows a button with a frame that stands out while it is chosen.
pub(in crate::ui) fn segment(ui: &mut Ui, is_now: bool, name: &str, tooltip: &str) -> Response {
    ui.add(Button::selectable(is_now, name).frame_when_inactive(true)).on_hover_text(tooltip)
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
    /// Width in points at most: enough for most texts, so that lists below each other are aligned.
    const WIDTH: f32 = 168.0;

    /// Shows the list; `items` adds its items while it is open.
    pub fn show(&self, ui: &mut Ui, items: impl FnOnce(&mut ChoiceList<'_>)) {
        widgets::pair(ui, self.label, |ui| {
            let combo = ComboBox::from_id_salt(self.name)
                .selected_text(self.shown)
                .width(ui.available_width().min(Self::WIDTH))
                .truncate();
            let response = combo.show_ui(ui, |ui| items(&mut ChoiceList(ui))).response;
            name(ui, &response, self.name);
            response.on_hover_text(self.tooltip);
        });
    }

    /// Shows the list of `alternatives`, and returns the value of one that was chosen. `is_now` is
    /// true for the present choice, whose name replaces [`Self::shown`].
    pub fn pick<T: Copy>(
        self,
        ui: &mut Ui,
        alternatives: &[Alternative<'_, T>],
        is_now: impl Fn(&T) -> bool,
    ) -> Option<T> {
        let now = alternatives.iter().find(|(value, ..)| is_now(value));
        let mut chosen = None;
        Choice { shown: now.map_or("", |now| now.1), ..self }.show(ui, |list| {
            for (value, name, tooltip) in alternatives {
                if list.item(is_now(value), name, tooltip, None) {
                    chosen = Some(*value);
                }
            }
        });
        chosen
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
        let item = self.0.add_enabled(disabled.is_none(), Button::selectable(is_now, name));
        explained(item, tooltip, disabled).clicked() && !is_now
    }
}

/// Gives a widget a name for screen readers that differs from its visible text.
pub(in crate::ui) fn name(ui: &Ui, widget: &Response, name: &str) {
    ui.ctx().accesskit_node_builder(widget.id, |node| node.set_label(name));
}

/// Gives a widget a tooltip, unless it is empty, and the reason why it is disabled, if it is.
pub(in crate::ui) fn explained(
    widget: Response,
    tooltip: &str,
    disabled: Option<&str>,
) -> Response {
    let told = if tooltip.is_empty() { widget } else { widget.on_hover_text(tooltip) };
    match disabled {
        Some(reason) => told.on_disabled_hover_text(reason),
        None => told,
    }
}

/// Shows an item of a menu, and returns whether it was pressed. `keys` is its shortcut; it and the
/// tooltip may be empty. `disabled` is the reason why it is disabled; `None` enables it.
pub(in crate::ui) fn menu_item(
    ui: &mut Ui,
    name: &str,
    keys: &str,
    tooltip: &str,
    disabled: Option<&str>,
) -> bool {
    let button = Button::new(name);
    let button = if keys.is_empty() { button } else { button.shortcut_text(keys) };
    explained(ui.add_enabled(disabled.is_none(), button), tooltip, disabled).clicked()
}

/// Shows a check box, and returns its state if the user changed it. An empty `tooltip` shows none.
/// `disabled` is the reason why it is disabled; `None` enables it.
pub(in crate::ui) fn check_box(
    ui: &mut Ui,
    name: &str,
    tooltip: &str,
    mut is_on: bool,
    disabled: Option<&str>,
) -> Option<bool> {
    let check_box = ui.add_enabled(disabled.is_none(), Checkbox::new(&mut is_on, name));
    explained(check_box, tooltip, disabled).changed().then_some(is_on)
}

/// Shows the check box of an overlay.
pub(in crate::ui) fn overlay_check_box(
    ui: &mut Ui,
    session: &Session,
    overlay: Overlay,
    name: &str,
    tooltip: &str,
    disabled: Option<&str>,
    actions: &mut Actions,
) {
    let is_shown = session.shown().display.shows(overlay);
    let changed = check_box(ui, name, tooltip, is_shown, disabled);
    actions.extend(changed.map(|is_shown| DisplayEdit::ShowOverlay(overlay, is_shown)));
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
            let (name, tooltip) = labels::overlay(*overlay);
            let column = &mut columns[index % count];
            overlay_check_box(column, session, *overlay, name, tooltip, disabled, actions);
        }
    });
}
