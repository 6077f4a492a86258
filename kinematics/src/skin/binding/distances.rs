//! Distances of the points of a surface from bones, inside the body.
//!
//! A bone *sees* a point if no triangle is between them; its distance is then the length of the straight
//! line. To points that it does not see, distances go on along the edges of the mesh. So the way from
//! the bone of a finger to the next finger leads through the palm.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::Vec3;

use super::triangle_tree::TriangleTree;
use super::welded::WeldedMesh;
use crate::skin::from_bones::{REACH, map_ranges};

/// A bone in the space of the mesh.
#[derive(Clone, Copy)]
pub struct BoneSegment {
    pub base: Vec3,
    pub tip: Vec3,
}

impl BoneSegment {
    /// The point at a fraction of the bone.
    fn at(&self, fraction: f32) -> Vec3 {
        self.base.lerp(self.tip, fraction)
    }

    /// Fraction of the bone's point that is nearest to a point.
    fn nearest(&self, point: Vec3) -> f32 {
        let along = self.tip - self.base;
        let fraction = (point - self.base).dot(along) / along.length_squared();
        if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Distance from a point on the bone to a point. Behind its base a bone counts as farther away,
    /// so that where many bones start at one point the surface behind them follows the bone that
    /// they start from.
    fn distance(&self, from: Vec3, to: Vec3) -> f32 {
        let direction = (self.tip - self.base).normalize_or_zero();
        from.distance(to) + 0.5 * (self.base - to).dot(direction).max(0.0)
    }
}

/// The distances of all points of a mesh from the bones that are near to them.
pub struct InsideDistances {
    /// For each point the distances from the bones that are nearest, at least one.
    near: Vec<Vec<(usize, f32)>>,
    /// For each point the radius of the body.
    radii: Vec<f32>,
}

impl InsideDistances {
    pub fn new(mesh: &WeldedMesh, bones: &[BoneSegment]) -> Self {
        let sight = Sight::new(mesh, bones);
        let count = mesh.points.len();
        let seen = map_ranges(count, |range| range.map(|it| sight.nearest_seen(it)).collect());
        let mut nearest = SurfaceDistances::new(mesh, |point: usize| seen[point]);
        nearest.spread(f32::INFINITY, |_| 0.0);
        let least = nearest.distances;
        let reach = REACH as f32 * greatest_radius(&least);
        let all_seen = map_ranges(count, |range| {
            range.map(|point| sight.all_seen(point, least[point] + reach)).collect()
        });
        let mut near: Vec<Vec<(usize, f32)>> = vec![Vec::new(); count];
        for bone in 0..bones.len() {
            let of_bone = |point: usize| {
                let seen = all_seen[point].iter().find(|(it, _): &&(usize, f32)| *it == bone);
                seen.map_or(f32::INFINITY, |(_, distance)| *distance)
            };
            let mut distances = SurfaceDistances::new(mesh, of_bone);
            // On the way to the bone, its distance shrinks at least as fast as that of the nearest.
            distances.spread(reach, |point| least[point]);
            for (point, distance) in distances.distances.iter().enumerate() {
                if distance.is_finite() {
                    near[point].push((bone, *distance));
                }
            }
        }
        let mut distances = Self { radii: radii(&near, bones.len()), near };
        distances.fill_unreached(&sight);
        distances
    }

    /// The radius of the body at a point, and the distances of the point from bones near to it.
    pub fn at(&self, point: usize) -> (f32, &[(usize, f32)]) {
        (self.radii[point], &self.near[point])
    }

    /// Gives points that no bone reaches the distances of the nearest point that one reaches; if
    /// there is none, all points the straight distances.
    fn fill_unreached(&mut self, sight: &Sight<'_>) {
        let points = &sight.mesh.points;
        let (mut reached, unreached): (Vec<usize>, Vec<usize>) =
            (0..points.len()).partition(|point| !self.near[*point].is_empty());
        if reached.is_empty() {
            self.near = (0..points.len()).map(|point| sight.straight(point).collect()).collect();
            self.radii = radii(&self.near, sight.bones.len());
            return;
        }
        reached.sort_unstable_by(|one, other| points[*one].x.total_cmp(&points[*other].x));
        for point in unreached {
            let nearest = nearest_by_x(points, &reached, points[point]);
            self.near[point] = self.near[nearest].clone();
            self.radii[point] = self.radii[nearest];
        }
    }
}

/// The point nearest to a place, of those with the indices `sorted` by x; at least one.
fn nearest_by_x(points: &[Vec3], sorted: &[usize], place: Vec3) -> usize {
    let from = sorted.partition_point(|point| points[*point].x < place.x);
    let mut nearest = (f32::INFINITY, sorted[from.min(sorted.len() - 1)]);
    let mut visit = |point: &usize| {
        let apart = points[*point] - place;
        if apart.length_squared() < nearest.0 {
            nearest = (apart.length_squared(), *point);
        }
        apart.x * apart.x < nearest.0
    };
    // Until no farther point can be nearer.
    let _ = sorted[from..].iter().all(&mut visit);
    let _ = sorted[..from].iter().rev().all(&mut visit);
    nearest.1
}

/// The greatest distance from the nearest bone, but for the most distant fiftieth of all points: so that
/// a few that are far away do not make all points look for bones far away.
fn greatest_radius(least: &[f32]) -> f32 {
    let mut finite: Vec<f32> = least.iter().copied().filter(|it| it.is_finite()).collect();
    let most = finite.len() - finite.len() / 50;
    let Some(last) = most.checked_sub(1) else { return 0.0 };
    *finite.select_nth_unstable_by(last, f32::total_cmp).1
}

/// For each point the radius of the body there: the distance from the nearest bone, but not less than
/// half the mean of all points that are nearest to that bone.
fn radii(near: &[Vec<(usize, f32)>], bones: usize) -> Vec<f32> {
    let nearest = |near: &Vec<(usize, f32)>| {
        near.iter().copied().min_by(|one, other| one.1.total_cmp(&other.1))
    };
    let mut sums = vec![(0.0_f64, 0_usize); bones];
    for (bone, distance) in near.iter().filter_map(nearest) {
        sums[bone].0 += f64::from(distance);
        sums[bone].1 += 1;
    }
    let radius = |near: &Vec<(usize, f32)>| {
        let (bone, distance) = nearest(near)?;
        let (sum, count) = sums[bone];
        Some(distance.max((0.5 * sum / count as f64) as f32))
    };
    near.iter().map(|near| radius(near).unwrap_or_default()).collect()
}

/// What bones see of a mesh.
struct Sight<'a> {
    mesh: &'a WeldedMesh,
    bones: &'a [BoneSegment],
    tree: TriangleTree,
}

