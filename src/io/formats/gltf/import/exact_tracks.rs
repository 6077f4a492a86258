//! The motion of joints as keys.
//!
//! Let q be the rotation of a joint's node relative to the node above it, q₀ the same in the bind
//! pose, T its translation, C the frame that remains of its own scale, and W the transform of the
//! node above to the world in the bind pose. If no node above has an uneven or changing scale, a
//! joint has relative to its parent, whatever the parent does,
//!
//! ```text
//! E = Cᵀ · q₀⁻¹ · q · C      rotation in its own frame
//! o = W·T − b                offset, b being the parent's base in the bind pose
//! ```
//!
//! Slerp commutes with constant factors, and W is affine. So every key of the node becomes a key of
//! the joint with the same interpolation. Only the quaternion splines of rotations are no splines
//! of angles: they get keys in between, until the angles are as exact as f32.
//!
//! Scales above that are even leave rotations as they are also while they change; offsets then do
//! not follow from the keys of the node alone.
//!
//! Files of this program have the keys of cubic splines beside them, see
//! [`extras`](crate::io::formats::gltf::extras). They are taken if their curve is that of the file.

use core::cell::Cell;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

use super::animations::NodeTracks;
use super::joint_tracks::{ExactJoint, JointPlacement, StretchTracks};
use super::nodes::{NodeTransform, NodeTree, SkinJoints};
use super::sampler::{AnimatedPart, KeySampler, on_frame};
use crate::document::{Channel, Keys, Timeline};
use crate::io::formats::gltf::file::{GltfFile, KeyCurve};
use crate::io::formats::gltf::frame;
use crate::kinematics::skeleton::{JointId, exact_angles};
use crate::kinematics::spline::{Interpolation, Knot, Slopes, Spline, hermite};

/// Maximum number of pieces of curves that are tried in one file.
const MOST_PIECES: usize = 2_000_000;

/// Makes the tracks of joints whose nodes' keys can be taken as they are.
pub struct ExactTracks<'a> {
    nodes: &'a NodeTree,
    joints: &'a SkinJoints,
    tracks: &'a NodeTracks<'a>,
    bind_pose: &'a [JointPlacement],
    /// The timeline whose frames have the keys, as far as they are there; `None` if nothing moves.
    timeline: Option<Timeline>,
    /// The file, if this program has written it.
    own: Option<&'a GltfFile<'a>>,
    worlds: Vec<DAffine3>,
    /// For each node, whether it and all nodes above it scale evenly.
    is_even: Vec<bool>,
    /// For each node, whether it and all nodes above it scale evenly and constantly.
    is_still: Vec<bool>,
    /// Number of pieces of curves that may still be tried. Bounds the time for curves that turn
    /// wildly.
    left: Cell<usize>,
}

impl<'a> ExactTracks<'a> {
    pub fn new(
        nodes: &'a NodeTree,
        joints: &'a SkinJoints,
        tracks: &'a NodeTracks<'a>,
        bind_pose: &'a [JointPlacement],
        timeline: Option<Timeline>,
        own: Option<&'a GltfFile<'a>>,
    ) -> Self {
        let mut is_even = vec![false; nodes.parents.len()];
        let mut is_still = is_even.clone();
        for &node in &nodes.order {
            let matrix = nodes.locals[node].affine().matrix3;
            let above = nodes.parents[node];
            is_even[node] = !tracks.scales_unevenly(node, EVEN)
                && is_similarity(matrix, EVEN)
                && above.is_none_or(|above| is_even[above]);
            is_still[node] = !tracks.scales(node, STILL)
                && is_similarity(matrix, STILL)
                && above.is_none_or(|above| is_still[above]);
        }
        Self {
            nodes,
            joints,
            tracks,
            bind_pose,
            timeline,
            own,
            worlds: nodes.worlds(),
            is_even,
            is_still,
            left: Cell::new(MOST_PIECES),
        }
    }

    /// The tracks of a joint that do not depend on scales above it.
    pub fn of(&self, joint: usize) -> ExactJoint {
        let node = self.joints.nodes[joint];
        let above = self.nodes.parents[node];
        let is_turned_evenly = above.is_none_or(|above| self.is_even[above]);
        let frame = self.own_frame(node).filter(|_| is_turned_evenly);
        let rotation = is_turned_evenly.then(|| {
            let own = frame.and_then(|frame| self.own_rotation(node, frame));
            own.unwrap_or_else(|| self.rotation(node, frame))
        });
        let is_placed_evenly = above.is_none_or(|above| self.is_still[above]);
        let offset = is_placed_evenly.then(|| {
            let offset = self.offset(joint, node);
            self.own_points(node, AnimatedPart::Translation, &offset).unwrap_or(offset)
        });
        let frame = frame.map(DMat3::from_quat);
        let skin = self.scale(joint, frame.unwrap_or(DMat3::IDENTITY));
        ExactJoint {
            rotation: rotation.map(|rotation| self.on_frames(&rotation)),
            offset: offset.map(|offset| self.on_frames(&offset)),
            skin: skin.map(|scale| StretchTracks {
                scale: self.on_frames(&scale),
                shear: Spline::default(),
            }),
            frame: frame.map(|frame| frame.as_mat3()),
        }
    }

