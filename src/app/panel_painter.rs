use egui::epaint::{ClippedPrimitive, ClippedShape, ImageDelta, TextureAtlas};
use egui::{Context, Rect, TextureId};
use egui_wgpu::ScreenDescriptor;

use super::panel_changes::PanelChanges;
use crate::render::{Gpu, TexturePainter};

/// Draws the panels, and the scene under them, into a texture that keeps them. A frame draws only
/// the rectangles that have changed, which a machine without a graphics card does much faster.
pub(super) struct PanelPainter {
    renderer: egui_wgpu::Renderer,
    texture_painter: TexturePainter,
    changes: PanelChanges,
    /// Rectangles of the next frame in points.
    changed: Vec<Rect>,
    kept: KeptPicture,
    black: wgpu::TextureView,
    format: wgpu::TextureFormat,
}

/// What the window shows.
struct KeptPicture {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// Whether all of it must be drawn.
    is_stale: bool,
}

/// The picture of the scene and its place in points.
pub(super) struct PlacedScene<'a> {
    pub picture: &'a wgpu::TextureView,
    pub viewport: Rect,
    /// Whether it differs from that of the frame before.
    pub has_changed: bool,
}

impl PanelPainter {
    /// Creates a painter for windows with this format, and uploads egui's whole font atlas.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, panels: &Context) -> Self {
        let mut renderer = egui_wgpu::Renderer::new(&gpu.device, format, Default::default());
        upload_font_atlas(&mut renderer, gpu, panels);
        // Opaque, since it is blended over what is there; the order of the colours does not matter.
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let black = texture(gpu, "black", format, [1, 1], usage);
        let row =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4), rows_per_image: None };
        gpu.queue.write_texture(black.as_image_copy(), &[0, 0, 0, 255], row, black.size());
        Self {
            renderer,
            texture_painter: TexturePainter::new(gpu, format),
            changes: PanelChanges::default(),
            changed: Vec::new(),
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
                // Parts are added to the font atlas; only a whole one changes what is drawn.
                self.kept.is_stale |= delta.pos.is_none();
                self.renderer.update_texture(&gpu.device, &gpu.queue, id, &delta);
            }
        }
    }

    pub fn free_textures(&mut self, freed: impl IntoIterator<Item = TextureId>) {
        for id in freed {
            self.renderer.free_texture(&id);
        }
    }

    /// Notes what the shapes of a frame change.
    pub fn note_changes(&mut self, shapes: &[ClippedShape]) {
        self.changed.extend(self.changes.replace(shapes));
    }

    /// Draws what has changed since the last call, of panels on a screen. Returns commands to be submitted before those of
    /// `encoder`.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        (panels, screen): (&mut [ClippedPrimitive], &ScreenDescriptor),
        scene: &PlacedScene<'_>,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> Vec<wgpu::CommandBuffer> {
        let [width, height] = screen.size_in_pixels;
        if (self.kept.texture.width(), self.kept.texture.height()) != (width, height) {
            self.kept = KeptPicture::new(gpu, self.format, [width, height]);
        }
        if scene.has_changed {
            self.changed.push(scene.viewport);
        }
        let mut changed = std::mem::take(&mut self.changed);
        if std::mem::take(&mut self.kept.is_stale) {
            changed = vec![Rect::EVERYTHING];
        }
        let commands =
            self.renderer.update_buffers(&gpu.device, &gpu.queue, encoder, panels, screen);
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("panels"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.kept.view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
                })],
                timestamp_writes: timestamps,
                ..Default::default()
            })
            .forget_lifetime();
        let clips: Vec<_> = panels.iter().map(|panel| panel.clip_rect).collect();
        for area in changed.into_iter().filter_map(|rect| PixelArea::touched(rect, screen)) {
            area.draw(gpu, &self.texture_painter, &mut pass, &self.black, None);
            if let Some(viewport) = PixelArea::nearest(scene.viewport, screen) {
                area.draw(gpu, &self.texture_painter, &mut pass, scene.picture, Some(viewport));
            }
            let points = area.in_points(screen);
            for (panel, clip) in panels.iter_mut().zip(&clips) {
                let inside = clip.intersect(points);
                panel.clip_rect = if inside.is_positive() { inside } else { Rect::ZERO };
            }
            self.renderer.render(&mut pass, panels, screen);
        }
        commands
    }

    /// Discards what is kept: a frame was not shown.
    pub fn draw_all_next(&mut self) {
        self.kept.is_stale = true;
    }

    /// Encodes the copy to a frame of the window.
    pub fn copy_to(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, frame: &wgpu::Texture) {
        let size = self.kept.texture.size();
        if frame.usage().contains(wgpu::TextureUsages::COPY_DST) && frame.size() == size {
            let (from, to) = (self.kept.texture.as_image_copy(), frame.as_image_copy());
            encoder.copy_texture_to_texture(from, to, size);
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
        let texture = texture(gpu, "panels", format, size, usage);
        let view = texture.create_view(&Default::default());
        Self { texture, view, is_stale: true }
    }
}

/// A rectangle of whole pixels in the window: left, top, width and height, not empty.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PixelArea {
    at: [u32; 2],
    size: [u32; 2],
}

impl PixelArea {
    /// All pixels that a rectangle in points touches; `None` without any in the window.
    fn touched(rect: Rect, screen: &ScreenDescriptor) -> Option<Self> {
        Self::of(rect, screen, [f32::floor, f32::ceil])
    }

    /// The pixels of a rectangle that is made of whole pixels, but for rounding.
    fn nearest(rect: Rect, screen: &ScreenDescriptor) -> Option<Self> {
        Self::of(rect, screen, [f32::round, f32::round])
    }

