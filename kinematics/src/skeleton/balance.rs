use core::f32::consts::TAU;
use core::f64::consts::PI;

use glam::{Affine3A, DVec3, Vec2, Vec3};

use super::{Joint, JointId, Skeleton, SkeletonPose};

/// Where the weight of a posed skeleton is, and what it stands on.
///
/// The world's y is up, and the ground is the plane y = 0. Bones are solids of the same density,
/// whose overlaps count twice: a round cone from [`Joint::radius`] at the base to the radius of the
/// thinnest child on the tip, if that is smaller. A joint without a bone is a ball. If no bone has a
/// radius, bones weigh by their lengths.
///
/// Both ends of each bone can stand on the ground, and so can the heel: the point of a bone that is
/// under its base and as high as its tip in the bind pose. A point stands if its height is at most
/// 1.5 times the bone's radius.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Balance {
    /// Centre of mass in the world.
    pub centre: Vec3,
    /// x and z in the world of the corners of the convex hull of what stands on the ground, in the
    /// order of positive rotation from x to z; empty if nothing does.
    pub support: Vec<Vec2>,
    /// x and z of all rims that stand on the ground, in the order of their positions.
    standing: Vec<Vec2>,
    /// Radius of each bone at its tip.
    tip_radii: Vec<f32>,
}

impl Balance {
    /// The balance of a skeleton in its pose; `None` if no bone has a radius or a length, and if
    /// coordinates are out of the range of numbers.
    pub fn of(skeleton: &Skeleton) -> Option<Self> {
        let mut balance = Self::default();
        balance.renew(skeleton, &skeleton.pose()).then_some(balance)
    }

    /// Replaces the balance by that of a skeleton in `pose`, which is in the world, and reuses its
    /// memory. Returns false where [`Balance::of`] returns `None`; the balance is then meaningless.
    pub fn renew(&mut self, skeleton: &Skeleton, pose: &SkeletonPose) -> bool {
        write_tip_radii(skeleton, &mut self.tip_radii);
        let Some(centre) = centre_of_mass(skeleton, pose, &self.tip_radii) else { return false };
        self.centre = centre;
        self.standing.clear();
        for (joint, it) in skeleton.iter() {
            add_standing(skeleton.transform(), it, pose.full(joint), &mut self.standing);
        }
        self.standing.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        self.standing.dedup();
        write_convex_hull(&self.standing, &mut self.support);
        true
    }

    /// x and z of the middle of what stands on the ground, and how firmly it stands, from 0 to 1.
    /// Both change without jumps while feet are lifted: an end or heel counts fully up to the height
    /// at which it stands, less above, and not at all from four times that height on. `None` if
    /// nothing counts.
    pub fn middle_of_feet(posed: &Skeleton) -> Option<(Vec2, f32)> {
        let pose = posed.pose();
        let (mut sum, mut weights) = (Vec2::ZERO, 0.0);
        for (id, joint) in posed.iter() {
            for (end, height) in ends_on_ground(posed.transform(), joint, pose.full(id)) {
                let weight = ((4.0 - height) / 3.0).clamp(0.0, 1.0);
                if weight > 0.0 {
                    sum += weight * Vec2::new(end.x, end.z);
                    weights += weight;
                }
            }
        }
        let middle = sum / weights;
        (weights > 0.0 && middle.is_finite()).then(|| (middle, weights.min(1.0)))
    }

    /// x and z of the centre of mass, in the world.
    pub fn centre_on_ground(&self) -> Vec2 {
        Vec2::new(self.centre.x, self.centre.z)
    }

    /// Distance on the ground from the centre of mass to the edge of the support: positive inside,
    /// negative outside, where the body tips over. `None` without support.
    pub fn margin(&self) -> Option<f32> {
        let centre = self.centre_on_ground();
        let nearest = self.edges().map(|[from, to]| distance_to_segment(centre, from, to));
        let distance = nearest.min_by(f32::total_cmp)?;
        let is_left = |[from, to]: [Vec2; 2]| (to - from).perp_dot(centre - from) >= 0.0;
        let is_inside = self.support.len() > 2 && self.edges().all(is_left);
        Some(if is_inside { distance } else { -distance })
    }

