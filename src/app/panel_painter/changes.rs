use core::ops::Range;

use egui::Rect;
use egui::epaint::util::hash;
use egui::epaint::{ClippedPrimitive, Mesh, Primitive, Vertex};
use egui_wgpu::ScreenDescriptor;

use super::triangles::PixelArea;

/// Side of a tile in pixels.
const TILE: u32 = 32;

/// Maximum number of changed areas. Each costs a loop over the triangles of the panels.
const MAX_AREAS: usize = 12;

/// Cost of one more area, as a number of unchanged tiles to redraw.
const AREA_COST: u32 = 4;

/// Finds the parts of the window where the panels differ from the frame before.
#[derive(Default)]
pub(in crate::app) struct PanelChanges {
    tiles: Tiles,
}

/// Square parts of the window, row by row. Each has a hash of the triangles that touch it, in their
/// order, so that tiles with the same hash look the same.
#[derive(Default)]
struct Tiles {
    columns: u32,
    hashes: Vec<u64>,
}

impl PanelChanges {
    /// Areas that contain all pixels in which the panels differ from the previous ones, which are
    /// then replaced. The area `drawn`, which is drawn anyway, need not be covered.
    pub fn replace(
        &mut self,
        panels: &[ClippedPrimitive],
        screen: &ScreenDescriptor,
        drawn: Option<PixelArea>,
    ) -> Vec<PixelArea> {
        let before = std::mem::replace(&mut self.tiles, Tiles::new(panels, screen));
        let mut areas = Vec::new();
        for row in self.tiles.rows() {
            let has_changed = |column: u32| {
                let index = self.tiles.index(column, row);
                let is_same = before.hashes.get(index) == self.tiles.hashes.get(index);
                let tile = area(&[column..column + 1, row..row + 1]);
                !is_same && drawn.is_none_or(|drawn| tile.intersection(drawn) != Some(tile))
            };
            for columns in runs(self.tiles.columns, has_changed) {
                add(&mut areas, [columns, row..row + 1]);
            }
        }
        let window = PixelArea { at: [0, 0], size: screen.size_in_pixels };
        areas.iter().filter_map(|tiles| area(tiles).intersection(window)).collect()
    }
}

impl Tiles {
    fn new(panels: &[ClippedPrimitive], screen: &ScreenDescriptor) -> Self {
        let [columns, rows] = screen.size_in_pixels.map(|side| side.div_ceil(TILE));
        let mut tiles = Self { columns, hashes: vec![0; (columns * rows) as usize] };
        for ClippedPrimitive { clip_rect, primitive } in panels {
            if let Primitive::Mesh(mesh) = primitive {
                tiles.add(mesh, *clip_rect, screen);
            }
        }
        tiles
    }

    fn add(&mut self, mesh: &Mesh, clip_rect: Rect, screen: &ScreenDescriptor) {
        let Rect { min, max } = clip_rect;
        let clip = hash(([min.x, min.y, max.x, max.y].map(f32::to_bits), mesh.texture_id));
        let vertices: Vec<_> = mesh.vertices.iter().map(hash_of_vertex).collect();
        for triangle in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| triangle[corner] as usize);
            let bounds = Rect::from_points(&corners.map(|corner| mesh.vertices[corner].pos));
            // Clip rectangles are rounded to whole pixels.
            let Some(touched) = PixelArea::touched(bounds.intersect(clip_rect).expand(1.0), screen)
            else {
                continue;
            };
            let triangle = hash((clip, corners.map(|corner| vertices[corner])));
            let [columns, rows] = [0, 1].map(|axis| {
                let end = touched.at[axis] + touched.size[axis];
                touched.at[axis] / TILE..end.div_ceil(TILE)
            });
            for row in rows {
                for column in columns.clone() {
                    let index = self.index(column, row);
                    self.hashes[index] = hash((self.hashes[index], triangle));
                }
            }
        }
    }

    fn rows(&self) -> Range<u32> {
        0..(self.hashes.len() as u32).checked_div(self.columns).unwrap_or(0)
    }

    fn index(&self, column: u32, row: u32) -> usize {
        (row * self.columns + column) as usize
    }
}

