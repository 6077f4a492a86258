use glam::{DQuat, DVec3};

/// 1 + the trace of a rotation up to which it is nearly half a turn.
pub const NEAR_HALF_TURN: f64 = 1e-4;

/// 1 + the cosine between two directions up to which they are nearly opposite.
pub const OPPOSITE: f64 = 1e-6;

/// The rotation that maps the axes of one right-handed frame to those of another, and 1 + the trace
/// of the rotation. The smaller this number is, the less precise the rotation; it is 0 for half a
/// turn.
#[inline(always)]
pub fn rotation_between(from: [DVec3; 3], to: [DVec3; 3]) -> (DQuat, f64) {
    let ([a, b, c], [x, y, z]) = (from, to);
    // 1 + the trace is 4 cos²(θ/2); the sum of the cross products is 2 sin θ along the axis.
    let trace_plus_one = 1.0 + a.dot(x) + b.dot(y) + c.dot(z);
    let sin = a.cross(x) + b.cross(y) + c.cross(z);
    let doubled = trace_plus_one.sqrt();
    (DQuat::from_vec4((sin * (0.5 / doubled)).extend(0.5 * doubled)), trace_plus_one)
}

/// The rotation by the smallest angle from one unit vector to another, and 1 + the cosine of this
/// angle. The smaller this number is, the less precise the rotation; it is 0 for half a turn.
#[inline(always)]
pub fn least_rotation(from: DVec3, to: DVec3) -> (DQuat, f64) {
    // 2 cos²(θ/2); the cross product is sin θ along the axis.
    let cos_plus_one = 1.0 + from.dot(to);
    let cos = (0.5 * cos_plus_one).sqrt();
    (DQuat::from_vec4((from.cross(to) * (0.5 / cos)).extend(cos)), cos_plus_one)
}