    /// The edges of the support, each as its two ends.
    pub fn edges(&self) -> impl Iterator<Item = [Vec2; 2]> + '_ {
        let next = self.support.iter().cycle().skip(1);
        self.support.iter().zip(next).map(|(from, to)| [*from, *to])
    }
}

/// Sets the radius of each bone at its tip.
fn write_tip_radii(skeleton: &Skeleton, tip_radii: &mut Vec<f32>) {
    let joints = skeleton.joints();
    tip_radii.clear();
    tip_radii.extend(joints.iter().map(|joint| joint.radius));
    for joint in joints {
        if let Some(parent) = joint.parent.filter(|it| joints[it.index()].axis == joint.offset) {
            let radius = &mut tip_radii[parent.index()];
            *radius = radius.min(joint.radius);
        }
    }
}

/// The mass of each bone, and its centre as a fraction of the way from the bone's base to its tip.
fn masses(skeleton: &Skeleton, tip_radii: &[f32]) -> impl Iterator<Item = (f64, f64)> {
    let by_volume = skeleton.joints().iter().zip(tip_radii);
    let by_volume = by_volume.map(|(joint, tip_radius)| RoundCone::new(joint, *tip_radius).mass());
    let has_volume = by_volume.clone().any(|(volume, _)| volume > 0.0);
    by_volume.zip(skeleton.joints()).map(move |(of_volume, joint)| match has_volume {
        true => of_volume,
        false => (f64::from(joint.axis.length()), 0.5),
    })
}

/// The centre of mass, in the world, of a joint's bone and all bones below it; the joint's base if they
/// have no mass.
pub(crate) fn centre_of_mass_below(skeleton: &Skeleton, top: JointId) -> Vec3 {
    let pose = skeleton.pose();
    let mut is_below = vec![false; skeleton.joints().len()];
    let mut total = (0.0, DVec3::ZERO);
    for ((id, joint), (mass, centre)) in skeleton.iter().zip(bone_masses(skeleton)) {
        let is_parent_below = joint.parent.is_some_and(|parent| is_below[parent.index()]);
        is_below[id.index()] = id == top || is_parent_below;
        if is_below[id.index()] {
            total.0 += mass;
            total.1 += mass * pose.full(id).transform_point3(centre.as_vec3()).as_dvec3();
        }
    }
    if total.0 > 0.0 { (total.1 / total.0).as_vec3() } else { pose.base(top) }
}

/// The mass of each bone of a skeleton, relative to the others, and its centre in the joint's space.
pub(crate) fn bone_masses(skeleton: &Skeleton) -> Vec<(f64, DVec3)> {
    let mut tip_radii = Vec::new();
    write_tip_radii(skeleton, &mut tip_radii);
    let bones = skeleton.joints().iter().zip(masses(skeleton, &tip_radii));
    bones.map(|(joint, (mass, along))| (mass, along * joint.axis.as_dvec3())).collect()
}

fn centre_of_mass(skeleton: &Skeleton, pose: &SkeletonPose, tip_radii: &[f32]) -> Option<Vec3> {
    let mut total = (0.0, DVec3::ZERO);
    for (joint, (mass, along)) in pose.ids().zip(masses(skeleton, tip_radii)) {
        let [base, tip] = [pose.base(joint), pose.tip(joint)].map(Vec3::as_dvec3);
        total.0 += mass;
        total.1 += mass * base.lerp(tip, along);
    }
    let centre = (total.1 / total.0).as_vec3();
    (total.0 > 0.0 && centre.is_finite()).then_some(centre)
}

/// The convex hull of two balls, the first at the origin.
struct RoundCone {
    length: f64,
    base_radius: f64,
    tip_radius: f64,
}

impl RoundCone {
    fn new(joint: &Joint, tip_radius: f32) -> Self {
        let [length, base_radius, tip_radius] =
            [joint.axis.length(), joint.radius, tip_radius].map(f64::from);
        Self { length, base_radius, tip_radius }
    }

