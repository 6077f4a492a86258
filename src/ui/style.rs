//! Colours, spacing and fonts of the panels. The accent colour is that of the scene's palette.

use egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Shadow, Stroke, TextStyle, Visuals, vec2,
};

use crate::document::Theme;
use crate::render::system_fonts;
use crate::scene::{Colour, Palette};

/// Colours that the panels have in addition to the scene's palette.
#[derive(Clone, Copy, Debug)]
struct PanelColours {
    panel: Color32,
    field: Color32,
    button: Color32,
    hovered: Color32,
    line: Color32,
    text: Color32,
    weak: Color32,
    strong: Color32,
    error: Color32,
}

impl PanelColours {
    fn new(theme: Theme) -> Self {
        let grey = Color32::from_rgb;
        match theme {
            Theme::Dark => Self {
                panel: grey(0x20, 0x24, 0x2b),
                field: grey(0x15, 0x18, 0x1d),
                button: grey(0x31, 0x37, 0x41),
                hovered: grey(0x40, 0x48, 0x55),
                line: grey(0x36, 0x3c, 0x46),
                text: grey(0xd8, 0xdd, 0xe4),
                weak: grey(0x9d, 0xa6, 0xb3),
                strong: grey(0xf5, 0xf7, 0xfa),
                error: grey(0xff, 0x8a, 0x80),
            },
            Theme::Light => Self {
                panel: grey(0xf5, 0xf7, 0xf9),
                field: grey(0xff, 0xff, 0xff),
                button: grey(0xe1, 0xe6, 0xec),
                hovered: grey(0xd0, 0xd7, 0xe0),
                line: grey(0xd3, 0xd9, 0xe1),
                text: grey(0x2a, 0x2f, 0x37),
                weak: grey(0x59, 0x62, 0x70),
                strong: grey(0x10, 0x13, 0x18),
                error: grey(0xb3, 0x1d, 0x1d),
            },
        }
    }
}

/// Installs both themes and a fallback to system fonts; called once at the start.
pub fn install(ctx: &Context) {
    ctx.add_font_provider(system_fonts());
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(egui_theme(theme), |style| {
            style.visuals = visuals(theme);
            // The edges between panels are hit 4 points to each side.
            style.interaction.resize_grab_radius_side = 4.0;
            let spacing = &mut style.spacing;
            spacing.item_spacing = vec2(8.0, 6.0);
            spacing.button_padding = vec2(8.0, 4.0);
            spacing.interact_size = vec2(32.0, 22.0);
            spacing.icon_width = 16.0;
            spacing.menu_margin = egui::Margin::same(6);
            // Otherwise scroll bars cover the ends of texts.
            spacing.scroll.floating_allocated_width = 10.0;
            // Seen also while the mouse is elsewhere, but faintly: panels show that they scroll.
            spacing.scroll.dormant_handle_opacity = 0.2;
            spacing.scroll.active_handle_opacity = 0.35;
            spacing.scroll.interact_handle_opacity = 0.5;
            spacing.scroll.floating_width = 5.0;
            spacing.scroll.bar_width = 6.0;
            // Faded rows look disabled.
            spacing.scroll.fade.strength = 0.0;
            spacing.window_margin = egui::Margin::same(12);
            spacing.tooltip_width = 320.0;
            let size = |size| FontId::new(size, FontFamily::Proportional);
            style.text_styles = [
                (TextStyle::Small, size(11.0)),
                (TextStyle::Body, size(13.5)),
                (TextStyle::Button, size(13.5)),
                (TextStyle::Heading, size(16.0)),
                (TextStyle::Monospace, FontId::new(12.5, FontFamily::Monospace)),
            ]
            .into();
        });
    }
}

/// Applies a theme to the panels.
pub fn apply(ctx: &Context, theme: Theme) {
    // A slow adapter may show the two clicks of a double-click in frames this far apart, in
    // seconds.
    const DOUBLE_CLICK: f64 = 0.6;
    ctx.options_mut(|options| options.input_options.max_double_click_delay = DOUBLE_CLICK);
    ctx.set_theme(egui_theme(theme));
}

