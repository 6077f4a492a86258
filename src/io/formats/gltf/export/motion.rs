//! The animation. Tracks of joints whose keys glTF can have as they are, or as exact as is needed,
//! are kept; all others have a key at every frame.
//!
//! A node's frame is its joint's space turned by a constant C. Relative to its parent it turns by
//! C_parentᵀ · R · C with the joint's rotation R, and is moved by a constant matrix times the
//! joint's offset: a slerp or steps of R, and lines, steps and cubics of the offset, stay what they
//! are. Curves of angles become splines of quaternions. Of curves that are cubics in the file, the
//! keys are written, too.

use std::rc::Rc;

use glam::{DMat3, DQuat, DVec3, Vec3};

use super::GlbError;
use super::nodes::{ClipTimes, JointNode, JointNodes, JointTrack, NodeRole};
use super::quaternion_spline::{self, NodeRotation, QuaternionKey, same_side};
use super::rig::GltfRig;
use super::stretch::StretchKind;
use crate::document::{Channel, Document, Target, Timeline};
use crate::io::exported::Progress;
use crate::io::formats::gltf::file::KeyCurve;
use crate::kinematics::skeleton::{Joint, JointId};
use crate::kinematics::spline::{Interpolation, Knot, Slopes, Spline};

/// The animation: the transforms of all nodes that leave the bind pose.
#[derive(Default)]
pub struct JointAnimation {
    /// Rotations relative to the parents, as unit quaternions. Their signs are chosen so that
    /// interpolation takes the shorter arc.
    pub rotations: Vec<JointTrack<4>>,
    /// Translations relative to the parents, in metres.
    pub translations: Vec<JointTrack<3>>,
    /// Scales of the nodes that stretch the skin.
    pub scales: Vec<JointTrack<3>>,
    /// Nodes with the frames of their joints' angles, relative to the nodes.
    pub frames: Vec<(usize, DQuat)>,
    pub timeline: Timeline,
}

impl JointAnimation {
    /// Adds the tracks that can be kept: scales of the skin, and all others of a skeleton that is
    /// posed by its keys alone, and not scaled unevenly or mirrored.
    pub fn keep_tracks(&mut self, document: &Document, rig: &GltfRig, bones: &JointNodes) {
        let skeleton = document.skeleton();
        for (node, JointNode { bone, role, .. }) in bones.nodes.iter().enumerate() {
            let scales = document.keys.track(Channel::SkinScale(JointId::new(*bone)));
            if let Some(scales) = scales.filter(|_| *role == NodeRole::Stretch(StretchKind::Scale))
            {
                let mut track = points(node, scales, self.timeline, DMat3::IDENTITY);
                if let Some(JointTrack { keys, curve: KeyCurve::CubicSpline, .. }) = &mut track {
                    *keys = in_metres(scales, DMat3::IDENTITY, DVec3::ZERO, 1.0, self.timeline);
                }
                self.scales.extend(track);
            }
        }
        let is_posed_by_keys = !document.follows_path()
            && !document.rig.targets.iter().any(Target::is_posing)
            && !document.keys.tracks().any(|(channel, _)| channel.target().is_some());
        let transform = skeleton.transform().matrix3.as_dmat3();
        if !(is_posed_by_keys && is_even(transform)) {
            return;
        }
        for (joint, own) in skeleton.iter() {
            let track = |channel| document.keys.track(channel);
            if let Some(turns) =
                track(Channel::Rotation(joint)).filter(|_| !own.limits.is_limited())
            {
                self.keep_rotation(joint, turns, rig.node_rotation(joint, own));
            }
            let is_moved = own.parent.is_none() && document.keys.has(Channel::Translation);
            if let Some(moves) = track(Channel::Offset(joint)).filter(|_| !is_moved) {
                let to_node = offset_to_node(rig, own, transform) * rig.metres_per_unit;
                let mut track = points(joint.index(), moves, self.timeline, to_node);
                if let Some(JointTrack { keys, curve: KeyCurve::CubicSpline, .. }) = &mut track {
                    let origin = match own.parent {
                        None => skeleton.transform().translation.as_dvec3(),
                        Some(_) => DVec3::ZERO,
                    };
                    *keys = in_metres(moves, transform, origin, rig.metres_per_unit, self.timeline);
                }
                self.translations.extend(track);
            }
        }
    }

    fn keep_rotation(&mut self, joint: JointId, track: &Spline<Vec3>, rotation: NodeRotation) {
        let node = joint.index();
        let times = padded(track, self.timeline);
        let (Some(curve), Some(times)) = (curve(track, &[Interpolation::Slerp]), times) else {
            return;
        };
        if curve != KeyCurve::CubicSpline {
            self.rotations.push(JointTrack::new(node, times.into(), curve));
            return;
        }
        let clip = ClipTimes::new(self.timeline);
        let spline = quaternion_spline::keys(track, &times, rotation);
        let in_file = |key: &QuaternionKey| clip.of(key.time) as f32;
        if !spline.is_sorted_by(|before, after| in_file(before) < in_file(after)) {
            return;
        }
        let rows = spline.iter().flat_map(|key| [key.arriving, key.value, key.leaving]);
        let keys = track.knots().iter().map(|key| Knot { time: clip.of(key.time), ..*key });
        self.rotations.push(JointTrack {
            values: rows.map(|row| row.as_quat().to_array()).collect(),
            keys: keys.collect(),
            ..JointTrack::new(node, spline.iter().map(|key| key.time).collect(), curve)
        });
        self.frames.push((node, rotation.after.conjugate()));
    }