    /// Volume, and position of the centre of mass as a fraction of the length.
    fn mass(&self) -> (f64, f64) {
        let Self { length, base_radius: wide, tip_radius: narrow } = *self;
        if length <= wide - narrow {
            return (4.0 / 3.0 * PI * wide.powi(3), 0.0);
        }
        // The side of the cone touches the balls in circles this far from their centres, measured
        // along the axis, as a fraction of their radii.
        let sine = (wide - narrow) / length;
        let cosine = (1.0 - sine * sine).sqrt();
        let (low, high) = (wide * sine, length + narrow * sine);
        let base = ball_below(wide, low);
        let side = cone(wide * cosine, narrow * cosine, high - low);
        let tip = ball_below(narrow, -narrow * sine);
        let volume = base.0 + side.0 + tip.0;
        let moment = base.1 + (side.1 + low * side.0) + (length * tip.0 - tip.1);
        (volume, if volume > 0.0 { moment / (volume * length) } else { 0.5 })
    }
}

/// Volume and moment, about its centre, of the part of a ball below the height `top`.
fn ball_below(radius: f64, top: f64) -> (f64, f64) {
    let volume = PI * (radius * radius * (top + radius) - (top.powi(3) + radius.powi(3)) / 3.0);
    let moment = PI * (radius * radius * top * top / 2.0 - (top.powi(4) + radius.powi(4)) / 4.0);
    (volume, moment)
}

/// Volume and moment, about its base, of a truncated cone.
fn cone(base: f64, tip: f64, height: f64) -> (f64, f64) {
    let volume = PI * height * (base * base + base * tip + tip * tip) / 3.0;
    let moment = PI * height * height * (base * base + 2.0 * base * tip + 3.0 * tip * tip) / 12.0;
    (volume, moment)
}

/// Adds the rims of what stands on the ground: of the base, the tip and the heel of a bone.
fn add_standing(to_world: Affine3A, joint: &Joint, full: Affine3A, standing: &mut Vec<Vec2>) {
    const CORNERS: u8 = 16;
    let radius = radius_in_world(to_world, joint);
    for (end, _) in ends_on_ground(to_world, joint, full).filter(|(_, height)| *height <= 1.0) {
        let turns = (0..CORNERS).map(|corner| TAU * f32::from(corner) / f32::from(CORNERS));
        let at = Vec2::new(end.x, end.z);
        standing.extend(turns.map(|angle| at + radius * Vec2::from_angle(angle)));
    }
}

/// The base, the tip and the heel of a bone in the world, each with its height as a multiple of the
/// height up to which it stands; 1 if it stands.
fn ends_on_ground(
    to_world: Affine3A,
    joint: &Joint,
    full: Affine3A,
) -> impl Iterator<Item = (Vec3, f32)> {
    /// Ratio of a standing point's greatest height to the radius.
    const HEIGHT: f32 = 1.5;
    let stands = HEIGHT * radius_in_world(to_world, joint);
    let below = to_world.transform_vector3(joint.axis).y;
    let heel = to_world.matrix3.inverse() * Vec3::new(0.0, below, 0.0);
    let ends = [Some(Vec3::ZERO), Some(joint.axis), (below < 0.0).then_some(heel)];
    let ends = ends.into_iter().flatten().map(move |end| full.transform_point3(end));
    let height = move |end: Vec3| if end.y <= stands { 1.0 } else { end.y / stands };
    ends.filter(|end| end.is_finite()).map(move |end| (end, height(end)))
}

fn radius_in_world(to_world: Affine3A, joint: &Joint) -> f32 {
    joint.radius * to_world.matrix3.determinant().abs().cbrt()
}

/// Writes the corners of the convex hull of sorted points, in the order of positive rotation, by
/// Andrew's monotone chain.
fn write_convex_hull(points: &[Vec2], hull: &mut Vec<Vec2>) {
    hull.clear();
    if points.len() < 3 {
        return hull.extend_from_slice(points);
    }
    add_side(points.iter().copied(), hull);
    add_side(points.iter().rev().copied(), hull);
}

/// Adds one side of the hull of sorted points, without its last corner.
fn add_side(points: impl Iterator<Item = Vec2>, hull: &mut Vec<Vec2>) {
    let start = hull.len();
    for point in points {
        while let [.., before, last] = hull[start..] {
            if (last - before).perp_dot(point - last) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(point);
    }
    hull.pop();
}

fn distance_to_segment(point: Vec2, from: Vec2, to: Vec2) -> f32 {
    let along = to - from;
    let part = (point - from).dot(along) / along.length_squared();
    let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
    point.distance(from + along * part)
}