impl<'a> Sight<'a> {
    fn new(mesh: &'a WeldedMesh, bones: &'a [BoneSegment]) -> Self {
        let corner = |point: u32| mesh.points[point as usize];
        let triangles = mesh.triangles.iter().map(|corners| corners.map(corner)).collect();
        Self { mesh, bones, tree: TriangleTree::new(triangles) }
    }

    /// Distance of a point from the nearest bone that sees it, of those that are nearest; infinite if
    /// none does.
    fn nearest_seen(&self, point: usize) -> f32 {
        /// Maximum number of bones that are tried. Bounds the time for points within other surfaces,
        /// which no bone sees.
        const MOST: usize = 12;
        let mut bones: Vec<(usize, f32)> = self.straight(point).collect();
        bones.sort_unstable_by(|one, other| one.1.total_cmp(&other.1));
        let mut least = f32::INFINITY;
        for (bone, straight) in bones.into_iter().take(MOST) {
            if straight >= least {
                break;
            }
            least = least.min(self.seen(bone, point).unwrap_or(f32::INFINITY));
        }
        least
    }

    /// The bones that see a point and are not farther away than `reach`, with their distances; none if
    /// `reach` is infinite, which is that of a point that no bone reaches.
    fn all_seen(&self, point: usize, reach: f32) -> Vec<(usize, f32)> {
        if !reach.is_finite() {
            return Vec::new();
        }
        let near = self.straight(point).filter(|(_, straight)| *straight <= reach);
        near.filter_map(|(bone, _)| Some((bone, self.seen(bone, point)?))).collect()
    }

    /// All bones with their distances from a point, whether they see it or not.
    fn straight(&self, point: usize) -> impl Iterator<Item = (usize, f32)> {
        let point = self.mesh.points[point];
        let distance = move |bone: &BoneSegment| bone.distance(bone.at(bone.nearest(point)), point);
        self.bones.iter().map(distance).enumerate()
    }

    /// Distance of a point from a bone that sees it: from the bone's nearest point, or if that does
    /// not see the point, from one of some others.
    fn seen(&self, bone: usize, point: usize) -> Option<f32> {
        const OTHERS: [f32; 3] = [0.05, 0.5, 0.95];
        let (bone, to) = (self.bones[bone], self.mesh.points[point]);
        let distance = |fraction: f32| {
            let from = bone.at(fraction);
            self.is_free(from, point).then(|| bone.distance(from, to))
        };
        let others = || OTHERS.into_iter().filter_map(distance).min_by(f32::total_cmp);
        distance(bone.nearest(to)).or_else(others)
    }

    /// True if no triangle is between a place and a point of the mesh.
    fn is_free(&self, from: Vec3, point: usize) -> bool {
        let is_apart = |triangle: usize| !self.mesh.triangles[triangle].contains(&(point as u32));
        !self.tree.is_between([from, self.mesh.points[point]], is_apart)
    }
}

/// Distances of the points of a mesh from a bone, some of which are known.
struct SurfaceDistances<'a> {
    mesh: &'a WeldedMesh,
    distances: Vec<f32>,
}

impl<'a> SurfaceDistances<'a> {
    fn new(mesh: &'a WeldedMesh, known: impl Fn(usize) -> f32) -> Self {
        Self { mesh, distances: (0..mesh.points.len()).map(known).collect() }
    }

    /// Goes on from the known distances along edges (Dijkstra 1959), as far as distances are greater
    /// than `least` by at most `reach`; greater ones become infinite.
    fn spread(&mut self, reach: f32, least: impl Fn(usize) -> f32) {
        let is_far = |distance: f32, point: usize| distance - least(point) > reach;
        let mut queue = BinaryHeap::new();
        for (point, distance) in self.distances.iter_mut().enumerate() {
            if !distance.is_finite() || is_far(*distance, point) {
                *distance = f32::INFINITY;
            } else {
                queue.push(Reached { distance: *distance, point });
            }
        }
        while let Some(Reached { distance, point }) = queue.pop() {
            if distance > self.distances[point] {
                continue;
            }
            for next in self.mesh.neighbours(point).iter().map(|next| *next as usize) {
                let length = self.mesh.points[point].distance(self.mesh.points[next]);
                let distance = distance + length;
                if distance < self.distances[next] && !is_far(distance, next) {
                    self.distances[next] = distance;
                    queue.push(Reached { distance, point: next });
                }
            }
        }
    }
}

/// A point that is reached; the nearest one is the greatest.
struct Reached {
    distance: f32,
    point: usize,
}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then(other.point.cmp(&self.point))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Reached {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Reached {}
