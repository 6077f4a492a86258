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
        // A new texture is black.
        let usage = wgpu::TextureUsages::TEXTURE_BINDING;
        let black = texture(gpu, "black", format, [1, 1], usage);
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