/// The scene's palette in the current theme.
pub(in crate::ui) fn palette(ui: &egui::Ui) -> Palette {
    Palette::new(if ui.visuals().dark_mode { Theme::Dark } else { Theme::Light })
}

/// The accent colour of the current theme.
pub(in crate::ui) fn accent(ui: &egui::Ui) -> Color32 {
    colour(palette(ui).accent)
}

pub(in crate::ui) fn colour(colour: Colour) -> Color32 {
    let [r, g, b, a] = colour.0;
    Color32::from_rgba_unmultiplied(r, g, b, a)
}

fn egui_theme(theme: Theme) -> egui::Theme {
    match theme {
        Theme::Dark => egui::Theme::Dark,
        Theme::Light => egui::Theme::Light,
    }
}

fn visuals(theme: Theme) -> Visuals {
    let tones = PanelColours::new(theme);
    let accent = colour(Palette::new(theme).accent);
    let mut visuals = match theme {
        Theme::Dark => Visuals::dark(),
        Theme::Light => Visuals::light(),
    };
    visuals.panel_fill = tones.panel;
    visuals.window_fill = tones.panel;
    visuals.extreme_bg_color = tones.field;
    visuals.faint_bg_color = tones.button;
    visuals.weak_text_color = Some(tones.weak);
    visuals.hyperlink_color = accent;
    visuals.error_fg_color = tones.error;
    // Straight below, as of a soft light from above.
    let shadow = |offset: i8, blur: u8, dark: u8, light: u8| Shadow {
        offset: [0, offset],
        blur,
        spread: 0,
        color: Color32::from_black_alpha(if theme == Theme::Dark { dark } else { light }),
    };
    visuals.window_shadow = shadow(4, 16, 110, 36);
    visuals.popup_shadow = shadow(2, 8, 90, 30);
    visuals.window_stroke = Stroke::new(1.0, tones.line);
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    visuals.selection.bg_fill = accent.gamma_multiply(0.45);
    visuals.selection.stroke = Stroke::new(1.0, tones.strong);
    let widgets = &mut visuals.widgets;
    for (widget, fill, text) in [
        (&mut widgets.noninteractive, tones.panel, tones.text),
        (&mut widgets.inactive, tones.button, tones.text),
        (&mut widgets.hovered, tones.hovered, tones.strong),
        (&mut widgets.active, tones.hovered, tones.strong),
        (&mut widgets.open, tones.button, tones.strong),
    ] {
        widget.bg_fill = fill;
        widget.weak_bg_fill = fill;
        widget.fg_stroke.color = text;
        widget.corner_radius = CornerRadius::same(4);
        widget.expansion = 0.0;
        widget.bg_stroke = Stroke::NONE;
    }
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, tones.line);
    widgets.hovered.bg_stroke = Stroke::new(1.0, tones.weak);
    widgets.active.bg_stroke = Stroke::new(1.0, accent);
    visuals
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast ratio of two colours from their relative luminance, as WCAG 2.1 defines both.
    fn contrast(a: Color32, b: Color32) -> f32 {
        let luminance = |c: Color32| {
            let [r, g, b] = [c.r(), c.g(), c.b()].map(|channel| {
                let v = f32::from(channel) / 255.0;
                if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
            });
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn every_text_stands_out_from_what_it_is_on() {
        for theme in [Theme::Dark, Theme::Light] {
            let (tones, palette) = (PanelColours::new(theme), Palette::new(theme));
            let on_panel = [
                tones.text,
                tones.weak,
                tones.strong,
                tones.error,
                colour(palette.upper),
                colour(palette.lower),
                colour(palette.accent),
            ];
            for text in on_panel {
                let contrast = contrast(text, tones.panel);
                assert!(contrast >= 4.5, "{theme:?}: {text:?} on the panel has {contrast}");
            }
            for (text, ground) in [
                (tones.text, tones.button),
                (tones.text, tones.field),
                (tones.strong, tones.hovered),
                (colour(palette.text), colour(palette.sky_top)),
                (colour(palette.text), colour(palette.sky_bottom)),
            ] {
                let contrast = contrast(text, ground);
                assert!(contrast >= 4.5, "{theme:?}: {text:?} on {ground:?} has {contrast}");
            }
        }
    }
}