    /// The frame of a joint's angles relative to its node, if this program has written it.
    fn own_frame(&self, node: usize) -> Option<DQuat> {
        self.own?.nodes.0.get(node)?.extras.as_ref()?.own()?.frame()
    }

    /// The keys of angles in a frame that this program has written beside a rotation; `None` without
    /// them, or if the file's curve is another one.
    fn own_rotation(&self, node: usize, frame: DQuat) -> Option<Spline<Vec3>> {
        /// Largest difference in radians, twice that of the export.
        const NEAR: f64 = 1e-4;
        let sampler = self.tracks.track(node, AnimatedPart::Rotation)?;
        let keys = sampler.own_keys().filter(|_| sampler.is_cubic())?;
        let NodeTransform::TransformParts(parts) = self.nodes.locals[node] else { return None };
        let bind = parts.rotation.inverse();
        let channel = Channel::Rotation(JointId::default());
        let mut evaluated = Keys::default();
        evaluated.set_track(channel, keys.clone());
        let is_near = |time: f64, rotation: DQuat| {
            let angles = evaluated.value(channel, time).unwrap_or_default().as_dvec3();
            let own = frame * DQuat::from_mat3(&exact_angles::matrix(angles)) * frame.inverse();
            let turn = own.inverse() * (bind * rotation);
            2.0 * turn.xyz().length() < NEAR
        };
        let times = (0..sampler.len()).map(|key| (sampler.time(key), sampler.key_rotation(key)));
        let between = (1..sampler.len()).map(|key| {
            let middle = 0.5 * (sampler.time(key - 1) + sampler.time(key));
            (middle, sampler.spline_rotation(key - 1, 0.5))
        });
        let is_same = times.chain(between).all(|(time, rotation)| is_near(time, rotation));
        is_same.then_some(keys)
    }

    /// The keys of offsets or scales that this program has written beside a part of a node's
    /// transform; `None` without them, or if the curve of the file, `read`, is another one.
    fn own_points(
        &self,
        node: usize,
        part: AnimatedPart,
        read: &Spline<Vec3>,
    ) -> Option<Spline<Vec3>> {
        /// Largest difference of single-precision numbers from each other, relative to the largest.
        const NEAR: f32 = 1e-5;
        self.own?;
        let keys = self.tracks.track(node, part)?.own_keys()?;
        let largest = |track: &Spline<Vec3>| {
            track.knots().iter().map(|knot| knot.value.abs().max_element()).fold(0.0, f32::max)
        };
        let near = NEAR * largest(&keys).max(largest(read));
        let middles = read.knots().windows(2).map(|pair| 0.5 * (pair[0].time + pair[1].time));
        let times = read.knots().iter().map(|knot| knot.time).chain(middles);
        let is_near = |time: f64| Some(keys.at(time)?.distance(read.at(time)?) <= near);
        times.map(is_near).all(|it| it == Some(true)).then_some(keys)
    }

    /// The track with its keys at the frames that they mean, because files have times in single
    /// precision.
    fn on_frames(&self, track: &Spline<Vec3>) -> Spline<Vec3> {
        let moved = |knot: &Knot<Vec3>| {
            let time = self.timeline.map_or(knot.time, |it| on_frame(knot.time, it));
            Knot { time, ..*knot }
        };
        track.knots().iter().map(moved).collect()
    }

    /// The keys of the rotation of a joint's node as angles in a frame relative to it, or without one
    /// in the node's own axes.
    fn rotation(&self, node: usize, frame: Option<DQuat>) -> Spline<Vec3> {
        let NodeTransform::TransformParts(parts) = self.nodes.locals[node] else {
            return Spline::default();
        };
        let Some(sampler) = self.tracks.track(node, AnimatedPart::Rotation) else {
            // Without keys, the node has the rotation of the bind pose.
            return Spline::default();
        };
        let scale = DMat3::from_diagonal(parts.scale);
        let axes = self::frame(scale.y_axis, scale.x_axis);
        let own = axes * frame.map_or(DMat3::IDENTITY, DMat3::from_quat);
        let inverse = parts.rotation.inverse();
        let angles = |rotation: DQuat, near: DVec3| {
            let turn = DMat3::from_quat(inverse * rotation);
            exact_angles::nearest(own.transpose() * turn * own, near)
        };
        RotationTrack { sampler, angles: &angles, left: &self.left }.knots()
    }

