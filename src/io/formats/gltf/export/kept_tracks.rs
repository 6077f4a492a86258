//! Tracks of joints whose keys glTF can have as they are, or as exact as is needed.
//!
//! A node's frame is its joint's space turned by a constant C. Relative to its parent it turns by
//! C_parentᵀ · R · C with the joint's rotation R, and is moved by a constant matrix times the
//! joint's offset: a slerp or steps of R, and lines, steps and cubics of the offset, stay what they
//! are. Curves of angles become splines of quaternions. Of curves that are cubics in the file, the
//! keys are written, too.

use ::gltf::json::animation::Interpolation as Curve;
use std::rc::Rc;

use glam::{DMat3, DQuat, DVec3, Vec3};

use super::joint_track::{ClipTimes, JointTrack};
use super::quaternion_spline::{self, NodeRotation};
use super::rig::GltfRig;
use crate::document::{Channel, Document, RigKind, Target, Timeline};
use crate::kinematics::skeleton::{Joint, JointId};
use crate::kinematics::spline::{Interpolation, Knot, Slopes, Spline};

/// The keys of a joint's rotation or offset, with the curve of the file.
pub struct KeptTrack {
    /// Index of the joint, which is that of its node.
    pub node: usize,
    /// Times of the keys in the document, in seconds, from the start of the timeline to its end.
    pub times: Vec<f64>,
    pub curve: Curve,
    /// For cubic splines the slopes of each key, in units of the node's translation per second.
    pub slopes: Vec<Slopes<Vec3>>,
    /// For cubic splines the keys of the document, in the units and times of the file.
    pub keys: Vec<Knot<Vec3>>,
}

/// The tracks of a rig that can be kept.
#[derive(Default)]
pub struct KeptTracks {
    pub rotations: Vec<KeptTrack>,
    pub translations: Vec<KeptTrack>,
    /// The rotations by curves of angles.
    pub turns: Vec<JointTrack<4>>,
    /// The nodes of these with the frames of their angles, relative to the nodes.
    pub frames: Vec<(usize, DQuat)>,
}

impl KeptTracks {
    /// The tracks of a skeleton that is posed by its keys alone, and not scaled unevenly or
    /// mirrored.
    pub fn new(document: &Document, rig: &GltfRig, timeline: Timeline) -> Self {
        let skeleton = document.skeleton();
        let is_posed_by_keys = document.rig == RigKind::Skeleton
            && !document.follows_path()
            && !document.skeleton_rig.targets.iter().any(Target::is_posing)
            && !document.keys.tracks().any(|(channel, _)| channel.target().is_some());
        let transform = skeleton.transform().matrix3.as_dmat3();
        if !(is_posed_by_keys && is_even(transform)) {
            return Self::default();
        }
        let mut kept = Self::default();
        for (joint, own) in skeleton.iter() {
            let track = |channel| document.keys.track(channel);
            if let Some(turns) =
                track(Channel::Rotation(joint)).filter(|_| !own.limits.is_limited())
            {
                kept.add_rotation(joint, turns, timeline, || {
                    node_rotation(rig, joint, own, transform)
                });
            }
            let is_moved = own.parent.is_none() && document.keys.has(Channel::Translation);
            if let Some(moves) = track(Channel::Offset(joint)).filter(|_| !is_moved) {
                let to_node = offset_to_node(rig, own, transform) * rig.metres_per_unit;
                let mut track = translation(joint, moves, timeline, to_node);
                if let Some(KeptTrack { keys, curve: Curve::CubicSpline, .. }) = &mut track {
                    let origin = match own.parent {
                        None => skeleton.transform().translation.as_dvec3(),
                        Some(_) => DVec3::ZERO,
                    };
                    *keys = in_metres(moves, transform, origin, rig.metres_per_unit, timeline);
                }
                kept.translations.extend(track);
            }
        }
        kept
    }

