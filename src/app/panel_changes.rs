use egui::Rect;
use egui::epaint::ClippedShape;

/// Maximum number of rectangles of changes. Each costs a pass over the panels.
const MOST: usize = 6;

/// Number of rectangles from which on they are not merged one by one, but at once.
const MANY: usize = 100;

/// Distance in points by which a shape's soft edges extend beyond its rectangle.
const SOFT_EDGE: f32 = 2.0;

/// Finds the parts of the window where the panels differ from the frame before.
#[derive(Default)]
pub(super) struct PanelChanges {
    shapes: Vec<ClippedShape>,
}

impl PanelChanges {
    /// Rectangles in points that contain all differences from the previous shapes, which are then
    /// replaced.
    pub fn replace(&mut self, shapes: &[ClippedShape]) -> Vec<Rect> {
        let before = &self.shapes[..];
        let start = before.iter().zip(shapes).take_while(|(a, b)| a == b).count();
        let (before, now) = (&before[start..], &shapes[start..]);
        let end = before.iter().rev().zip(now.iter().rev()).take_while(|(a, b)| a == b).count();
        let (before, now) = (&before[..before.len() - end], &now[..now.len() - end]);
        let mut rects = Vec::new();
        for index in 0..before.len().max(now.len()) {
            let (before, now) = (before.get(index), now.get(index));
            if before != now {
                rects.extend(before.into_iter().chain(now).map(bounds).filter(Rect::is_positive));
            }
        }
        shapes.clone_into(&mut self.shapes);
        merged(rects)
    }
}

fn bounds(shape: &ClippedShape) -> Rect {
    let rect = shape.transform_after_tessellation * shape.shape.visual_bounding_rect();
    rect.expand(SOFT_EDGE).intersect(shape.clip_rect)
}

/// At most [`MOST`] rectangles that contain all of `rects` and do not intersect.
fn merged(rects: Vec<Rect>) -> Vec<Rect> {
    if rects.len() > MANY {
        return vec![rects.into_iter().fold(Rect::NOTHING, Rect::union)];
    }
    let mut disjoint: Vec<Rect> = Vec::new();
    for rect in rects {
        add(&mut disjoint, rect);
    }
    while disjoint.len() > MOST {
        let pairs = (0..disjoint.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let waste = |(a, b): &(usize, usize)| {
            let (a, b) = (disjoint[*a], disjoint[*b]);
            a.union(b).area() - a.area() - b.area()
        };
        let nearest = pairs.min_by(|a, b| waste(a).total_cmp(&waste(b)));
        let Some((a, b)) = nearest else { break };
        let (a, b) = (disjoint.swap_remove(a), disjoint.swap_remove(b));
        add(&mut disjoint, a.union(b));
    }
    disjoint
}

/// Adds a rectangle, united with those that it intersects.
fn add(disjoint: &mut Vec<Rect>, mut rect: Rect) {
    while let Some(index) = disjoint.iter().position(|other| other.intersects(rect)) {
        rect = rect.union(disjoint.swap_remove(index));
    }
    disjoint.push(rect);
}

#[cfg(test)]
mod tests {
    use egui::{Color32, Pos2, Shape, Vec2};

    use super::*;

    const SIDE: usize = 40;

    /// Numbers below a bound, the same on every run.
    struct Random(u64);

    impl Random {
        fn below(&mut self, bound: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 33) as usize % bound
        }

        fn rect(&mut self) -> Rect {
            let mut number = |bound: usize| self.below(bound) as f32;
            let at = Pos2::new(number(SIDE), number(SIDE));
            Rect::from_min_size(at, Vec2::new(number(9), number(9)))
        }

        fn shape(&mut self) -> ClippedShape {
            let (rect, clip) = (self.rect(), self.rect().expand(self.below(30) as f32));
            let colour = Color32::from_gray(1 + self.below(254) as u8);
            clipped(clip, Shape::rect_filled(rect, 0.0, colour))
        }
    }

    fn clipped(clip_rect: Rect, shape: Shape) -> ClippedShape {
        ClippedShape::new(clip_rect, shape)
    }

    /// Paints each shape over the ones before, in a part of a picture.
    fn paint(picture: &mut [Color32], shapes: &[ClippedShape], part: Rect) {
        for (at, pixel) in picture.iter_mut().enumerate() {
            let point = Pos2::new((at % SIDE) as f32 + 0.5, (at / SIDE) as f32 + 0.5);
            if !part.contains(point) {
                continue;
            }
            *pixel = Color32::BLACK;
            for ClippedShape { clip_rect, shape, .. } in shapes {
                if let Shape::Rect(rect) = shape
                    && clip_rect.contains(point)
                    && rect.rect.contains(point)
                {
                    *pixel = rect.fill;
                }
            }
        }
    }

    fn change(random: &mut Random, shapes: &mut Vec<ClippedShape>) {
        let at = random.below(shapes.len() + 1);
        match random.below(4) {
            0 => shapes.insert(at, random.shape()),
            1 if at < shapes.len() => drop(shapes.remove(at)),
            2 if at < shapes.len() => shapes[at] = random.shape(),
            3 if at + 1 < shapes.len() => shapes.swap(at, at + 1),
            _ => {}
        }
    }

    #[test]
    fn redrawing_the_changed_rectangles_gives_the_whole_picture() {
        let mut random = Random(5);
        for _ in 0..60 {
            let mut shapes: Vec<_> = (0..random.below(60)).map(|_| random.shape()).collect();
            let mut changes = PanelChanges::default();
            let mut kept = vec![Color32::BLACK; SIDE * SIDE];
            for _ in 0..12 {
                for rect in changes.replace(&shapes) {
                    paint(&mut kept, &shapes, rect);
                }
                let mut whole = vec![Color32::BLACK; SIDE * SIDE];
                paint(&mut whole, &shapes, Rect::EVERYTHING);
                assert!(kept == whole);
                (0..random.below(5)).for_each(|_| change(&mut random, &mut shapes));
            }
        }
    }

    #[test]
    fn rectangles_are_few_and_disjoint_and_contain_all_changes() {
        let mut random = Random(6);
        for count in [0, 1, 5, 20, 99, 150] {
            let rects: Vec<_> = (0..count).map(|_| random.rect()).collect();
            let merged = merged(rects.clone());
            assert!(merged.len() <= MOST && (count == 0) == merged.is_empty());
            for rect in &rects {
                assert!(merged.iter().any(|other| other.contains_rect(*rect)), "{rect}");
            }
            for (at, a) in merged.iter().enumerate() {
                assert!(merged[..at].iter().all(|b| !a.intersects(*b)));
            }
        }
    }

    #[test]
    fn a_small_change_has_a_small_rectangle() {
        let mut shapes: Vec<_> = {
            let mut random = Random(7);
            (0..500).map(|_| random.shape()).collect()
        };
        let mut changes = PanelChanges::default();
        changes.replace(&shapes);
        assert_eq!(changes.replace(&shapes), []);
        let rect = Rect::from_min_size(Pos2::new(3.0, 4.0), Vec2::splat(5.0));
        let shape = Shape::rect_filled(rect, 0.0, Color32::RED);
        shapes[250] = clipped(Rect::EVERYTHING, Shape::Noop);
        changes.replace(&shapes);
        shapes[250] = clipped(Rect::EVERYTHING, shape);
        assert_eq!(changes.replace(&shapes), [rect.expand(SOFT_EDGE)]);
    }
}