    /// Records the values of all tracks that have none, and of the nodes that have no track at
    /// every frame. Drops the tracks of nodes that stay in the bind pose.
    pub async fn record(
        &mut self,
        rig: &GltfRig,
        bones: &JointNodes,
        progress: &Progress,
    ) -> Result<(), GlbError> {
        let is_moving = rig.is_moving() && self.timeline.is_valid();
        let frames = if is_moving { self.timeline.frames() } else { 1 };
        let joints = bones.nodes.len();
        let too_long = || GlbError::TooLong { frames, joints };
        if frames > GlbError::MAX_FRAMES {
            return Err(too_long());
        }
        let at_frames: Rc<[f64]> = (0..frames).map(|frame| self.timeline.time(frame)).collect();
        let empty = self.rotations.iter().filter(|track| track.values.is_empty());
        let keys = empty.flat_map(|track| track.times.iter());
        let points = self.translations.iter().chain(&self.scales);
        let keys = keys.chain(points.flat_map(|track| track.times.iter()));
        let mut times: Vec<f64> = at_frames.iter().chain(keys).copied().collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        if times.len().saturating_mul(joints) > GlbError::MAX_SAMPLES {
            return Err(too_long());
        }
        complete(&mut self.rotations, joints, &at_frames);
        complete(&mut self.translations, joints, &at_frames);
        complete(&mut self.scales, joints, &at_frames);
        let mut axes = bones.level_axes();
        let mut turned: Vec<DQuat> = bones.bind_pose.iter().map(|bind| bind.rotation).collect();
        for (done, &time) in times.iter().enumerate() {
            progress.step(done, times.len()).await?;
            let locals = bones.locals(&rig.at(time), &mut axes, Some(time))?;
            for (node, local) in locals.iter().enumerate() {
                turned[node] = same_side(turned[node], local.rotation);
                self.rotations[node].record(time, turned[node].as_quat().to_array());
                self.translations[node].record(time, local.translation.as_vec3().to_array());
                self.scales[node].record(time, local.scale.as_vec3().to_array());
            }
        }
        self.rotations.retain(|track| track.turns(&bones.bind_pose[track.node]));
        let bind_pose = |node: usize| bones.bind_pose[node];
        self.translations.retain(|track| track.differs(bind_pose(track.node).translation));
        self.scales.retain(|track| track.differs(bind_pose(track.node).scale));
        Ok(())
    }
}

/// Adds a track with keys at every frame for each node that has none, and sorts them by node.
fn complete<const N: usize>(kept: &mut Vec<JointTrack<N>>, nodes: usize, frames: &Rc<[f64]>) {
    let track = |node| JointTrack::new(node, frames.clone(), KeyCurve::Linear);
    let mut all: Vec<JointTrack<N>> = (0..nodes).map(track).collect();
    for track in kept.drain(..) {
        let node = track.node;
        all[node] = track;
    }
    *kept = all;
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

/// The curve of the file: lines for keys that all have one of the `straight` interpolations, steps
/// for steps, and cubic splines for other curves. `None` if the file needs a key at every frame.
fn curve(track: &Spline<Vec3>, straight: &[Interpolation]) -> Option<KeyCurve> {
    let (_, before) = track.knots().split_last()?;
    let first = before.first()?.interpolation;
    let is_one = before.iter().all(|knot| knot.interpolation == first);
    match first {
        Interpolation::Step if is_one => Some(KeyCurve::Step),
        _ if is_one && straight.contains(&first) => Some(KeyCurve::Linear),
        _ if before.iter().any(|knot| knot.interpolation == Interpolation::Step) => None,
        _ => Some(KeyCurve::CubicSpline),
    }
}

/// The track of a translation or scale of a node, with the keys of `track`.
fn points(
    node: usize,
    track: &Spline<Vec3>,
    timeline: Timeline,
    to_node: DMat3,
) -> Option<JointTrack<3>> {
    let curve = curve(track, &[Interpolation::Linear, Interpolation::Slerp])?;
    let times = padded(track, timeline)?;
    let slopes = match curve {
        KeyCurve::CubicSpline => {
            times.iter().map(|time| slopes_at(track, *time, to_node)).collect()
        }
        KeyCurve::Linear | KeyCurve::Step => Vec::new(),
    };
    Some(JointTrack { slopes, ..JointTrack::new(node, times.into(), curve) })
}

/// The slopes of a node's translation or scale at a time, arriving and leaving; level where the curve is
/// constant, before the track's first key and after its last.
fn slopes_at(track: &Spline<Vec3>, time: f64, to_node: DMat3) -> [[f32; 3]; 2] {
    let Some(own) = track.slopes(time) else { return [[0.0; 3]; 2] };
    let knots = track.knots();
    let key = knots.partition_point(|knot| knot.time < time);
    let slope = |segment: Option<&[Knot<Vec3>]>, own: Vec3| {
        let Some([from, to]) = segment else { return [0.0; 3] };
        let slope = match from.interpolation {
            Interpolation::Auto | Interpolation::Smooth => own.as_dvec3(),
            Interpolation::Linear | Interpolation::Slerp => {
                (to.value.as_dvec3() - from.value.as_dvec3()) / (to.time - from.time)
            }
            Interpolation::Step => DVec3::ZERO,
        };
        (to_node * slope).as_vec3().to_array()
    };
    [
        slope(key.checked_sub(1).and_then(|it| knots.get(it..=key)), own.arriving),
        slope(knots.get(key..=key + 1), own.leaving),
    ]
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