    fn add_rotation(
        &mut self,
        joint: JointId,
        track: &Spline<Vec3>,
        timeline: Timeline,
        node_rotation: impl FnOnce() -> NodeRotation,
    ) {
        let node = joint.index();
        let (Some(curve), Some(times)) = (rotation_curve(track), padded(track, timeline)) else {
            return;
        };
        if curve != Curve::CubicSpline {
            let (slopes, keys) = (Vec::new(), Vec::new());
            self.rotations.push(KeptTrack { node, times, curve, slopes, keys });
            return;
        }
        let rotation = node_rotation();
        let clip = ClipTimes::new(timeline);
        let keys = quaternion_spline::keys(track, &times, rotation);
        let in_file: Vec<f32> = keys.iter().map(|key| clip.of(key.time) as f32).collect();
        if !in_file.is_sorted_by(|before, after| before < after) {
            return;
        }
        let rows = keys.iter().flat_map(|key| [key.arriving, key.value, key.leaving]);
        self.turns.push(JointTrack {
            node,
            times: Rc::new(in_file),
            curve,
            values: rows.map(|row| row.as_quat().to_array()).collect(),
            keys: track
                .knots()
                .iter()
                .map(|key| Knot { time: clip.of(key.time), ..*key })
                .collect(),
        });
        self.frames.push((node, rotation.after.conjugate()));
    }
}

/// The rotation of a node by its joint's angles.
fn node_rotation(rig: &GltfRig, joint: JointId, own: &Joint, transform: DMat3) -> NodeRotation {
    let world = |index: usize| DQuat::from_mat3(&rig.bind_pose[index].frame()).normalize();
    let turned = transform * transform.determinant().cbrt().recip();
    let frame = DQuat::from_mat3(&(turned * own.frame.as_dmat3())).normalize();
    let parent = own.parent.map_or(DQuat::IDENTITY, |parent| world(parent.index()));
    NodeRotation {
        before: parent.conjugate() * frame,
        after: frame.conjugate() * world(joint.index()),
    }
}

/// The keys of an offset as the file's scene has it: in metres, turned and scaled by the skeleton's
/// transform, and moved by `origin`.
fn in_metres(
    track: &Spline<Vec3>,
    transform: DMat3,
    origin: DVec3,
    metres_per_unit: f64,
    timeline: Timeline,
) -> Vec<Knot<Vec3>> {
    let slope = |slope: Vec3| (transform * slope.as_dvec3() * metres_per_unit).as_vec3();
    let clip = ClipTimes::new(timeline);
    let key = |key: &Knot<Vec3>| Knot {
        time: clip.of(key.time),
        value: ((transform * key.value.as_dvec3() + origin) * metres_per_unit).as_vec3(),
        interpolation: key.interpolation,
        slopes: key.slopes.map(|slopes| Slopes {
            arriving: slope(slopes.arriving),
            leaving: slope(slopes.leaving),
        }),
    };
    track.knots().iter().map(key).collect()
}

/// Returns whether a matrix turns and scales evenly, without mirroring.
fn is_even(matrix: DMat3) -> bool {
    const ROUNDING: f64 = 1e-6;
    let scale = matrix.determinant().cbrt();
    let rest = matrix.transpose() * matrix - DMat3::from_diagonal(DVec3::splat(scale * scale));
    let is_rounding = |it: f64| it.abs() <= ROUNDING * scale * scale;
    scale > 0.0 && rest.to_cols_array().into_iter().all(is_rounding)
}

/// The matrix from a joint's offset to the translation of its node, in units of the scene.
fn offset_to_node(rig: &GltfRig, joint: &Joint, transform: DMat3) -> DMat3 {
    match joint.parent {
        None => transform,
        Some(parent) => rig.bind_pose[parent.index()].frame().transpose() * transform,
    }
}