    fn of(rect: Rect, screen: &ScreenDescriptor, round: [fn(f32) -> f32; 2]) -> Option<Self> {
        let [from, to] = round;
        let [width, height] = screen.size_in_pixels;
        let pixel = |at: f32, most: u32| (at.max(0.0) as u32).min(most);
        let points = rect * screen.pixels_per_point;
        let at = [pixel(from(points.left()), width), pixel(from(points.top()), height)];
        let end = [pixel(to(points.right()), width), pixel(to(points.bottom()), height)];
        let size = [end[0].saturating_sub(at[0]), end[1].saturating_sub(at[1])];
        (size[0] > 0 && size[1] > 0).then_some(Self { at, size })
    }

    fn in_points(self, screen: &ScreenDescriptor) -> Rect {
        let point = |x: u32, y: u32| egui::pos2(x as f32, y as f32) / screen.pixels_per_point;
        let ([x, y], [width, height]) = (self.at, self.size);
        Rect::from_min_max(point(x, y), point(x + width, y + height))
    }

    fn intersection(self, other: Self) -> Option<Self> {
        let range = |axis: usize| {
            let from = self.at[axis].max(other.at[axis]);
            let to = (self.at[axis] + self.size[axis]).min(other.at[axis] + other.size[axis]);
            (from < to).then(|| (from, to - from))
        };
        let ((x, width), (y, height)) = (range(0)?, range(1)?);
        Some(Self { at: [x, y], size: [width, height] })
    }

    /// Draws the part of a texture that is in this area. The texture fills `place`, else the area.
    fn draw(
        self,
        gpu: &Gpu,
        painter: &TexturePainter,
        pass: &mut wgpu::RenderPass<'_>,
        texture: &wgpu::TextureView,
        place: Option<Self>,
    ) {
        let place = place.unwrap_or(self);
        if let Some(inside) = self.intersection(place) {
            let ([x, y], [width, height]) = (inside.at, inside.size);
            pass.set_scissor_rect(x, y, width, height);
            let ([x, y], [width, height]) = (place.at, place.size);
            pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
            painter.draw(gpu, pass, texture);
        }
    }
}

fn texture(
    gpu: &Gpu,
    label: &str,
    format: wgpu::TextureFormat,
    [width, height]: [u32; 2],
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Uploads egui's whole font atlas: egui itself sends only changes, which a new renderer cannot apply.
fn upload_font_atlas(renderer: &mut egui_wgpu::Renderer, gpu: &Gpu, panels: &Context) {
    // egui has no fonts before its first frame.
    if panels.cumulative_pass_nr() == 0 {
        return;
    }
    let all =
        panels.fonts(|fonts| ImageDelta::full(fonts.image(), TextureAtlas::texture_options()));
    renderer.update_texture(&gpu.device, &gpu.queue, TextureId::default(), &all);
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
    }

    impl Panels {
        fn new() -> Self {
            let gpu = Gpu::headless().expect("a graphics adapter");
            let context = Context::default();
            style::install(&context);
            let usage =
                wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
            let scene = texture(&gpu, "scene", FORMAT, [1, 1], usage);
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
            Self { gpu, context, session: Session::new(preferences), scene }
        }

        /// Runs a frame, and draws it with each painter.
        fn frame(&mut self, events: Vec<Event>, painters: &mut [&mut PanelPainter]) {
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
            for painter in painters {
                painter.update_textures(&self.gpu, set.clone());
                painter.note_changes(&output.shapes);
                let mut panels = self.context.tessellate(output.shapes.clone(), 1.0);
                let scene = PlacedScene { picture: &self.scene, viewport, has_changed: false };
                let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
                let panels = (&mut panels[..], &screen);
                let mut commands = painter.draw(&self.gpu, &mut encoder, panels, &scene, None);
                commands.push(encoder.finish());
                self.gpu.queue.submit(commands);
            }
            for action in actions.drain() {
                self.session.apply(action);
            }
        }
    }

    fn pixels(gpu: &Gpu, painter: &PanelPainter) -> Vec<u8> {
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
        let size = painter.kept.texture.size();
        encoder.copy_texture_to_buffer(painter.kept.texture.as_image_copy(), to, size);
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
            all.draw_all_next();
            panels.frame(events, &mut [&mut some, &mut all]);
            let [some, all] = [&some, &all].map(|painter| pixels(&panels.gpu, painter));
            let off = some.iter().zip(&all).filter(|(a, b)| a != b).count();
            assert_eq!(off, 0, "frame {number}");
        }
    }

    #[test]
    fn areas_are_in_the_window_and_cover_what_they_are_made_of() {
        let screen = ScreenDescriptor { size_in_pixels: [100, 50], pixels_per_point: 1.5 };
        let area = |x: f32, y: f32, width: f32, height: f32| {
            PixelArea::touched(Rect::from_min_size(pos2(x, y), vec2(width, height)), &screen)
        };
        assert_eq!(area(1.0, 1.0, 2.0, 2.0), Some(PixelArea { at: [1, 1], size: [4, 4] }));
        assert_eq!(area(-9.0, -9.0, 10.0, 10.0), Some(PixelArea { at: [0, 0], size: [2, 2] }));
        assert_eq!(area(70.0, 0.0, 9.0, 9.0), None);
        let all = PixelArea::touched(Rect::EVERYTHING, &screen);
        assert_eq!(all, Some(PixelArea { at: [0, 0], size: [100, 50] }));
        let viewport = Rect::from_min_max(pos2(2.0, 4.0), pos2(20.0, 30.0000002));
        let nearest = PixelArea::nearest(viewport, &screen);
        assert_eq!(nearest, Some(PixelArea { at: [3, 6], size: [27, 39] }));
    }
}
