//! Tracks of joints whose keys glTF can have as they are.
//!
//! A node's frame is its joint's space turned by a constant C. Relative to its parent it turns by
//! C_parentᵀ · R · C with the joint's rotation R, and is moved by a constant matrix times the joint's offset:
//! a slerp or steps of R, and lines, steps and splines of the offset, stay what they are.

use ::gltf::json::animation::Interpolation as Curve;
use glam::{DMat3, DVec3, Vec3};

use super::rig::GltfRig;
use crate::document::{Channel, Document, RigKind, Target, Timeline};
use crate::kinematics::skeleton::{Joint, JointId};
use crate::kinematics::spline::{Interpolation, Knot, Slopes, Spline};

/// The keys of a joint's rotation or offset, with the one curve that all of them have.
pub struct KeptTrack {
    /// Index of the joint, which is that of its node.
    pub node: usize,
    /// Times of the keys in the document, in seconds, from the start of the timeline to its end.
    pub times: Vec<f64>,
    pub curve: Curve,
    /// For cubic splines the slopes of each key, in units of the node's translation per second.
    pub slopes: Vec<Slopes<Vec3>>,
}

/// The tracks of a rig that can be kept.
#[derive(Default)]
pub struct KeptTracks {
    pub rotations: Vec<KeptTrack>,
    pub translations: Vec<KeptTrack>,
}

impl KeptTracks {
    /// The tracks of a skeleton that is posed by its keys alone, and not scaled unevenly or mirrored.
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
            if let Some(turns) = track(Channel::Rotation(joint)).filter(|_| !own.is_limited()) {
                kept.rotations.extend(rotation(joint, turns, timeline));
            }
            let is_moved = own.parent.is_none() && document.keys.has(Channel::Translation);
            if let Some(moves) = track(Channel::Offset(joint)).filter(|_| !is_moved) {
                let to_node = offset_to_node(rig, own, transform) * rig.metres_per_unit;
                kept.translations.extend(translation(joint, moves, timeline, to_node));
            }
        }
        kept
    }
}

/// Whether a matrix turns and scales evenly, without mirroring.
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

fn rotation(joint: JointId, track: &Spline<Vec3>, timeline: Timeline) -> Option<KeptTrack> {
    let curve = match one_interpolation(track)? {
        Interpolation::Slerp => Curve::Linear,
        Interpolation::Step => Curve::Step,
        Interpolation::Smooth | Interpolation::Linear => return None,
    };
    let times = padded(track, timeline)?;
    Some(KeptTrack { node: joint.index(), times, curve, slopes: Vec::new() })
}

fn translation(
    joint: JointId,
    track: &Spline<Vec3>,
    timeline: Timeline,
    to_node: DMat3,
) -> Option<KeptTrack> {
    let curve = match one_interpolation(track)? {
        Interpolation::Linear | Interpolation::Slerp => Curve::Linear,
        Interpolation::Step => Curve::Step,
        Interpolation::Smooth => Curve::CubicSpline,
    };
    let times = padded(track, timeline)?;
    let slopes = match curve {
        Curve::CubicSpline => times.iter().map(|time| slopes_at(track, *time, to_node)).collect(),
        _ => Vec::new(),
    };
    Some(KeptTrack { node: joint.index(), times, curve, slopes })
}

/// The slopes of a node's translation at a key; level where the curve is constant, before the track's first
/// key and after its last.
fn slopes_at(track: &Spline<Vec3>, time: f64, to_node: DMat3) -> Slopes<Vec3> {
    let level = Slopes { arriving: Vec3::ZERO, leaving: Vec3::ZERO };
    let Some(own) = track.slopes(time) else { return level };
    let is_end = |knot: Option<&Knot<Vec3>>| knot.is_some_and(|knot| knot.time == time);
    let turned = |slope: Vec3| (to_node * slope.as_dvec3()).as_vec3();
    Slopes {
        arriving: if is_end(track.knots().first()) { Vec3::ZERO } else { turned(own.arriving) },
        leaving: if is_end(track.knots().last()) { Vec3::ZERO } else { turned(own.leaving) },
    }
}

/// The interpolation of all keys but the last; `None` if there are several, or only one key.
fn one_interpolation(track: &Spline<Vec3>) -> Option<Interpolation> {
    let (_, before) = track.knots().split_last()?;
    let first = before.first()?.interpolation;
    before.iter().all(|knot| knot.interpolation == first).then_some(first)
}

/// The times of the keys, with the timeline's ends, where the value is that of the nearest key. `None` if
/// keys are outside the timeline, or so near to each other that single precision cannot tell them apart.
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
