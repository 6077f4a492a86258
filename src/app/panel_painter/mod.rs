//! The painter of the panels, which redraws only the areas that have changed.
//!
//! It exists because of machines without a graphics card, where a software adapter draws on the
//! processor. `egui_wgpu` redraws all panels in each frame, with one shader for all kinds of
//! texture filters, of which a processor computes all for every pixel. With it, a drag of the arm
//! took 64 ms a frame at 1280×800 on two cores, even with the scene at half its size; with this
//! painter it takes 25 to 33 ms (docs/performance.md).
//!
//! A frame takes these steps:
//!
//! 1. `changes` hashes the triangles that touch each tile of 32×32 pixels and compares the hashes
//!    with those of the frame before. Tiles that differ are joined to at most 12 rectangles.
//! 2. `triangles` uploads the triangles that touch these rectangles, and draws them with a shader
//!    that has one filter.
//! 3. Under them come black, the picture of the scene and its labels. The picture of the window is
//!    kept in a texture, and the frame is a copy of it.
//!
//! A frame is bit for bit the frame that a painter of everything draws, and within 1 of 255 of
//! `egui_wgpu`'s; tests compare both.

mod changes;
mod triangles;

use egui::epaint::{ClippedPrimitive, ImageDelta};
use egui::{Context, Rect, TextureId};
use egui_wgpu::ScreenDescriptor;

use crate::render::{Gpu, Renderer, TexturePainter};
use changes::PanelChanges;
use triangles::PanelTriangles;
use triangles::PixelArea;

/// Draws the panels, and the scene under them, into a texture that keeps them. A frame redraws only
/// the areas that have changed, which is much faster on a software adapter (docs/performance.md).
pub(super) struct PanelPainter {
    triangles: PanelTriangles,
    texture_painter: TexturePainter,
    changes: PanelChanges,
    kept: KeptPicture,
    black: wgpu::TextureView,
    format: wgpu::TextureFormat,
}

/// The picture that the window shows.
struct KeptPicture {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// Where the scene is.
    viewport: Option<PixelArea>,
    /// True if all of it must be drawn.
    is_stale: bool,
}

/// The picture of the scene and its place in points.
pub(super) struct PlacedScene<'a> {
    /// The scene without its labels, of any size.
    pub picture: &'a wgpu::TextureView,
    /// Draws the labels.
    pub renderer: &'a Renderer,
    pub viewport: Rect,
    /// True if it differs from that of the frame before.
    pub has_changed: bool,
}

impl PanelPainter {
    /// Creates a painter for windows with this format, and uploads egui's whole font atlas.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, panels: &Context) -> Self {
        // Opaque black, the same bytes in RGBA and BGRA. It is blended over the kept pixels.
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let black = gpu.texture("black", format, [1, 1], usage);
        let row =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4), rows_per_image: None };
        gpu.queue.write_texture(black.as_image_copy(), &[0, 0, 0, 255], row, black.size());
        Self {
            triangles: PanelTriangles::new(gpu, format, panels),
            texture_painter: TexturePainter::new(gpu, format),
            changes: PanelChanges::default(),
            kept: KeptPicture::new(gpu, format, [1, 1]),
            black: black.create_view(&Default::default()),
            format,
        }
    }

    pub fn update_textures(
        &mut self,
        gpu: &Gpu,
        changed: impl IntoIterator<Item = (TextureId, impl IntoIterator<Item = ImageDelta>)>,
    ) {
        for (id, deltas) in changed {
            for delta in deltas {
                // A part adds glyphs to the font atlas; a whole atlas may change glyphs on screen.
                self.kept.is_stale |= delta.pos.is_none();
                self.triangles.update_texture(gpu, id, &delta);
            }
        }
    }

    pub fn free_textures(&mut self, freed: impl IntoIterator<Item = TextureId>) {
        for id in freed {
            self.triangles.free_texture(id);
        }
    }

    /// Redraws the areas of the panels and the scene that have changed since the last call, and
    /// returns whether there are any.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        (panels, screen): (&[ClippedPrimitive], &ScreenDescriptor),
        scene: &PlacedScene<'_>,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> bool {
        let viewport = PixelArea::nearest(scene.viewport, screen);
        let changed = self.changed_areas(gpu, (panels, screen), viewport, scene.has_changed);
        let has_changed = !changed.is_empty();
        let batches = self.triangles.upload(gpu, panels, screen, &changed);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("panels"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.kept.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            timestamp_writes: timestamps,
            ..Default::default()
        });
        let window = PixelArea { at: [0, 0], size: screen.size_in_pixels };
        for (area, batches) in changed.into_iter().zip(batches) {
            if viewport != Some(area) {
                self.draw_texture(gpu, &mut pass, &self.black, area, area);
            }
            if let Some(viewport) = viewport.filter(|it| it.intersection(area).is_some()) {
                self.draw_texture(gpu, &mut pass, scene.picture, viewport, area);
                scene.renderer.draw_labels(&mut pass);
            }
            set_viewport(&mut pass, window);
            self.triangles.draw(&mut pass, &batches);
        }
        has_changed
    }

    /// Areas that must be drawn, in a kept picture of the screen's size.
    fn changed_areas(
        &mut self,
        gpu: &Gpu,
        (panels, screen): (&[ClippedPrimitive], &ScreenDescriptor),
        viewport: Option<PixelArea>,
        has_scene_changed: bool,
    ) -> Vec<PixelArea> {
        let size = screen.size_in_pixels;
        if [self.kept.texture.width(), self.kept.texture.height()] != size {
            self.kept = KeptPicture::new(gpu, self.format, size);
        }
        let was_there = std::mem::replace(&mut self.kept.viewport, viewport) == viewport;
        let drawn = if std::mem::take(&mut self.kept.is_stale) || !was_there {
            Some(PixelArea { at: [0, 0], size })
        } else {
            viewport.filter(|_| has_scene_changed)
        };
        let mut changed = self.changes.replace(panels, screen, drawn);
        changed.extend(drawn);
        changed
    }

    /// Draws the part of a texture that is in `area`. The whole texture fills `place`.
    fn draw_texture(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass<'_>,
        texture: &wgpu::TextureView,
        place: PixelArea,
        area: PixelArea,
    ) {
        if let Some(inside) = area.intersection(place) {
            let ([x, y], [width, height]) = (inside.at, inside.size);
            pass.set_scissor_rect(x, y, width, height);
            set_viewport(pass, place);
            self.texture_painter.draw(gpu, pass, texture);
        }
    }

    /// Encodes the copy to a frame of the window.
    pub fn copy_to(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, frame: &wgpu::Texture) {
        if frame.usage().contains(wgpu::TextureUsages::COPY_DST) {
            let (from, to) = (self.kept.texture.as_image_copy(), frame.as_image_copy());
            encoder.copy_texture_to_texture(from, to, frame.size());
            return;
        }
        let view = frame.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("window"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.texture_painter.draw(gpu, &mut pass, &self.kept.view);
    }
}