    fn offset(&self, joint: usize, node: usize) -> Spline<Vec3> {
        let Some(sampler) = self.tracks.track(node, AnimatedPart::Translation) else {
            return Spline::default();
        };
        let above = self.nodes.parents[node].map_or(DAffine3::IDENTITY, |above| self.worlds[above]);
        let parent = self.joints.parents[joint];
        let base = parent.map_or(DVec3::ZERO, |parent| self.bind_pose[parent].base);
        points(sampler, DAffine3 { translation: above.translation - base, ..above })
    }

    /// The keys of a node's scale as those by which its joint scales the skin in a frame relative to
    /// the joint's axes. `None` if the scale is not along the frame's axes, or 0 in the bind pose, or
    /// if more than this scale and the joint's motion changes the skin.
    fn scale(&self, joint: usize, frame: DMat3) -> Option<Spline<Vec3>> {
        /// Sine of the greatest angle between axes that are alike.
        const ALIKE: f64 = 1e-5;
        let (node, skin_node) = (self.joints.nodes[joint], self.joints.skin_nodes[joint]);
        let is_moved = |part| self.tracks.track(skin_node, part).is_some();
        let is_apart = skin_node != node
            && (is_moved(AnimatedPart::Rotation) || is_moved(AnimatedPart::Translation));
        if is_apart || !self.nodes.parents[skin_node].is_none_or(|above| self.is_still[above]) {
            return None;
        }
        let Some(sampler) = self.tracks.track(skin_node, AnimatedPart::Scale) else {
            return Some(Spline::default());
        };
        let NodeTransform::TransformParts(parts) = self.nodes.locals[skin_node] else {
            return None;
        };
        let axes = (self.bind_pose[joint].frame * frame).transpose() * self.bind_pose[joint].skin;
        let is_along = |axis: usize| {
            let axis_in_frame = axes.col(axis).normalize_or_zero();
            1.0 - axis_in_frame[axis].abs() < 0.5 * ALIKE * ALIKE
        };
        let by = parts.scale.recip();
        if !(by.is_finite() && (0..3).all(is_along)) {
            return None;
        }
        let scale = points(sampler, DAffine3::from_scale(by));
        Some(self.own_points(skin_node, AnimatedPart::Scale, &scale).unwrap_or(scale))
    }
}

/// The keys of a translation or scale, transformed.
fn points(sampler: &KeySampler<'_>, by: DAffine3) -> Spline<Vec3> {
    let knot = |key| {
        let slope = |tangent: DVec3| by.transform_vector3(tangent).as_vec3();
        let slopes = sampler.tangents(key).map(|[arriving, leaving]| Slopes {
            arriving: slope(arriving),
            leaving: slope(leaving),
        });
        let interpolation = match sampler.channel.source.curve {
            KeyCurve::Linear => Interpolation::Linear,
            KeyCurve::Step => Interpolation::Step,
            KeyCurve::CubicSpline => Interpolation::Smooth,
        };
        let value = by.transform_point3(sampler.key_point(key)).as_vec3();
        Knot { time: sampler.time(key), value, interpolation, slopes }
    };
    (0..sampler.len()).map(knot).collect()
}

/// Part of a scale by which it may be uneven, or change evenly, and still turns joints as if it were
/// even: many programs round scales.
const EVEN: f64 = 1e-4;
/// Part of a scale by which it may change and be uneven, and still places joints as if it were even
/// and constant.
const STILL: f64 = 2e-6;

/// Returns whether a matrix scales evenly but for a part `least`, without mirroring.
fn is_similarity(matrix: DMat3, least: f64) -> bool {
    let square = matrix.transpose() * matrix;
    let size = (square.x_axis.x + square.y_axis.y + square.z_axis.z) / 3.0;
    let is_even = size > 0.0 && (square * size.recip()).abs_diff_eq(DMat3::IDENTITY, 2.0 * least);
    is_even && matrix.determinant() > 0.0
}

/// The keys of a rotation as angles.
struct RotationTrack<'a> {
    sampler: &'a KeySampler<'a>,
    /// Angles of a rotation of the node, nearest to given angles.
    angles: &'a dyn Fn(DQuat, DVec3) -> DVec3,
    left: &'a Cell<usize>,
}

