use glam::{DVec3, Vec3};

/// Triangles in a tree of boxes, to find quickly whether one is between two places.
pub struct TriangleTree {
    /// Corners of the triangles, in the order of the leaves.
    triangles: Vec<[Vec3; 3]>,
    /// Index of each triangle in the list from which the tree was made.
    indices: Vec<u32>,
    /// The root first, parents before their children.
    boxes: Vec<TreeBox>,
}

/// A box around triangles.
struct TreeBox {
    low: Vec3,
    high: Vec3,
    content: BoxContent,
}

enum BoxContent {
    /// Indices of the first triangle and of the one after the last.
    Triangles(usize, usize),
    /// Index of the second of two boxes; the first one follows this box.
    Boxes(usize),
}

impl TriangleTree {
    pub fn new(triangles: Vec<[Vec3; 3]>) -> Self {
        let mut indices: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut boxes = Vec::new();
        if !triangles.is_empty() {
            split(&triangles, &mut indices, 0, &mut boxes);
        }
        let sorted = indices.iter().map(|index| triangles[*index as usize]).collect();
        Self { triangles: sorted, indices, boxes }
    }

    /// True if a triangle for which `counts` is true is between two places.
    pub fn is_between(&self, [from, to]: [Vec3; 2], counts: impl Fn(usize) -> bool) -> bool {
        let mut open = vec![0];
        while let Some(index) = open.pop() {
            let Some(tree_box) = self.boxes.get(index) else { continue };
            if !tree_box.is_met(from, to) {
                continue;
            }
            match tree_box.content {
                BoxContent::Boxes(second) => open.extend([index + 1, second]),
                BoxContent::Triangles(start, end) => {
                    let mut triangles =
                        (start..end).filter(|at| counts(self.indices[*at] as usize));
                    if triangles.any(|at| meets(from, to, &self.triangles[at])) {
                        return true;
                    }
                }
            }
        }
        false
    }
}

/// Adds the boxes of triangles with these indices, of which the first is at `start` in the order of
/// the leaves. Sorts the triangles by their middles along the longest side of the box around these,
/// and cuts them into halves there.
fn split(triangles: &[[Vec3; 3]], indices: &mut [u32], start: usize, boxes: &mut Vec<TreeBox>) {
    const MOST: usize = 4;
    let corners = indices.iter().flat_map(|index| triangles[*index as usize]);
    let (low, high) = corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), corner| {
        (low.min(corner), high.max(corner))
    });
    let content = BoxContent::Triangles(start, start + indices.len());
    let index = boxes.len();
    boxes.push(TreeBox { low, high, content });
    if indices.len() <= MOST {
        return;
    }
    let axis = (high - low).max_position();
    let middle = |index: &u32| triangles[*index as usize].iter().map(|it| it[axis]).sum::<f32>();
    let half = indices.len() / 2;
    indices.select_nth_unstable_by(half, |one, other| middle(one).total_cmp(&middle(other)));
    let (first, second) = indices.split_at_mut(half);
    split(triangles, first, start, boxes);
    boxes[index].content = BoxContent::Boxes(boxes.len());
    split(triangles, second, start + half, boxes);
}

impl TreeBox {
    /// True if the straight way between two places meets the box.
    fn is_met(&self, from: Vec3, to: Vec3) -> bool {
        let by = (to - from).recip();
        let (one, other) = ((self.low - from) * by, (self.high - from) * by);
        // Of a way in the plane of a side, NaN: it may meet.
        let enters = one.min(other).to_array().into_iter().fold(0.0, f32::max);
        let leaves = one.max(other).to_array().into_iter().fold(1.0, f32::min);
        enters <= leaves * (1.0 + 1e-5)
    }
}

/// True if the straight way between two places meets a triangle, or passes by its edge so near that
/// rounding decides: so no way slips through between two triangles.
fn meets(from: Vec3, to: Vec3, corners: &[Vec3; 3]) -> bool {
    const ROUNDING: f64 = 1e-6;
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (origin, direction): (DVec3, DVec3) = (from.as_dvec3(), (to - from).as_dvec3());
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant == 0.0 {
        return false;
    }
    let from_a = origin - a;
    let around = from_a.cross(ab);
    let of_b = from_a.dot(across) / determinant;
    let of_c = direction.dot(around) / determinant;
    let along = ac.dot(around) / determinant;
    let is_inside = of_b >= -ROUNDING && of_c >= -ROUNDING && of_b + of_c <= 1.0 + ROUNDING;
    is_inside && (0.0..1.0).contains(&along)
}
