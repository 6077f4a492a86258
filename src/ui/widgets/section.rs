//! Foldable sections and labelled rows of the side panels.

use egui::collapsing_header::CollapsingState;
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, CollapsingHeader, FontId, Id, InnerResponse, Label, Layout, Rect, Response, RichText,
    Ui, UiBuilder, WidgetText, vec2,
};

use crate::session::Actions;
use crate::ui::glossary;

/// Unfolds a section in the next frame, and scrolls to it. `path` is its id, after those of the sections
/// that it is in, divided by `/`.
pub(in crate::ui) fn open_section(ui: &Ui, path: Option<&str>) {
    ui.data_mut(|data| data.insert_temp(section_to_open(), path.map(ToOwned::to_owned)));
}

/// Folds the sections that [`open_section`] has unfolded since the last call.
pub(in crate::ui) fn fold_opened_sections(ui: &Ui) {
    let opened: Option<Vec<Id>> = ui.data_mut(|data| data.remove_temp(opened_sections()));
    for mut section in opened.iter().flatten().filter_map(|id| CollapsingState::load(ui, *id)) {
        section.set_open(false);
        section.store(ui);
    }
}

/// Where the title rows of unfolded sections are noted, for [`whole_rows`].
fn open_headers() -> Id {
    Id::unique("title rows of open sections")
}

/// Where the sections are noted that were folded before [`open_section`].
fn opened_sections() -> Id {
    Id::unique("sections to fold again")
}

fn section_to_open() -> Id {
    Id::unique("section to open")
}

/// Shows a foldable section, open at first. Whether it is folded is kept across restarts.
pub(in crate::ui) fn section(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    named_section(ui, title, title, contents);
}

/// Shows a section with the widgets of `aside` over its title row.
pub(in crate::ui) fn section_with(
    ui: &mut Ui,
    title: &str,
    aside: impl FnOnce(&mut Ui),
    contents: impl FnOnce(&mut Ui),
) {
    named_section_with(ui, title, title, true, aside, contents);
}

/// Shows a section, folded at first unless `open`, that is identified by `id`, with the widgets of
/// `aside` over its title row.
pub(in crate::ui) fn named_section_with(
    ui: &mut Ui,
    id: &str,
    title: &str,
    open: bool,
    aside: impl FnOnce(&mut Ui),
    contents: impl FnOnce(&mut Ui),
) {
    let (whole, clip, top) = (ui.max_rect().x_range(), ui.clip_rect(), ui.cursor().top());
    let mut aside = Some(aside);
    let mut show_aside = |ui: &mut Ui, bottom: f32| {
        let rect = Rect::from_x_y_ranges(whole, top..=bottom);
        let builder = UiBuilder::new().max_rect(rect).layout(Layout::left_to_right(Align::Center));
        let mut row = ui.new_child(builder);
        row.set_clip_rect(clip);
        if let Some(aside) = aside.take() {
            aside(&mut row);
        }
    };
    let header = show_section(ui, id, title, open, |ui| {
        // Tab comes to the title row before it comes to the contents.
        show_aside(ui, ui.max_rect().top() - ui.spacing().item_spacing.y);
        contents(ui);
    });
    show_aside(ui, header.bottom());
}

/// Shows a section that is folded at first.
pub(in crate::ui) fn folded_section(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    show_section(ui, title, title, false, contents);
}

/// Shows a section that is folded at first and identified by `id`, because another section has its
/// title.
pub(in crate::ui) fn named_folded_section(
    ui: &mut Ui,
    id: &str,
    title: &str,
    contents: impl FnOnce(&mut Ui),
) {
    show_section(ui, id, title, false, contents);
}

/// Shows a section that is identified by `id`, because its title changes.
pub(in crate::ui) fn named_section(
    ui: &mut Ui,
    id: &str,
    title: &str,
    contents: impl FnOnce(&mut Ui),
) {
    show_section(ui, id, title, true, contents);
}

/// Shows a section, folded at first unless `open`, and returns the rectangle of its title.
fn show_section(
    ui: &mut Ui,
    id: &str,
    title: &str,
    open: bool,
    contents: impl FnOnce(&mut Ui),
) -> Rect {
    let heading = cut(ui, title);
    let path: Option<String> = ui.data(|data| data.get_temp(section_to_open())).flatten();
    let mut ids = path.iter().flat_map(|path| path.split('/'));
    let is_asked = ids.clone().any(|it| it == id);
    let is_innermost = ids.next_back() == Some(id);
    let section = CollapsingHeader::new(heading).id_salt(id).default_open(open);
    let shown = section.open(is_asked.then_some(true)).show_unindented(ui, contents);
    let header = &shown.header_response;
    if shown.body_returned.is_some() {
        ui.data_mut(|data| {
            data.get_temp_mut_or_default::<Vec<Rect>>(open_headers()).push(header.rect);
        });
    }
    if is_asked && header.changed() {
        ui.data_mut(|data| {
            data.get_temp_mut_or_default::<Vec<Id>>(opened_sections()).push(header.id);
        });
    }
    if is_innermost {
        let end = shown.body_returned.map_or(header.rect, |()| ui.min_rect());
        ui.scroll_to_rect(header.rect.union(end), None);
    }
    header.rect
}