impl KeptPicture {
    fn new(gpu: &Gpu, format: wgpu::TextureFormat, size: [u32; 2]) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = gpu.texture("panels", format, size, usage);
        let view = texture.create_view(&Default::default());
        Self { texture, view, viewport: None, is_stale: true }
    }
}

fn set_viewport(pass: &mut wgpu::RenderPass<'_>, area: PixelArea) {
    let ([x, y], [width, height]) = (area.at, area.size);
    pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
}

#[cfg(test)]
mod tests {
    use egui::{Event, PointerButton, RawInput, pos2, vec2};

    use super::*;
    use crate::document::Theme;
    use crate::session::{Actions, Preferences, Session, ShellAction};
    use crate::ui::{self, Machine, style};

    const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
    const SIZE: [u32; 2] = [1000, 640];

    /// The panels without a window, and a red scene.
    struct Panels {
        gpu: Gpu,
        context: Context,
        session: Session,
        scene: wgpu::TextureView,
        renderer: Renderer,
    }

    impl Panels {
        fn new() -> Self {
            let gpu = pollster::block_on(Gpu::headless()).expect("a graphics adapter");
            let context = Context::default();
            style::install(&context);
            let usage =
                wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
            let scene = gpu.texture("scene", FORMAT, [1, 1], usage);
            let scene = scene.create_view(&Default::default());
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &scene,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::RED),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            }));
            gpu.queue.submit([encoder.finish()]);
            let preferences = Preferences { offers_tour: false, ..Preferences::default() };
            let renderer = Renderer::with_labels(&gpu, FORMAT);
            Self { gpu, context, session: Session::new(preferences), scene, renderer }
        }

        /// Runs a frame, and draws it with each painter. Returns the panels.
        fn frame(
            &mut self,
            events: Vec<Event>,
            painters: &mut [&mut PanelPainter],
        ) -> Vec<ClippedPrimitive> {
            let [width, height] = SIZE.map(|side| side as f32);
            let screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height)));
            let input = RawInput { screen_rect, events, ..RawInput::default() };
            style::apply(&self.context, self.session.preferences().theme);
            let (mut actions, mut viewport) = (Actions::new(), Rect::NOTHING);
            let mut output = self.context.run_ui(input, |ui| {
                viewport = ui::show(ui, &self.session, &Machine::default(), &mut actions);
            });
            let screen = ScreenDescriptor { size_in_pixels: SIZE, pixels_per_point: 1.0 };
            let set = std::mem::take(&mut output.textures_delta.set);
            output.textures_delta.free.clear();
            let panels = self.context.tessellate(output.shapes, 1.0);
            for painter in painters {
                painter.update_textures(&self.gpu, set.clone());
                let (picture, renderer) = (&self.scene, &self.renderer);
                let scene = PlacedScene { picture, renderer, viewport, has_changed: false };
                let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
                painter.draw(&self.gpu, &mut encoder, (&panels, &screen), &scene, None);
                self.gpu.queue.submit([encoder.finish()]);
            }
            for action in actions.drain() {
                self.session.apply(action);
            }
            panels
        }
    }

    fn pixels(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<u8> {
        let [width, height] = SIZE;
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: None,
        };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        gpu.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |read| read.expect("mapped"));
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("drawn");
        buffer.get_mapped_range(..).expect("mapped").to_vec()
    }

    #[test]
    fn frames_that_draw_only_what_has_changed_are_those_that_draw_all() {
        let mut panels = Panels::new();
        let new = |panels: &Panels| PanelPainter::new(&panels.gpu, FORMAT, &panels.context);
        let (mut some, mut all) = (new(&panels), new(&panels));
        let moved = |x: f32, y: f32| Event::PointerMoved(pos2(x, y));
        let pressed = |x: f32, y: f32, pressed: bool| Event::PointerButton {
            pos: pos2(x, y),
            button: PointerButton::Primary,
            pressed,
            modifiers: Default::default(),
        };
        let key = |key: egui::Key| Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Default::default(),
        };
        let mut frames = vec![vec![], vec![]];
        // Over the sliders and the picture, and along the menus.
        frames.extend((0..12).map(|step| vec![moved(60.0 + 60.0 * step as f32, 105.0)]));
        frames.extend((0..6).map(|step| vec![moved(20.0 + 50.0 * step as f32, 12.0)]));
        // Drags a slider, opens a menu and closes it, and drags in the picture.
        frames.push(vec![moved(150.0, 105.0), pressed(150.0, 105.0, true)]);
        frames.extend((0..5).map(|step| vec![moved(150.0 - 8.0 * step as f32, 106.0)]));
        frames.push(vec![pressed(118.0, 106.0, false)]);
        frames.push(vec![moved(95.0, 12.0), pressed(95.0, 12.0, true)]);
        frames.push(vec![pressed(95.0, 12.0, false)]);
        frames.extend([vec![], vec![moved(110.0, 60.0)], vec![key(egui::Key::Escape)], vec![]]);
        frames.push(vec![moved(330.0, 420.0), pressed(330.0, 420.0, true)]);
        frames.extend((0..5).map(|step| vec![moved(330.0 + 9.0 * step as f32, 410.0)]));
        frames.push(vec![pressed(375.0, 410.0, false), key(egui::Key::F1)]);
        for (number, events) in frames.into_iter().enumerate() {
            if number == 20 {
                panels.session.apply(ShellAction::SetTheme(Theme::Light));
            }
            all.kept.is_stale = true;
            panels.frame(events, &mut [&mut some, &mut all]);
            let [some, all] =
                [&some, &all].map(|painter| pixels(&panels.gpu, &painter.kept.texture));
            let off = some.iter().zip(&all).filter(|(a, b)| a != b).count();
            assert_eq!(off, 0, "frame {number}");
        }
    }

    /// Draws panels over red with the renderer of `egui_wgpu`.
    fn by_egui(panels: &Panels, shown: &[ClippedPrimitive]) -> Vec<u8> {
        let gpu = &panels.gpu;
        let options = egui_wgpu::RendererOptions { dithering: false, ..Default::default() };
        let mut renderer = egui_wgpu::Renderer::new(&gpu.device, FORMAT, options);
        let atlas = panels.context.fonts(|fonts| {
            ImageDelta::full(fonts.image(), egui::epaint::TextureAtlas::texture_options())
        });
        renderer.update_texture(&gpu.device, &gpu.queue, TextureId::default(), &atlas);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let picture = gpu.texture("egui", FORMAT, SIZE, usage);
        let view = picture.create_view(&Default::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let screen = ScreenDescriptor { size_in_pixels: SIZE, pixels_per_point: 1.0 };
        renderer.update_buffers(&gpu.device, &gpu.queue, &mut encoder, shown, &screen);
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::RED),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            })
            .forget_lifetime();
        renderer.render(&mut pass, shown, &screen);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        pixels(gpu, &picture)
    }

    #[test]
    fn panels_look_as_eguis_own_renderer_draws_them() {
        let mut panels = Panels::new();
        let mut painter = PanelPainter::new(&panels.gpu, FORMAT, &panels.context);
        for theme in [Theme::Dark, Theme::Light] {
            panels.session.apply(ShellAction::SetTheme(theme));
            // The first frames measure texts.
            (0..3).for_each(|_| drop(panels.frame(vec![], &mut [&mut painter])));
            let shown = panels.frame(vec![], &mut [&mut painter]);
            let ours = pixels(&panels.gpu, &painter.kept.texture);
            let theirs = by_egui(&panels, &shown);
            let drawn = theirs.chunks(4).filter(|pixel| *pixel != [255, 0, 0, 255]).count();
            assert!(drawn > 100_000, "{drawn}");
            let off = ours.iter().zip(&theirs).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(off <= Some(1), "{off:?}");
        }
    }
}
