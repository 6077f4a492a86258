//! What the side panels are made of.

use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, CollapsingHeader, FontId, InnerResponse, Label, Layout, Rect, Response, Ui, UiBuilder,
    WidgetText,
};

use super::number::Number;
use super::slider;
use crate::session::{Action, Session};

/// Three of them stand beside a name in the narrowest panel.
const FIELD_WIDTH: f32 = 52.0;

/// Below a section.
const SPACE: f32 = 1.0;

/// A section that can be folded; whether it is, survives a restart.
pub(super) fn section(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    named_section(ui, title, title, contents);
}

/// A section with something of its own at the right of its title.
pub(super) fn section_with(
    ui: &mut Ui,
    title: &str,
    aside: impl FnOnce(&mut Ui),
    contents: impl FnOnce(&mut Ui),
) {
    let header = show_section(ui, title, title, true, contents);
    let row = Rect::from_x_y_ranges(ui.max_rect().x_range(), header.y_range());
    let right = Layout::right_to_left(Align::Center);
    // Beside what is there: it takes no room.
    aside(&mut ui.new_child(UiBuilder::new().max_rect(row).layout(right)));
}

/// A section that is folded at first.
pub(super) fn folded_section(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    show_section(ui, title, title, false, contents);
}

/// A section whose title changes; `id` says which it is.
pub(super) fn named_section(ui: &mut Ui, id: &str, title: &str, contents: impl FnOnce(&mut Ui)) {
    show_section(ui, id, title, true, contents);
}

/// Gives where the title is.
fn show_section(
    ui: &mut Ui,
    id: &str,
    title: &str,
    open: bool,
    contents: impl FnOnce(&mut Ui),
) -> Rect {
    let heading = cut(ui, title);
    let header = CollapsingHeader::new(heading).id_salt(id).default_open(open);
    let shown = header.show_unindented(ui, contents);
    ui.add_space(SPACE);
    shown.header_response.rect
}

/// A title in one line no wider than the panel, whatever a joint is called: a header would make the
/// panel as wide as its title.
fn cut(ui: &Ui, title: &str) -> WidgetText {
    let colour = ui.visuals().strong_text_color();
    let font = FontId::proportional(13.5);
    let width = ui.available_width() - ui.spacing().indent - 12.0;
    let mut job = LayoutJob::simple_singleline(title.to_owned(), font, colour);
    job.wrap = TextWrapping::truncate_at_width(width.max(24.0));
    ui.fonts_mut(|fonts| fonts.layout_job(job)).into()
}

/// A number that is dragged or typed, without a rail.
pub(super) struct Field<'a> {
    /// What it is called where there is nothing else to see: "Bone x".
    pub name: &'a str,
    pub value: f32,
    pub unit: &'a str,
    /// What a point of the pointer's way adds.
    pub step: f32,
    /// Behind the point.
    pub digits: usize,
    pub tooltip: &'a str,
}

impl Field<'_> {
    pub fn show(
        self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Vec<Action>,
        set: impl Fn(f32) -> Action,
    ) -> Response {
        let digits = self.digits;
        let format = |value| slider::format(value, digits);
        self.show_as(ui, session, actions, &format, set)
    }

    /// Shows it in letters of its own.
    pub fn show_as(
        self,
        ui: &mut Ui,
        session: &Session,
        actions: &mut Vec<Action>,
        format: &dyn Fn(f64) -> String,
        set: impl Fn(f32) -> Action,
    ) -> Response {
        let Self { name, value, unit, .. } = self;
        let number = Number { name, value, unit, speed: self.step, width: FIELD_WIDTH, format };
        let response = number.show(ui, session.is_editing(), actions, set);
        response.on_hover_text(self.tooltip)
    }
}

/// A name on the left and what belongs to it on the right.
pub(super) fn pair<T>(
    ui: &mut Ui,
    name: &str,
    contents: impl FnOnce(&mut Ui) -> T,
) -> InnerResponse<T> {
    ui.horizontal(|ui| {
        ui.add(Label::new(name).selectable(false));
        ui.with_layout(Layout::right_to_left(Align::Center), contents).inner
    })
}

/// A button that tells why it cannot be pressed, if it cannot.
pub(super) fn button(
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
