//! The signed distance of a body, near a box.

use glam::DVec3;

use super::body::{Blend, Body, Part};
use super::round_cone::Sighting;

/// The parts of a body that shape its surface near a box, so that the distance costs as much as there are
/// parts nearby. Equal to the field of all parts inside the box, bit for bit.
#[derive(Clone, Debug)]
pub struct Field<'a> {
    body: &'a Body,
    /// Indices of the parts in the body.
    parts: Vec<usize>,
    /// Blends of parts, by their indices in `parts`.
    blends: Vec<Blend>,
}

/// Memory for intermediate results of a [`Field`].
#[derive(Debug, Default)]
pub struct FieldScratch {
    distances: Vec<f64>,
    sightings: Vec<Sighting>,
}

impl<'a> Field<'a> {
    /// The field of all parts.
    pub fn new(body: &'a Body) -> Self {
        Self { body, parts: (0..body.parts.len()).collect(), blends: body.blends.clone() }
    }

    /// The field for points at most `radius` away from a point, which must be in the range of this field.
    pub fn near(&self, point: DVec3, radius: f64) -> Self {
        let distances: Vec<f64> = self.all().map(|part| part.cone.distance(point)).collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        // Each distance changes by at most `radius` on the way, and rounding by much less than that.
        let reach = 2.02 * radius;
        let is_near = |blend: &&Blend| {
            let (first, second) = (distances[blend.first], distances[blend.second]);
            first.min(second) <= least + reach + blend.width
                && (first - second).abs() <= reach + blend.width
        };
        let blends: Vec<&Blend> = self.blends.iter().filter(is_near).collect();
        let mut is_kept: Vec<bool> =
            distances.iter().map(|distance| *distance <= least + reach).collect();
        for blend in &blends {
            (is_kept[blend.first], is_kept[blend.second]) = (true, true);
        }
        let mut index = vec![0; self.parts.len()];
        let mut parts = Vec::new();
        for (old, part) in self.parts.iter().enumerate().filter(|(old, _)| is_kept[*old]) {
            index[old] = parts.len();
            parts.push(*part);
        }
        let reindexed = |blend: &Blend| Blend {
            first: index[blend.first],
            second: index[blend.second],
            ..*blend
        };
        Self { body: self.body, parts, blends: blends.into_iter().map(reindexed).collect() }
    }

    /// Indices of the parts, in the order of the body.
    pub fn parts(&self) -> &[usize] {
        &self.parts
    }

    /// Signed distance: the least over all parts and all blends. It changes by no more than the way.
    pub fn distance(&self, point: DVec3, scratch: &mut FieldScratch) -> f64 {
        let distances = &mut scratch.distances;
        distances.clear();
        distances.extend(self.all().map(|part| part.cone.distance(point)));
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let blended = |blend: &Blend| {
            smooth_minimum(distances[blend.first], distances[blend.second], blend.width).0
        };
        self.blends.iter().map(blended).fold(least, f64::min)
    }

    /// Distance, gradient (at most 1 long) and local radius.
    pub fn sighting(&self, point: DVec3, scratch: &mut FieldScratch) -> Sighting {
        let sightings = &mut scratch.sightings;
        sightings.clear();
        sightings.extend(self.all().map(|part| part.cone.sighting(point)));
        let nearest = sightings.iter().copied().fold(Sighting::NONE, Sighting::nearer);
        let blended = |blend: &Blend| {
            let (first, second) = (&sightings[blend.first], &sightings[blend.second]);
            let (distance, share) = smooth_minimum(first.distance, second.distance, blend.width);
            Sighting {
                distance,
                gradient: first.gradient.lerp(second.gradient, share),
                radius: first.radius.min(second.radius),
            }
        };
        self.blends.iter().map(blended).fold(nearest, Sighting::nearer)
    }

    fn all(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().map(|part| &self.body.parts[*part])
    }
}

/// The quadratic smooth minimum: min(a, b) where they differ by more than `width`, and at most
/// `width`/4 below it; with the share of b in its gradient.
fn smooth_minimum(a: f64, b: f64, width: f64) -> (f64, f64) {
    let overlap = (width - (a - b).abs()).max(0.0) / width;
    let value = a.min(b) - 0.25 * width * overlap * overlap;
    (value, if a <= b { 0.5 * overlap } else { 1.0 - 0.5 * overlap })
}
