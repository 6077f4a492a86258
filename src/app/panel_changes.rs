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
    shape.shape.visual_bounding_rect().expand(SOFT_EDGE).intersect(shape.clip_rect)
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
