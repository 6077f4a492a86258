//! The built-in examples as pictures, which play under the mouse.

use std::collections::HashMap;

use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Align2, Color32, ColorImage, CornerRadius, FontId, Id, Label, Layout, Rect, Response,
    Role, ScrollArea, Sense, Stroke, StrokeKind, TextureHandle, TextureOptions, Ui, UiBuilder,
    Vec2, WidgetInfo, pos2, vec2,
};
use image::{DynamicImage, ImageFormat, RgbImage};

use crate::document::Theme;
use crate::io::{Example, ExampleGroup};
use crate::session::{Actions, Dialog, FileAction, ShellAction};
use crate::ui::{style, widgets};

/// Least and greatest width of a picture in points, and its height as a part of that.
const WIDTHS: [f32; 2] = [192.0, 240.0];
const HEIGHT: f32 = 0.625;
/// Height of the title below a picture, and below that of the sentence about the picture.
const TITLE: f32 = 24.0;
const LINES: usize = 2;
const LINE: f32 = 17.0;
const SENTENCE: f32 = LINE * LINES as f32;
const GAP: f32 = 12.0;
/// Room for the bar of the area that scrolls.
const BAR: f32 = 12.0;
const MOST_COLUMNS: usize = 6;
const MOST_ROWS: f32 = 5.0;
/// Height of the window without the pictures.
const FRAME: f32 = 134.0;
/// Number of pictures that are decoded in one frame of the window: more would be felt.
const DECODED_AT_ONCE: usize = 2;

/// Shows the examples of a group.
pub(super) fn ui(ui: &mut Ui, group: ExampleGroup, actions: &mut Actions) {
    let window = ui.ctx().content_rect().size();
    let room = window.x - 80.0;
    let columns = ((room + GAP) / (WIDTHS[0] + GAP)).floor() as usize;
    let columns = columns.clamp(1, MOST_COLUMNS);
    let width = (room + GAP) / columns as f32 - GAP;
    let width = width.clamp(WIDTHS[0], WIDTHS[1]).floor();
    let picture = vec2(width, (HEIGHT * width).round());
    let pictures_width = columns as f32 * (width + GAP) - GAP;
    let examples: Vec<Example> = Example::of(group).collect();
    let row = picture.y + TITLE + SENTENCE + GAP;
    let most_rows = ((window.y - FRAME) / row).floor().clamp(1.0, MOST_ROWS) as usize;
    // The page keeps its size while the groups change.
    let groups = || ExampleGroup::ALL.into_iter();
    let largest = groups().map(|it| Example::of(it).count()).max().unwrap_or_default();
    let rows = largest.div_ceil(columns).min(most_rows);
    let height = row * rows as f32 - GAP;
    let bar = if examples.len().div_ceil(columns) > rows { BAR } else { 0.0 };
    ui.set_width(pictures_width + bar);
    let tabs: Vec<_> =
        groups().map(|it| (it, it.title(), "Show the examples of this group")).collect();
    let chosen = widgets::tabs(ui, group, &tabs);
    actions.extend(chosen.map(|it| ShellAction::OpenDialog(Dialog::Examples(it))));
    ui.add_space(3.0);
    let about = format!("{} Point at a picture to see it move, click to open it.", group.about());
    ui.add(Label::new(about).truncate());
    ui.add_space(6.0);
    let mut pictures = Pictures::kept(ui);
    pictures.decode_some(ui, &examples);
    let area = ScrollArea::vertical().id_salt(group.title());
    let area = area.max_height(height).min_scrolled_height(height);
    area.auto_shrink([false, false]).show(ui, |ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(GAP);
        for row in examples.chunks(columns) {
            ui.horizontal(|ui| {
                for example in row {
                    let card = card(ui, example, picture, &mut pictures);
                    if card.clicked() {
                        actions.push(ShellAction::CloseDialog);
                        actions.push(FileAction::OpenExample(*example));
                    }
                }
            });
        }
    });
    pictures.keep(ui);
}

/// Shows an example's picture and title, and plays the picture under the mouse.
fn card(ui: &mut Ui, example: &Example, size: Vec2, pictures: &mut Pictures) -> Response {
    let (rect, card) = ui.allocate_exact_size(size + vec2(0.0, TITLE + SENTENCE), Sense::click());
    card.widget_info(|| WidgetInfo::labeled(Role::Button, true, example.title));
    if !ui.is_rect_visible(rect) {
        return card;
    }
    let is_chosen = card.hovered() || card.has_focus();
    let picture = Rect::from_min_size(rect.min, size);
    let rounding = CornerRadius::same(6);
    let visuals = ui.visuals();
    let painter = ui.painter();
    painter.rect_filled(picture, rounding, visuals.extreme_bg_color);
    if let Some((texture, uv)) = pictures.shown(ui, example, is_chosen) {
        let shape = egui::epaint::RectShape::filled(picture, rounding, Color32::WHITE);
        painter.add(shape.with_texture(texture.id(), uv));
    }
    let edge = match is_chosen {
        true => Stroke::new(2.0, style::accent(ui)),
        false => visuals.widgets.noninteractive.bg_stroke,
    };
    painter.rect_stroke(picture, rounding, edge, StrokeKind::Inside);
    let colour = visuals.strong_text_color();
    let at = pos2(rect.left(), picture.bottom() + 0.5 * TITLE + 1.0);
    painter.text(at, Align2::LEFT_CENTER, example.title, FontId::proportional(15.5), colour);
    let below = rect.with_min_y(picture.bottom() + TITLE - 1.0);
    say(ui, below, example.sentence);
    card
}