fn hash_of_vertex(Vertex { pos, uv, color }: &Vertex) -> u64 {
    hash(([pos.x, pos.y, uv.x, uv.y].map(f32::to_bits), color))
}

/// Longest ranges of columns that fulfil a condition.
fn runs(columns: u32, condition: impl Fn(u32) -> bool) -> Vec<Range<u32>> {
    let mut runs: Vec<Range<u32>> = Vec::new();
    for column in (0..columns).filter(|column| condition(*column)) {
        match runs.last_mut() {
            Some(run) if run.end == column => run.end += 1,
            _ => runs.push(column..column + 1),
        }
    }
    runs
}

/// Ranges of columns and rows of tiles.
type TileRect = [Range<u32>; 2];

/// Adds tiles, united with other tiles if that costs less than another area.
fn add(rects: &mut Vec<TileRect>, rect: TileRect) {
    let waste = |other: &TileRect| {
        let (sum, union) = (count(other) + count(&rect), count(&union(other, &rect)));
        union.saturating_sub(sum)
    };
    let nearest = rects.iter().enumerate().map(|(index, other)| (waste(other), index)).min();
    match nearest {
        Some((waste, index)) if waste <= AREA_COST || rects.len() == MAX_AREAS => {
            let other = rects.swap_remove(index);
            add(rects, union(&other, &rect));
        }
        _ => rects.push(rect),
    }
}

fn count([columns, rows]: &TileRect) -> u32 {
    (columns.end - columns.start) * (rows.end - rows.start)
}

fn union(a: &TileRect, b: &TileRect) -> TileRect {
    [0, 1].map(|axis| a[axis].start.min(b[axis].start)..a[axis].end.max(b[axis].end))
}

fn area(tiles: &TileRect) -> PixelArea {
    PixelArea {
        at: tiles.each_ref().map(|range| range.start * TILE),
        size: tiles.each_ref().map(|range| (range.end - range.start) * TILE),
    }
}

#[cfg(test)]
mod tests {
    use egui::epaint::Mesh;
    use egui::{Color32, Pos2, Rect, Vec2};

    use super::*;

    const SIDE: u32 = 130;
    const SCREEN: ScreenDescriptor =
        ScreenDescriptor { size_in_pixels: [SIDE, SIDE], pixels_per_point: 1.0 };

    /// Numbers below a bound, the same on every run.
    struct Random(u64);

    impl Random {
        fn below(&mut self, bound: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 33) as usize % bound
        }

        fn rect(&mut self) -> Rect {
            let mut number = |bound: usize| self.below(bound) as f32;
            let at = Pos2::new(number(SIDE as usize), number(SIDE as usize));
            Rect::from_min_size(at, Vec2::new(number(30), number(30)))
        }