/// The curve of the file for keys of angles: lines for slerps, steps for steps, and cubic splines
/// for other curves. `None` if the file needs a key at every frame.
fn rotation_curve(track: &Spline<Vec3>) -> Option<Curve> {
    Some(match one_interpolation(track) {
        Some(Interpolation::Slerp) => Curve::Linear,
        Some(Interpolation::Step) => Curve::Step,
        _ if is_continuous(track) => Curve::CubicSpline,
        _ => return None,
    })
}

fn translation(
    joint: JointId,
    track: &Spline<Vec3>,
    timeline: Timeline,
    to_node: DMat3,
) -> Option<KeptTrack> {
    let curve = match one_interpolation(track) {
        Some(Interpolation::Linear | Interpolation::Slerp) => Curve::Linear,
        Some(Interpolation::Step) => Curve::Step,
        _ if is_continuous(track) => Curve::CubicSpline,
        _ => return None,
    };
    let times = padded(track, timeline)?;
    let slopes = match curve {
        Curve::CubicSpline => times.iter().map(|time| slopes_at(track, *time, to_node)).collect(),
        _ => Vec::new(),
    };
    Some(KeptTrack { node: joint.index(), times, curve, slopes, keys: Vec::new() })
}

/// The slopes of a node's translation at a time; level where the curve is constant, before the
/// track's first key and after its last.
fn slopes_at(track: &Spline<Vec3>, time: f64, to_node: DMat3) -> Slopes<Vec3> {
    let Some(own) = track.slopes(time) else {
        return Slopes { arriving: Vec3::ZERO, leaving: Vec3::ZERO };
    };
    let knots = track.knots();
    let key = knots.partition_point(|knot| knot.time < time);
    let slope = |segment: Option<&[Knot<Vec3>]>, own: Vec3| {
        let Some([from, to]) = segment else { return Vec3::ZERO };
        let slope = match from.interpolation {
            Interpolation::Auto | Interpolation::Smooth => own.as_dvec3(),
            Interpolation::Linear | Interpolation::Slerp => {
                (to.value.as_dvec3() - from.value.as_dvec3()) / (to.time - from.time)
            }
            Interpolation::Step => DVec3::ZERO,
        };
        (to_node * slope).as_vec3()
    };
    Slopes {
        arriving: slope(key.checked_sub(1).and_then(|it| knots.get(it..=key)), own.arriving),
        leaving: slope(knots.get(key..=key + 1), own.leaving),
    }
}

/// Returns whether the track has two keys or more, and no curve is a step.
fn is_continuous(track: &Spline<Vec3>) -> bool {
    let Some((_, before)) = track.knots().split_last() else { return false };
    !before.is_empty() && before.iter().all(|knot| knot.interpolation != Interpolation::Step)
}

/// The interpolation of all keys but the last; `None` if there are several, or only one key.
fn one_interpolation(track: &Spline<Vec3>) -> Option<Interpolation> {
    let (_, before) = track.knots().split_last()?;
    let first = before.first()?.interpolation;
    before.iter().all(|knot| knot.interpolation == first).then_some(first)
}

/// The times of the keys, with the timeline's ends, where the value is that of the nearest key.
/// `None` if keys are outside the timeline, or so near to each other that single precision cannot
/// tell them apart.
fn padded(track: &Spline<Vec3>, timeline: Timeline) -> Option<Vec<f64>> {
    let mut times: Vec<f64> = track.knots().iter().map(|knot| knot.time).collect();
    let (first, last) = (*times.first()?, *times.last()?);
    /// Part of a frame within which a key is at the end of the timeline.
    const NEAR: f64 = 1e-3;
    let near = NEAR / timeline.frame_rate;
    if first < timeline.start - near || last > timeline.end + near {
        return None;
    }
    if first > timeline.start + near {
        times.insert(0, timeline.start);
    }
    if last < timeline.end - near {
        times.push(timeline.end);
    }
    times.windows(2).all(|pair| (pair[0] as f32) < pair[1] as f32).then_some(times)
}