/// Says what an example shows, in as many lines as there is room for.
fn say(ui: &mut Ui, rect: Rect, sentence: &str) {
    let colour = ui.visuals().text_color();
    let font = FontId::proportional(13.0);
    let format = TextFormat { line_height: Some(LINE), ..TextFormat::simple(font, colour) };
    let mut job = LayoutJob::single_section(sentence.to_owned(), format);
    job.wrap.max_width = rect.width();
    job.wrap.max_rows = LINES;
    let galley = ui.painter().layout_job(job);
    let builder = UiBuilder::new().max_rect(rect).layout(Layout::top_down(Align::Min));
    ui.new_child(builder).add(Label::new(galley).selectable(false));
}

/// The decoded pictures of the examples that are in view, by their names.
#[derive(Clone, Default)]
struct Pictures {
    /// The first frame of each.
    stills: HashMap<&'static str, TextureHandle>,
    /// The theme of these pictures.
    theme: Option<Theme>,
    /// All frames of the one that plays, and when it began.
    playing: Option<(&'static str, TextureHandle, f64)>,
}

fn kept_pictures() -> Id {
    Id::unique("pictures of examples")
}

/// Frees the memory of the pictures.
pub(super) fn forget_pictures(ui: &Ui) {
    ui.data_mut(|data| data.remove::<Pictures>(kept_pictures()));
}

impl Pictures {
    fn kept(ui: &Ui) -> Self {
        ui.data(|data| data.get_temp(kept_pictures())).unwrap_or_default()
    }

    fn keep(self, ui: &Ui) {
        ui.data_mut(|data| data.insert_temp(kept_pictures(), self));
    }

    /// Decodes the next pictures that are missing.
    fn decode_some(&mut self, ui: &Ui, examples: &[Example]) {
        let theme = style::palette(ui).theme;
        if self.theme != Some(theme) {
            *self = Self { theme: Some(theme), ..Self::default() };
        }
        let missing = examples.iter().filter(|it| !self.stills.contains_key(it.name));
        let missing: Vec<&Example> = missing.collect();
        for example in missing.iter().take(DECODED_AT_ONCE) {
            let [width, height] = Example::FRAME_SIZE.map(|pixels| pixels as u32);
            let frames = decoded(ui, example);
            let still = image::imageops::crop_imm(&frames, 0, 0, width, height).to_image();
            self.stills.insert(example.name, texture(ui, example, &still));
        }
        if missing.len() > DECODED_AT_ONCE {
            ui.ctx().request_repaint();
        }
    }

    /// The texture of an example, and the part of it that is shown now.
    fn shown(
        &mut self,
        ui: &Ui,
        example: &Example,
        is_played: bool,
    ) -> Option<(TextureHandle, Rect)> {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        if !is_played {
            self.playing.take_if(|(name, ..)| *name == example.name);
            return self.stills.get(example.name).map(|still| (still.clone(), whole));
        }
        let now = ui.input(|input| input.time);
        let is_new = self.playing.as_ref().is_none_or(|(name, ..)| *name != example.name);
        if is_new {
            let frames = texture(ui, example, &decoded(ui, example));
            self.playing = Some((example.name, frames, now));
        }
        let (_, frames, begun) = self.playing.as_ref()?;
        let [width, height] = frames.size();
        let (columns, rows) =
            ((width / Example::FRAME_SIZE[0]).max(1), (height / Example::FRAME_SIZE[1]).max(1));
        let frame = ((now - begun) * Example::FRAME_RATE) as usize % (columns * rows);
        let size = vec2(1.0 / columns as f32, 1.0 / rows as f32);
        let at = vec2((frame % columns) as f32, (frame / columns) as f32) * size;
        if columns * rows > 1 {
            ui.ctx().request_repaint_after_secs(1.0 / Example::FRAME_RATE as f32);
        }
        Some((frames.clone(), Rect::from_min_size(at.to_pos2(), size)))
    }
}

/// All frames of an example; black if they cannot be decoded.
fn decoded(ui: &Ui, example: &Example) -> RgbImage {
    let picture = example.picture(style::palette(ui).theme);
    let decoded = image::load_from_memory_with_format(picture, ImageFormat::Jpeg);
    decoded.map_or_else(|_| RgbImage::new(1, 1), DynamicImage::into_rgb8)
}

fn texture(ui: &Ui, example: &Example, picture: &RgbImage) -> TextureHandle {
    let size = [picture.width(), picture.height()].map(|pixels| pixels as usize);
    let image = ColorImage::from_rgb(size, picture.as_raw());
    ui.ctx().load_texture(example.name, image, TextureOptions::LINEAR)
}