        fn panel(&mut self) -> ClippedPrimitive {
            let (rect, clip) = (self.rect(), self.rect().expand(self.below(90) as f32));
            panel(clip, rect, Color32::from_gray(1 + self.below(254) as u8))
        }
    }

    fn panel(clip_rect: Rect, rect: Rect, colour: Color32) -> ClippedPrimitive {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(rect, colour);
        ClippedPrimitive { clip_rect, primitive: Primitive::Mesh(mesh) }
    }

    /// Paints each rectangle over the ones before, in a part of a picture.
    fn paint(picture: &mut [Color32], panels: &[ClippedPrimitive], part: PixelArea) {
        for (at, pixel) in picture.iter_mut().enumerate() {
            let at = [at as u32 % SIDE, at as u32 / SIDE];
            if part.intersection(PixelArea { at, size: [1, 1] }).is_none() {
                continue;
            }
            let point = Pos2::new(at[0] as f32 + 0.5, at[1] as f32 + 0.5);
            *pixel = Color32::BLACK;
            for ClippedPrimitive { clip_rect, primitive } in panels {
                if let Primitive::Mesh(mesh) = primitive
                    && clip_rect.contains(point)
                    && mesh.calc_bounds().contains(point)
                {
                    *pixel = mesh.vertices[0].color;
                }
            }
        }
    }

    fn change(random: &mut Random, panels: &mut Vec<ClippedPrimitive>) {
        let at = random.below(panels.len() + 1);
        match random.below(4) {
            0 => panels.insert(at, random.panel()),
            1 if at < panels.len() => drop(panels.remove(at)),
            2 if at < panels.len() => panels[at] = random.panel(),
            3 if at + 1 < panels.len() => panels.swap(at, at + 1),
            _ => {}
        }
    }

    #[test]
    fn redrawing_the_changed_areas_gives_the_whole_picture() {
        let all = PixelArea { at: [0, 0], size: [SIDE, SIDE] };
        let mut random = Random(5);
        for _ in 0..30 {
            let mut panels: Vec<_> = (0..random.below(60)).map(|_| random.panel()).collect();
            let mut changes = PanelChanges::default();
            let mut kept = vec![Color32::BLACK; (SIDE * SIDE) as usize];
            for _ in 0..12 {
                let drawn = (random.below(2) == 0)
                    .then(|| PixelArea::touched(random.rect().expand(20.0), &SCREEN))
                    .flatten();
                for area in changes.replace(&panels, &SCREEN, drawn).into_iter().chain(drawn) {
                    paint(&mut kept, &panels, area);
                }
                let mut whole = vec![Color32::BLACK; (SIDE * SIDE) as usize];
                paint(&mut whole, &panels, all);
                assert!(kept == whole);
                (0..random.below(5)).for_each(|_| change(&mut random, &mut panels));
            }
        }
    }

    #[test]
    fn areas_are_few_and_cover_all_tiles() {
        let mut random = Random(6);
        for count in [0, 1, 5, 20, 99, 150] {
            let tiles = (0..count).map(|_| [0, 1].map(|_| random.below(30) as u32));
            let tiles: Vec<_> = tiles.map(|at| at.map(|at| at..at + 1)).collect();
            let mut rects = Vec::new();
            tiles.iter().for_each(|tile| add(&mut rects, tile.clone()));
            assert!(rects.len() <= MAX_AREAS && (count == 0) == rects.is_empty());
            for tile in &tiles {
                assert!(rects.iter().any(|rect| union(rect, tile) == *rect), "{tile:?}");
            }
        }
    }

    #[test]
    fn changes_far_from_each_other_have_areas_of_their_own() {
        let background = panel(Rect::EVERYTHING, Rect::EVERYTHING, Color32::GRAY);
        let dot = |x: f32, y: f32, colour: Color32| {
            let rect = Rect::from_min_size(Pos2::new(x, y), Vec2::splat(4.0));
            panel(Rect::EVERYTHING, rect, colour)
        };
        let dots = |colour: Color32| {
            [background.clone(), dot(12.0, 14.0, colour), dot(129.0, 110.0, colour)]
        };
        let mut changes = PanelChanges::default();
        changes.replace(&dots(Color32::RED), &SCREEN, None);
        assert_eq!(changes.replace(&dots(Color32::RED), &SCREEN, None), []);
        let mut areas = changes.replace(&dots(Color32::BLUE), &SCREEN, None);
        areas.sort_by_key(|area| area.at);
        let first = PixelArea { at: [0, 0], size: [32, 32] };
        // At the edge of the window.
        let second = PixelArea { at: [128, 96], size: [2, 32] };
        assert_eq!(areas, [first, second]);
        let areas = changes.replace(&dots(Color32::RED), &SCREEN, Some(first));
        assert_eq!(areas, [second]);
    }
}
