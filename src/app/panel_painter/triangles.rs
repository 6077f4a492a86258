use core::ops::Range;
use std::collections::HashMap;

use egui::epaint::{ClippedPrimitive, ImageData, ImageDelta, Mesh, Primitive, TextureAtlas};
use egui::{Color32, Context, Pos2, Rect, TextureId};
use egui_wgpu::ScreenDescriptor;

use super::pixel_area::PixelArea;
use crate::render::{Corner, Gpu, TrianglePainter};

/// Draws the triangles of the panels that touch some areas of the window.
///
/// The renderer of `egui_wgpu` has one shader for all kinds of texture filters. A processor
/// computes all of them for every pixel, which takes several times as long as this.
pub(in crate::app) struct PanelTriangles {
    painter: TrianglePainter,
    textures: HashMap<TextureId, PanelTexture>,
}

struct PanelTexture {
    texture: wgpu::Texture,
    group: wgpu::BindGroup,
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
        let ImageData::Color(image) = &delta.image;
        let [width, height] = image.size.map(|side| side as u32);
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        if delta.pos.is_none() {
            self.textures.insert(id, PanelTexture::new(gpu, &self.painter, size));
        }
        let Some(PanelTexture { texture, .. }) = self.textures.get(&id) else {
            log::warn!("texture {id:?} of the panels is changed before it is created");
            return;
        };
        let [x, y] = delta.pos.unwrap_or_default().map(|at| at as u32);
        let bytes: Vec<u8> = image.pixels.iter().flat_map(Color32::to_array).collect();
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x, y, z: 0 },
                ..texture.as_image_copy()
            },
            &bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: None,
            },
            size,
        );
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
            if let Some(PanelTexture { group, .. }) = self.textures.get(texture) {
                pass.set_scissor_rect(x, y, width, height);
                self.painter.draw(pass, group, corners.clone());
            }
        }
    }
}

impl PanelTexture {
    fn new(gpu: &Gpu, painter: &TrianglePainter, size: wgpu::Extent3d) -> Self {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("panels' texture"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let group = painter.texture_group(gpu, &texture.create_view(&Default::default()));
        Self { texture, group }
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
