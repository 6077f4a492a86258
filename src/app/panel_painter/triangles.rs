use core::ops::Range;
use std::collections::HashMap;

use egui::epaint::{ClippedPrimitive, ImageDelta, Mesh, Primitive, TextureAtlas};
use egui::{Context, Pos2, Rect, TextureId};
use egui_wgpu::ScreenDescriptor;

use crate::render::{Corner, Gpu, PaintTexture, TrianglePainter};

/// Draws the triangles of the panels that touch some areas of the window.
///
/// The renderer of `egui_wgpu` has one shader for all kinds of texture filters. A processor
/// computes all of them for every pixel, which takes several times as long as this.
pub(in crate::app) struct PanelTriangles {
    painter: TrianglePainter,
    textures: HashMap<TextureId, PaintTexture>,
}

/// Triangles with the same texture and clipping.
pub(in crate::app) struct TriangleBatch {
    texture: TextureId,
    clip: PixelArea,
    corners: Range<u32>,
}

impl PanelTriangles {
    /// Creates the pipeline for windows with this format, and uploads egui's whole font atlas.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, panels: &Context) -> Self {
        let painter = TrianglePainter::new(gpu, format);
        let mut triangles = Self { painter, textures: HashMap::new() };
        // egui has no fonts before its first frame. Later it sends only changes of the atlas.
        if panels.cumulative_pass_nr() > 0 {
            let options = TextureAtlas::texture_options();
            let all = panels.fonts(|fonts| ImageDelta::full(fonts.image(), options));
            triangles.update_texture(gpu, TextureId::default(), &all);
        }
        triangles
    }

    /// Creates a texture, or writes a part of it.
    pub fn update_texture(&mut self, gpu: &Gpu, id: TextureId, delta: &ImageDelta) {
        if delta.pos.is_none() {
            self.textures.insert(id, self.painter.texture(gpu, delta));
        }
        match self.textures.get(&id) {
            Some(texture) => {
                texture.write(gpu, delta);
            }
            None => log::warn!("texture {id:?} of the panels is changed before it is created"),
        }
    }

    pub fn free_texture(&mut self, id: TextureId) {
        self.textures.remove(&id);
    }

    /// Uploads the triangles that touch some areas, and returns those of each area.
    pub fn upload(
        &mut self,
        gpu: &Gpu,
        panels: &[ClippedPrimitive],
        screen: &ScreenDescriptor,
        areas: &[PixelArea],
    ) -> Vec<Vec<TriangleBatch>> {
        let mut count = 0;
        let batches = areas.iter().map(|area| self.push(panels, screen, *area, &mut count));
        let batches = batches.collect();
        let size = screen.size_in_pixels.map(|side| side as f32 / screen.pixels_per_point);
        self.painter.upload(gpu, size);
        batches
    }

    fn push(
        &mut self,
        panels: &[ClippedPrimitive],
        screen: &ScreenDescriptor,
        area: PixelArea,
        count: &mut u32,
    ) -> Vec<TriangleBatch> {
        // With a margin for rounding.
        let touched = area.in_points(screen).expand(1.0);
        let mut batches = Vec::new();
        for ClippedPrimitive { clip_rect, primitive } in panels {
            let clip = PixelArea::nearest(*clip_rect, screen);
            let (Some(clip), Primitive::Mesh(mesh)) =
                (clip.and_then(|clip| clip.intersection(area)), primitive)
            else {
                continue;
            };
            let first = *count;
            for corner in triangles(mesh, touched).flatten() {
                self.painter.push(corner);
                *count += 1;
            }
            if *count > first {
                batches.push(TriangleBatch {
                    texture: mesh.texture_id,
                    clip,
                    corners: first..*count,
                });
            }
        }
        batches
    }

    /// Draws uploaded triangles. Changes the scissor rectangle.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, batches: &[TriangleBatch]) {
        for TriangleBatch { texture, clip, corners } in batches {
            let ([x, y], [width, height]) = (clip.at, clip.size);
            if let Some(texture) = self.textures.get(texture) {
                pass.set_scissor_rect(x, y, width, height);
                self.painter.draw(pass, texture, corners.clone());
            }
        }
    }
}

/// Corners of the triangles that touch a rectangle in points.
fn triangles(mesh: &Mesh, touched: Rect) -> impl Iterator<Item = [Corner; 3]> + '_ {
    mesh.indices.chunks_exact(3).filter_map(move |triangle| {
        let corners = [0, 1, 2].map(|corner| mesh.vertices[triangle[corner] as usize]);
        Rect::from_points(&corners.map(|corner| corner.pos)).intersects(touched).then(|| {
            corners.map(|corner| Corner {
                at: point(corner.pos),
                in_texture: point(corner.uv),
                colour: corner.color.to_array(),
            })
        })
    })
}

fn point(Pos2 { x, y }: Pos2) -> [f32; 2] {
    [x, y]
}

/// A rectangle of whole pixels in the window: left, top, width and height, not empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::app) struct PixelArea {
    pub at: [u32; 2],
    pub size: [u32; 2],
}

impl PixelArea {
    /// All pixels that a rectangle in points touches; `None` without any in the window.
    pub fn touched(rect: Rect, screen: &ScreenDescriptor) -> Option<Self> {
        Self::of(rect, screen, [f32::floor, f32::ceil])
    }

    /// The pixels of a rectangle that is made of whole pixels, but for rounding.
    pub fn nearest(rect: Rect, screen: &ScreenDescriptor) -> Option<Self> {
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

    pub fn in_points(self, screen: &ScreenDescriptor) -> Rect {
        let point = |x: u32, y: u32| egui::pos2(x as f32, y as f32) / screen.pixels_per_point;
        let ([x, y], [width, height]) = (self.at, self.size);
        Rect::from_min_max(point(x, y), point(x + width, y + height))
    }

    pub fn intersection(self, other: Self) -> Option<Self> {
        let range = |axis: usize| {
            let from = self.at[axis].max(other.at[axis]);
            let to = (self.at[axis] + self.size[axis]).min(other.at[axis] + other.size[axis]);
            (from < to).then(|| (from, to - from))
        };
        let ((x, width), (y, height)) = (range(0)?, range(1)?);
        Some(Self { at: [x, y], size: [width, height] })
    }
}

#[cfg(test)]
mod tests {
    use egui::{pos2, vec2};

    use crate::app::panel_painter::triangles::*;

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