/// The title, truncated to the width of the panel: egui would widen the panel for a longer title.
fn cut(ui: &Ui, title: &str) -> WidgetText {
    let colour = ui.visuals().strong_text_color();
    let font = FontId::proportional(13.5);
    let width = ui.available_width() - ui.spacing().indent - 12.0;
    let mut job = LayoutJob::simple_singleline(title.to_owned(), font, colour);
    job.wrap = TextWrapping::truncate_at_width(width.max(24.0));
    ui.fonts_mut(|fonts| fonts.layout_job(job)).into()
}

/// Shows the contents of a scrolled area without the row that its lower edge cuts. Larger things, such
/// as drawings, are hidden while only a sliver of them is seen.
pub(in crate::ui) fn whole_rows<T>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> T) -> T {
    /// Greatest height of a row, in points.
    const ROW: f32 = 30.0;
    /// Height of a larger thing, in points, up to which it is hidden.
    const SLIVER: f32 = 60.0;
    let id = ui.scope_id().with("cut row");
    let before: f32 = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let clip = ui.clip_rect();
    ui.set_clip_rect(clip.with_max_y(clip.bottom() - before));
    ui.data_mut(|data| data.remove::<Vec<Rect>>(open_headers()));
    let shown = contents(ui);
    let layer = ui.layer_id();
    let cut = ui.ctx().viewport(|viewport| {
        let rects = || viewport.this_pass.widgets.get_layer(layer).map(|widget| widget.rect);
        let most = |rect: &Rect| if rect.height() > 2.0 * SLIVER { SLIVER } else { ROW };
        let is_cut = |rect: &Rect| {
            clip.x_range().contains(rect.center().x)
                && (clip.bottom() - most(rect)..clip.bottom()).contains(&rect.top())
                && rect.bottom() > clip.bottom() + 1.0
        };
        // What holds a whole row is no row; an empty place is nothing.
        let is_whole = |it: &Rect| it.is_positive() && it.bottom() <= clip.bottom();
        let is_row = |rect: &Rect| !rects().any(|it| is_whole(&it) && rect.contains_rect(it));
        let tops = rects().filter(is_cut).filter(is_row).map(|rect| clip.bottom() - rect.top());
        tops.fold(0.0, f32::max)
    });
    // Nor a title without the first row below it.
    let end = clip.bottom() - cut;
    let headers: Vec<Rect> = ui.data(|data| data.get_temp(open_headers())).unwrap_or_default();
    let is_last = |header: &&Rect| (end - ROW / 2.0..end + 1.0).contains(&header.bottom());
    let cut = headers.iter().find(is_last).map_or(cut, |header| clip.bottom() - header.top());
    if cut != before {
        ui.data_mut(|data| data.insert_temp(id, cut));
        ui.request_repaint();
    }
    shown
}

/// Lays out `contents` from left to right, so that they end at the right edge.
///
/// A layout from right to left would add the last widget first, and Tab would go backwards.
pub(in crate::ui) fn at_right<T>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> T) -> T {
    let id = ui.next_auto_id().with("width");
    let before: f32 = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let height = ui.spacing().interact_size.y;
    let (_, mut rect) = ui.allocate_space(vec2(ui.available_width(), height));
    rect.min.x = rect.left().max(rect.right() - before);
    let forwards = Layout::left_to_right(Align::Center);
    let mut inside = ui.new_child(UiBuilder::new().max_rect(rect).layout(forwards));
    let shown = contents(&mut inside);
    let width = inside.min_rect().width();
    if width != before {
        ui.data_mut(|data| data.insert_temp(id, width));
        ui.request_discard("the width of a row has changed");
    }
    shown
}

/// Shows a row with a name on the left and the widget of `contents` on the right.
pub(in crate::ui) fn pair<T>(
    ui: &mut Ui,
    name: &str,
    contents: impl FnOnce(&mut Ui) -> T,
) -> InnerResponse<T> {
    ui.horizontal(|ui| {
        ui.add(Label::new(name).selectable(false));
        ui.with_layout(Layout::right_to_left(Align::Center), contents).inner
    })
}

/// Shows the value of a quantity, in digits of one width, at the right end of a row or a cell.
pub(in crate::ui) fn value(ui: &mut Ui, text: impl Into<String>) -> Response {
    let right = Layout::right_to_left(Align::Center);
    ui.with_layout(right, |ui| ui.label(RichText::new(text).monospace())).inner
}

/// Shows a row like [`pair`], whose name is a term of the glossary.
pub(in crate::ui) fn term_pair<T>(
    ui: &mut Ui,
    name: &str,
    term: &str,
    actions: &mut Actions,
    contents: impl FnOnce(&mut Ui, &mut Actions) -> T,
) -> InnerResponse<T> {
    ui.horizontal(|ui| {
        glossary::term_label(ui, name, term, actions);
        let right = Layout::right_to_left(Align::Center);
        ui.with_layout(right, |ui| contents(ui, actions)).inner
    })
}
