use glam::{DVec3, Vec3};

use super::round_cone::{RoundCone, Sighting};
use crate::spline::{Interpolation, Knot, Spline};

/// A sphere of a [`Blob`](super::Blob).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlobSphere {
    /// Centre in the joint's own space.
    pub centre: Vec3,
    /// Radius in skeleton units.
    pub radius: f32,
}

/// What a sphere passes through that moves along a line while its radius changes: round cones in a
/// row, each from the last sphere of the one before. A bone is one round cone.
#[derive(Clone, Debug)]
pub struct Sweep {
    cones: Vec<RoundCone>,
}

impl Sweep {
    /// Number of round cones between two spheres of a curve.
    const STEPS: u8 = 6;

    /// One round cone.
    pub fn straight(base: DVec3, tip: DVec3, base_radius: f64, tip_radius: f64) -> Self {
        Self { cones: vec![RoundCone::new(base, tip, base_radius, tip_radius)] }
    }

    /// A sweep along the Catmull–Rom spline through the centres of some spheres, at least one. No
    /// radius is outside those of the two spheres around it.
    pub fn through(spheres: &[BlobSphere]) -> Self {
        let Some((first, last)) = spheres.first().zip(spheres.last()) else {
            return Self { cones: Vec::new() };
        };
        if spheres.len() <= 2 {
            let [base, tip] = [first, last].map(|sphere| sphere.centre.as_dvec3());
            return Self::straight(base, tip, first.radius.into(), last.radius.into());
        }
        let times = distances_along(spheres);
        let centres: Spline<_> =
            times.iter().zip(spheres).map(|(time, it)| Knot::new(*time, it.centre)).collect();
        let radius = |(time, it): (&f64, &BlobSphere)| Knot {
            interpolation: Interpolation::Auto,
            ..Knot::new(*time, it.radius)
        };
        let radii: Spline<_> = times.iter().zip(spheres).map(radius).collect();
        let between = |span: &[f64]| {
            let [from, to] = [span[0], span[1]];
            (1..=Self::STEPS)
                .map(move |step| from + (to - from) * f64::from(step) / f64::from(Self::STEPS))
        };
        let stops = core::iter::once(0.0).chain(times.windows(2).flat_map(between));
        let stops: Vec<(DVec3, f64)> = stops
            .filter_map(|time| Some((centres.at(time)?.as_dvec3(), radii.at(time)?.into())))
            .collect();
        let cone = |ends: &[(DVec3, f64)]| {
            let [(base, base_radius), (tip, tip_radius)] = [ends[0], ends[1]];
            RoundCone::new(base, tip, base_radius, tip_radius)
        };
        Self { cones: stops.windows(2).map(cone).collect() }
    }

    /// The sweep with all radii at least this large.
    pub fn thickened(&self, radius: f64) -> Self {
        Self { cones: self.cones.iter().map(|cone| cone.thickened(radius)).collect() }
    }

    /// The round cones that may be the nearest one for a point at most `radius` away from a point.
    pub fn near(&self, point: DVec3, radius: f64) -> Self {
        let most = self.distance(point) + 2.0 * radius;
        let near = self.cones.iter().filter(|cone| cone.distance(point) <= most);
        Self { cones: near.copied().collect() }
    }

    /// Signed distance from a point: the least over all spheres of the sweep.
    pub fn distance(&self, point: DVec3) -> f64 {
        self.cones.iter().map(|cone| cone.distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// The sweep from a point.
    pub fn sighting(&self, point: DVec3) -> Sighting {
        self.cones.iter().map(|cone| cone.sighting(point)).fold(Sighting::NONE, Sighting::nearer)
    }

    /// Centre and radius of the first sphere.
    pub fn start(&self) -> (DVec3, f64) {
        self.cones.first().map_or((DVec3::ZERO, 0.0), RoundCone::start)
    }

    /// Centre and radius of the last sphere.
    pub fn end(&self) -> (DVec3, f64) {
        self.cones.last().map_or((DVec3::ZERO, 0.0), RoundCone::end)
    }

    /// Unit vector along the sweep at its start; zero for a sphere.
    pub fn direction(&self) -> DVec3 {
        self.cones.first().map_or(DVec3::ZERO, RoundCone::direction)
    }

    /// Lowest and highest corner of a box around the sweep.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let boxes = self.cones.iter().map(|cone| {
            let (centre, radius) = cone.bounds();
            (centre - radius, centre + radius)
        });
        boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
    }

    /// About the area of the surface.
    pub fn area(&self) -> f64 {
        let sides: f64 = self.cones.iter().map(RoundCone::side).sum();
        let [start, end] = [self.start(), self.end()].map(|(_, radius)| radius);
        sides + 2.0 * core::f64::consts::PI * (start * start + end * end)
    }

    /// Mean radius over the surface.
    pub fn mean_radius(&self) -> f64 {
        let sides = self.cones.iter().map(|cone| (cone.side(), cone.side() * cone.mean_radius()));
        let (area, sum) = sides.fold((0.0, 0.0), |(area, sum), it| (area + it.0, sum + it.1));
        if area > 0.0 { sum / area } else { self.start().1 }
    }

    /// Least radius of all spheres.
    pub fn least_radius(&self) -> f64 {
        self.cones.iter().map(RoundCone::least_radius).fold(f64::INFINITY, f64::min)
    }
}

/// Distances of the centres from the first one, along straight lines from each to the next. No two
/// are the same, even where centres are.
fn distances_along(spheres: &[BlobSphere]) -> Vec<f64> {
    let step = |pair: &[BlobSphere]| {
        let [one, other] = [&pair[0], &pair[1]];
        f64::from(one.centre.distance(other.centre)).max(1e-3 * f64::from(one.radius))
    };
    let mut along = 0.0;
    let further = spheres.windows(2).map(|pair| {
        along += step(pair);
        along
    });
    core::iter::once(0.0).chain(further.collect::<Vec<_>>()).collect()
}
