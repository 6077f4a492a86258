use glam::{DVec3, Mat4, Vec2, Vec3};

/// Projection of a camera for the aspect ratio of a picture: maps points of the world into the
/// picture and back.
///
/// Picture coordinates are normalised: x from −1 (left) to 1 (right), y from −1 (bottom) to 1
/// (top).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Matrix from the world to clip space. Depth is 1 at the near plane, and 0 at infinity in
    /// perspective or at the far plane of an orthographic picture.
    pub clip_from_world: Mat4,
    /// Position of the eye in the world; for an orthographic picture a point on the central ray.
    pub eye: Vec3,
    /// Unit vector in the world from the eye into the picture.
    pub forward: Vec3,
    /// Vector in the world from the middle of the picture to its right edge. In perspective the
    /// edge is measured at distance 1 from the eye.
    pub right: Vec3,
    /// Vector in the world from the middle of the picture to its upper edge. In perspective the
    /// edge is measured at distance 1 from the eye.
    pub up: Vec3,
    /// True for an orthographic projection.
    pub orthographic: bool,
}

/// A ray in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start of the ray.
    pub origin: Vec3,
    /// Direction, of any length.
    pub direction: Vec3,
}

impl Projection {
    /// Projects a point of the world into the picture; `None` before the near plane.
    pub fn project(&self, point: Vec3) -> Option<Vec2> {
        let clip = self.clip_from_world * point.extend(1.0);
        (clip.w > 0.0 && clip.z <= clip.w).then(|| clip.truncate().truncate() / clip.w)
    }

    /// The ray in the world through a point of the picture.
    pub fn ray(&self, at: Vec2) -> Ray {
        let aside = self.right * at.x + self.up * at.y;
        if self.orthographic {
            Ray { origin: self.eye + aside, direction: self.forward }
        } else {
            Ray { origin: self.eye, direction: self.forward + aside }
        }
    }

    /// Half the height of the picture at the depth of a point, in units of the world.
    pub fn half_height_at(&self, point: Vec3) -> f32 {
        let span = self.up.length();
        if self.orthographic { span } else { span * (point - self.eye).dot(self.forward) }
    }
}

impl Ray {
    /// Intersection with the plane through `point` with the given normal, of any length. `None` if
    /// it is behind the origin, or overflows because the ray is nearly parallel to the plane.
    pub fn meets_plane(&self, point: Vec3, normal: Vec3) -> Option<Vec3> {
        let along = (point - self.origin).dot(normal) / self.direction.dot(normal);
        let met = self.origin + self.direction * along;
        (along >= 0.0 && met.is_finite()).then_some(met)
    }

    /// Position, on the line through `point` along the unit vector `axis`, of the point nearest to
    /// the ray: its signed distance from `point`. `None` if the nearest point is behind the ray's
    /// origin or overflows.
    pub fn nearest_on_line(&self, point: Vec3, axis: Vec3) -> Option<f32> {
        let normal = axis.cross(self.direction).cross(axis);
        let along_ray = (point - self.origin).dot(normal) / self.direction.dot(normal);
        let met = self.origin + self.direction * along_ray;
        let along = (met - point).dot(axis);
        (along_ray >= 0.0 && along.is_finite()).then_some(along)
    }

    /// Position of the point of a line segment that is nearest to the ray's line, from 0 at the
    /// first end to 1 at the second.
    pub fn nearest_on_segment(&self, [from, to]: [Vec3; 2]) -> f32 {
        let (along, from_origin, direction) = self.beside(from, to);
        let across = along.reject_from_normalized(direction);
        let part = -from_origin.dot(across) / across.length_squared();
        if part.is_finite() { part.clamp(0.0, 1.0) as f32 } else { 0.0 }
    }

    /// Distance along the ray at which it enters the hull of two balls; `None` if it misses the
    /// hull or starts beyond it. The hull is that of a ball whose centre and radius change evenly
    /// from one to the other.
    pub fn enters_capsule(&self, centres: [Vec3; 2], radii: [f32; 2]) -> Option<f32> {
        let part = f64::from(self.nearest_on_segment(centres));
        let (along, from_origin, direction) = self.beside(centres[0], centres[1]);
        let centre = from_origin + along * part;
        let radius = f64::from(radii[0]) + f64::from(radii[1] - radii[0]) * part;
        let middle = centre.dot(direction);
        let inside = radius * radius - centre.reject_from_normalized(direction).length_squared();
        (inside >= 0.0 && middle >= 0.0).then(|| (middle - inside.sqrt()) as f32)
    }

    /// A segment, the vector from the ray's origin to its start, and the unit direction of the ray.
    fn beside(&self, from: Vec3, to: Vec3) -> (DVec3, DVec3, DVec3) {
        let [from, to, origin] = [from, to, self.origin].map(Vec3::as_dvec3);
        (to - from, from - origin, self.direction.as_dvec3().normalize_or_zero())
    }
}