impl RotationTrack<'_> {
    fn knots(&self) -> Spline<Vec3> {
        match self.sampler.channel.source.curve {
            KeyCurve::Linear => self.plain(Interpolation::Slerp),
            KeyCurve::Step => self.plain(Interpolation::Step),
            KeyCurve::CubicSpline => self.refined(),
        }
    }

    fn plain(&self, interpolation: Interpolation) -> Spline<Vec3> {
        let mut last = DVec3::ZERO;
        let knot = |key| {
            last = (self.angles)(self.sampler.key_rotation(key), last);
            let time = self.sampler.time(key);
            Knot { interpolation, ..Knot::new(time, last.as_vec3()) }
        };
        (0..self.sampler.len()).map(knot).collect()
    }

    /// Keys at the file's times and, where the curve needs them, between. Their slopes are those of
    /// the file's curve.
    fn refined(&self) -> Spline<Vec3> {
        let keys = self.sampler.len();
        let mut knots: Vec<Knot<Vec3>> = Vec::new();
        let mut last = (self.angles)(self.sampler.key_rotation(0), DVec3::ZERO);
        for key in 0..keys.saturating_sub(1) {
            let (start, end) = (self.sampler.time(key), self.sampler.time(key + 1));
            let curve = RotationCurve { track: self, key, start, end, span: end - start };
            let pieces = curve.pieces(last);
            for index in 0..pieces {
                let part = |index: usize| index as f64 / pieces as f64;
                let from = curve.at(part(index), last);
                let slopes = curve.slopes(part(index), part(index + 1), from);
                push(&mut knots, curve.time(part(index)), from, slopes);
                last = curve.at(part(index + 1), from);
                let slopes = curve.slopes(part(index + 1), part(index), last);
                push(&mut knots, curve.time(part(index + 1)), last, slopes);
            }
        }
        if keys == 1 {
            knots.push(Knot::new(self.sampler.time(0), last.as_vec3()));
        }
        knots.into_iter().collect()
    }
}

/// Adds a knot, or to the last knot at the same time the slope with which the curve leaves it.
fn push(knots: &mut Vec<Knot<Vec3>>, time: f64, value: DVec3, slope: DVec3) {
    let (value, slope) = (value.as_vec3(), slope.as_vec3());
    match knots.last_mut().filter(|last| last.time == time) {
        Some(last) => {
            if let Some(slopes) = &mut last.slopes {
                slopes.leaving = slope;
            }
        }
        None => {
            let slopes = Some(Slopes { arriving: slope, leaving: slope });
            knots.push(Knot { slopes, ..Knot::new(time, value) });
        }
    }
}

/// The quaternion spline from a key to the next one, as angles.
struct RotationCurve<'a> {
    track: &'a RotationTrack<'a>,
    key: usize,
    start: f64,
    end: f64,
    span: f64,
}

impl RotationCurve<'_> {
    /// Time at a part of the way, in seconds.
    fn time(&self, part: f64) -> f64 {
        if part < 1.0 { self.start + part * self.span } else { self.end }
    }

    /// Angles at a part of the way, nearest to `near`.
    fn at(&self, part: f64, near: DVec3) -> DVec3 {
        (self.track.angles)(self.track.sampler.spline_rotation(self.key, part), near)
    }

    /// Slopes of the angles per second at a part of the way, seen from the side of `towards`.
    fn slopes(&self, part: f64, towards: f64, here: DVec3) -> DVec3 {
        // The difference quotient of second order; its error is of the order of STEP².
        const STEP: f64 = 1e-4;
        let step = (towards - part) * STEP;
        let near = self.at(part + step, here);
        let far = self.at(part + 2.0 * step, near);
        (near * 4.0 - here * 3.0 - far) / (2.0 * step * self.span)
    }

    /// The number of equal pieces into which the curve is cut, so that a cubic through each is as
    /// exact as needed.
    fn pieces(&self, near: DVec3) -> usize {
        const MOST: usize = 256;
        let mut pieces = 1;
        while pieces < MOST {
            let Some(left) = self.track.left.get().checked_sub(pieces) else { break };
            self.track.left.set(left);
            if self.is_exact(pieces, near) {
                break;
            }
            pieces *= 2;
        }
        pieces
    }

    /// Returns whether cubics through `pieces` pieces differ from the curve by less than can be
    /// seen.
    fn is_exact(&self, pieces: usize, mut near: DVec3) -> bool {
        /// Largest difference in radians.
        const EXACT: f64 = 3e-7;
        const INSIDE: [f64; 3] = [0.25, 0.5, 0.75];
        let width = 1.0 / pieces as f64;
        (0..pieces).all(|index| {
            let (start, end) = (index as f64 * width, (index + 1) as f64 * width);
            let from = self.at(start, near);
            let to = self.at(end, from);
            let leaving = self.slopes(start, end, from) * (width * self.span);
            let arriving = self.slopes(end, start, to) * (width * self.span);
            near = to;
            INSIDE.into_iter().all(|s| {
                let [of_from, of_leaving, of_to, of_arriving] = hermite(s);
                let cubic =
                    from * of_from + leaving * of_leaving + to * of_to + arriving * of_arriving;
                let exact = self.at(start + s * width, cubic);
                (exact - cubic).abs().max_element() < EXACT
            })
        })
    }
}
