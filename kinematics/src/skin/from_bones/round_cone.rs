use glam::DVec3;

/// The convex hull of two spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundCone {
    base: DVec3,
    tip: DVec3,
    base_radius: f64,
    tip_radius: f64,
    axis: Axis,
}

/// The axis of a round cone, prepared for many points.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    /// Unit vector from base to tip.
    direction: DVec3,
    length: f64,
    /// Sine of the angle between the axis and the side.
    slope: f64,
    /// Tangent of that angle.
    tangent: f64,
}

/// A round cone seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Signed distance to the surface, below 0 inside.
    pub distance: f64,
    /// Unit gradient of the distance; on the axis of the cone, any unit vector across it.
    pub gradient: DVec3,
    /// Radius of the sphere, of those between the two ends, that is nearest.
    pub radius: f64,
}

impl Sighting {
    /// Nothing in sight.
    pub const NONE: Self = Self { distance: f64::INFINITY, gradient: DVec3::X, radius: 0.0 };

    /// The nearer of two.
    pub fn nearer(self, other: Self) -> Self {
        if other.distance < self.distance { other } else { self }
    }
}

impl RoundCone {
    pub fn new(base: DVec3, tip: DVec3, base_radius: f64, tip_radius: f64) -> Self {
        let length = base.distance(tip);
        let narrowing = base_radius - tip_radius;
        if narrowing.abs() >= length {
            // One sphere contains the other.
            let (centre, radius) =
                if narrowing >= 0.0 { (base, base_radius) } else { (tip, tip_radius) };
            return Self::sphere(centre, radius);
        }
        let slope = narrowing / length;
        let tangent = slope / (1.0 - slope * slope).sqrt();
        let axis = Axis { direction: (tip - base) / length, length, slope, tangent };
        Self { base, tip, base_radius, tip_radius, axis }
    }

    fn sphere(centre: DVec3, radius: f64) -> Self {
        let axis = Axis { direction: DVec3::ZERO, length: 0.0, slope: 0.0, tangent: 0.0 };
        Self { base: centre, tip: centre, base_radius: radius, tip_radius: radius, axis }
    }

    /// Centre and radius of the first sphere.
    pub fn start(&self) -> (DVec3, f64) {
        (self.base, self.base_radius)
    }

    /// Centre and radius of the second sphere.
    pub fn end(&self) -> (DVec3, f64) {
        (self.tip, self.tip_radius)
    }

    /// Unit vector from base to tip; zero for a sphere.
    pub fn direction(&self) -> DVec3 {
        self.axis.direction
    }

    /// The cone with both radii at least this large.
    pub fn thickened(&self, radius: f64) -> Self {
        Self::new(self.base, self.tip, self.base_radius.max(radius), self.tip_radius.max(radius))
    }

    /// Signed distance from a point: the least over all spheres between the two ends. Of the sphere
    /// at x along the axis, |p − c(x)| − r(x) has its minimum where the direction to the point is
    /// normal to the side.
    pub fn distance(&self, point: DVec3) -> f64 {
        let (centre, radius) = self.nearest_sphere(point);
        point.distance(centre) - radius
    }

    /// The round cone from a point.
    pub fn sighting(&self, point: DVec3) -> Sighting {
        let (centre, radius) = self.nearest_sphere(point);
        let out = point - centre;
        let across = || {
            let axis = self.axis.direction.try_normalize();
            axis.map_or(DVec3::X, |axis| axis.any_orthonormal_vector())
        };
        let gradient = out.try_normalize().unwrap_or_else(across);
        Sighting { distance: out.length() - radius, gradient, radius }
    }

    fn nearest_sphere(&self, point: DVec3) -> (DVec3, f64) {
        let Axis { direction, length, slope, tangent } = self.axis;
        let from_base = point - self.base;
        let height = from_base.dot(direction);
        let across = (from_base.length_squared() - height * height).max(0.0).sqrt();
        let foot = (height - across * tangent).clamp(0.0, length);
        (self.base + direction * foot, self.base_radius - slope * foot)
    }

    /// Centre and radius of a sphere around the round cone.
    pub fn bounds(&self) -> (DVec3, f64) {
        let radius = self.base_radius.max(self.tip_radius);
        (self.base.midpoint(self.tip), 0.5 * self.base.distance(self.tip) + radius)
    }

    /// About the area of the surface between the two ends.
    pub fn side(&self) -> f64 {
        core::f64::consts::PI * (self.base_radius + self.tip_radius) * self.base.distance(self.tip)
    }

    pub fn mean_radius(&self) -> f64 {
        0.5 * (self.base_radius + self.tip_radius)
    }

    pub fn least_radius(&self) -> f64 {
        self.base_radius.min(self.tip_radius)
    }
}
