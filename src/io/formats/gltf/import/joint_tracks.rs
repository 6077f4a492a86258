//! The motions of joints, and their samples at frames.

use glam::{DAffine3, DMat3, DVec3, Mat3, Vec3};

use super::animations::NodeTracks;
use super::nodes::{NodeTransform, NodeTree, SkinJoints, at_node};
use crate::document::{Channel, Keys};
use crate::io::formats::gltf::frame;
use crate::io::json::FieldError;
use crate::kinematics::skeleton::{Joint, JointId, SkinStretch, exact_angles};
use crate::kinematics::spline::{Interpolation, Knot, Spline};

/// The placement of a joint in the world, in metres.
#[derive(Clone, Copy)]
pub struct JointPlacement {
    pub base: DVec3,
    /// The joint's axes, orthonormalized.
    pub frame: DMat3,
    /// The axes by which it moves the skin, of any length and angle.
    pub skin: DMat3,
}

/// Computes the placements of the joints from the transforms of their nodes and of all ancestors.
pub struct NodePoser<'a> {
    nodes: &'a NodeTree,
    joints: &'a SkinJoints,
    /// The nodes of the joints and their ancestors, parents before their children.
    needed: Vec<usize>,
    locals: Vec<NodeTransform>,
    worlds: Vec<DAffine3>,
}

impl<'a> NodePoser<'a> {
    pub fn new(nodes: &'a NodeTree, joints: &'a SkinJoints) -> Self {
        let is_needed = nodes.with_ancestors(joints.skin_nodes.iter().copied());
        Self {
            nodes,
            joints,
            needed: nodes.order.iter().copied().filter(|node| is_needed[*node]).collect(),
            locals: nodes.locals.clone(),
            worlds: vec![DAffine3::IDENTITY; nodes.parents.len()],
        }
    }

    /// The node of each joint.
    pub fn joints(&self) -> &[usize] {
        &self.joints.nodes
    }

    /// Number of nodes that are posed.
    pub fn len(&self) -> usize {
        self.needed.len()
    }

    /// Placements of the joints in the bind pose.
    pub fn bind_pose(&mut self) -> Result<Vec<JointPlacement>, FieldError> {
        self.placements()
    }

    /// Placements of the joints in the animation `tracks` at `time`, in seconds.
    pub fn at(
        &mut self,
        tracks: &NodeTracks<'_>,
        time: f64,
    ) -> Result<Vec<JointPlacement>, FieldError> {
        tracks.pose(time, &mut self.locals);
        self.placements()
    }

    fn placements(&mut self) -> Result<Vec<JointPlacement>, FieldError> {
        for &node in &self.needed {
            let parent = self.nodes.parents[node];
            let parent_world = parent.map_or(DAffine3::IDENTITY, |parent| self.worlds[parent]);
            self.worlds[node] = parent_world * self.locals[node].affine();
        }
        let placement = |(node, skin_node): (&usize, &usize)| {
            let DAffine3 { matrix3, translation: base } = self.worlds[*node];
            if !base.as_vec3().is_finite() {
                let reason = "must be within ±3.4028235e38 m in the world";
                return Err(FieldError::new(at_node(*node), reason));
            }
            let skin = self.worlds[*skin_node].matrix3;
            Ok(JointPlacement { base, frame: frame(matrix3.y_axis, matrix3.x_axis), skin })
        };
        self.joints.nodes.iter().zip(&self.joints.skin_nodes).map(placement).collect()
    }
}

/// The keys of a joint; a spline without knots if the value is constant.
#[derive(Clone, Debug, Default)]
pub struct JointTracks {
    /// Angles about x, y and z in radians.
    pub rotation: Spline<Vec3>,
    pub offset: Spline<Vec3>,
    pub skin: StretchTracks,
    /// The frame of the angles relative to the node; `None` for the node's axes.
    pub frame: Option<Mat3>,
}

/// The keys of the stretch of a joint's skin.
#[derive(Clone, Debug, Default)]
pub struct StretchTracks {
    pub scale: Spline<Vec3>,
    pub shear: Spline<Vec3>,
}

/// Changes below this count as rounding errors: in radians for an angle, relative to its length for
/// an offset.
const LEAST: f32 = 1e-6;

impl JointTracks {
    /// Returns whether the joint turns.
    pub fn turns(&self) -> bool {
        changes(&self.rotation, |_| 2.0 * LEAST)
    }

    /// Returns whether the joint changes how it stretches the skin: its scale, and its shear.
    pub fn stretches(&self) -> [bool; 2] {
        [&self.skin.scale, &self.skin.shear].map(|track| changes(track, |_| LEAST))
    }

    /// Returns whether the joint's offset changes. `size` is the length of the skeleton's longest
    /// offset.
    pub fn moves(&self, size: f32) -> bool {
        changes(&self.offset, |first| LEAST * first.length().max(1e-3 * size))
    }
}

/// Returns whether a value changes by more than `least` of its first key, or a slope leads away
/// from it.
fn changes(track: &Spline<Vec3>, least: impl Fn(Vec3) -> f32) -> bool {
    let Some(first) = track.knots().first().map(|knot| knot.value) else { return false };
    let least = least(first);
    let leads_away = |knot: &Knot<Vec3>| {
        let slopes = knot.slopes.iter().flat_map(|it| [it.arriving, it.leaving]);
        track.knots().len() > 1 && slopes.into_iter().any(|slope| slope.length() > least)
    };
    track.knots().iter().any(|knot| knot.value.distance(first) > least || leads_away(knot))
}

/// The tracks of a joint as far as they are those of its node; `None` for those that depend on
/// scales that are uneven or change.
pub struct ExactJoint {
    pub rotation: Option<Spline<Vec3>>,
    pub offset: Option<Spline<Vec3>>,
    pub skin: Option<StretchTracks>,
    /// See [`JointTracks::frame`].
    pub frame: Option<Mat3>,
}

impl ExactJoint {
    pub fn is_complete(&self) -> bool {
        self.rotation.is_some() && self.offset.is_some() && self.skin.is_some()
    }
}

/// Completes the tracks of all joints by keys at the `times`, in seconds and ascending: offsets that
/// bring joints to their places under the rotations that their parents have, angles unwrapped from
/// one time to the next, and stretches of the skin for what rotations and offsets leave.
pub fn sample(
    poser: &mut NodePoser<'_>,
    tracks: &NodeTracks<'_>,
    times: &[f64],
    joints: &[Joint],
    exact: Vec<ExactJoint>,
    bind_pose: &[JointPlacement],
) -> Result<Vec<JointTracks>, FieldError> {
    let mut keys = Keys::default();
    let sampled_by = exact.iter().enumerate().filter(|_| !times.is_empty());
    for (index, of_node) in sampled_by {
        if let Some(rotation) = &of_node.rotation {
            keys.set_track(Channel::Rotation(JointId::new(index)), rotation.clone());
        }
    }
    // The turn that a joint with tracks of its node has against its parent, in world axes.
    let turn = |index: usize, time: f64| {
        let ExactJoint { rotation: Some(_), frame, .. } = &exact[index] else { return None };
        let angles = keys.value(Channel::Rotation(JointId::new(index)), time).unwrap_or_default();
        let frame = (joints[index].frame * frame.unwrap_or(Mat3::IDENTITY)).as_dmat3();
        Some(frame * exact_angles::matrix(angles.as_dvec3()) * frame.transpose())
    };
    let mut sampled: Vec<SampledJoint> = joints.iter().map(|_| SampledJoint::default()).collect();
    for &time in times {
        let placements = poser.at(tracks, time)?;
        let mut rotations: Vec<DMat3> = Vec::with_capacity(joints.len());
        for (index, (joint, now)) in joints.iter().zip(&placements).enumerate() {
            let (above, origin) = match joint.parent {
                Some(parent) => (rotations[parent.index()], placements[parent.index()].base),
                None => (DMat3::IDENTITY, DVec3::ZERO),
            };
            let offset = (above.transpose() * (now.base - origin)).as_vec3();
            if !offset.is_finite() {
                let reason = "must be within ±3.4028235e38 m of its parent";
                return Err(FieldError::new(at_node(poser.joints()[index]), reason));
            }
            let own = turn(index, time).map(|turn| above * turn);
            let rotation = own.unwrap_or(now.frame * bind_pose[index].frame.transpose());
            rotations.push(rotation);
            let of_joint = &mut sampled[index];
            let knot = |interpolation, value| Knot { interpolation, ..Knot::new(time, value) };
            let frame = bind_pose[index].frame;
            if exact[index].rotation.is_none() {
                let local = frame.transpose() * (above.transpose() * rotation) * frame;
                of_joint.last = exact_angles::nearest(local, of_joint.last);
                of_joint.rotation.push(knot(Interpolation::Slerp, of_joint.last.as_vec3()));
            }
            if exact[index].offset.is_none() {
                of_joint.offset.push(knot(Interpolation::Linear, offset));
            }
            if exact[index].skin.is_none() {
                let frame = frame * exact[index].frame.unwrap_or(Mat3::IDENTITY).as_dmat3();
                let stretch = stretch(&bind_pose[index], now, rotation, frame);
                of_joint.scale.push(knot(Interpolation::Linear, stretch.scale));
                of_joint.shear.push(knot(Interpolation::Linear, stretch.shear));
            }
        }
    }
    let complete = |(exact, sampled): (ExactJoint, SampledJoint)| JointTracks {
        rotation: exact.rotation.unwrap_or_else(|| sampled.rotation.into_iter().collect()),
        offset: exact.offset.unwrap_or_else(|| sampled.offset.into_iter().collect()),
        skin: exact.skin.unwrap_or_else(|| StretchTracks {
            scale: sampled.scale.into_iter().collect(),
            shear: sampled.shear.into_iter().collect(),
        }),
        frame: exact.frame,
    };
    Ok(exact.into_iter().zip(sampled).map(complete).collect())
}

/// How a joint stretches the skin in its `frame`, if it has turned by `rotation` since the bind pose: all
/// that its node does to the skin beyond that. None, if the skin is flat in the bind pose.
fn stretch(
    bind: &JointPlacement,
    now: &JointPlacement,
    rotation: DMat3,
    frame: DMat3,
) -> SkinStretch {
    let local = (rotation * frame).transpose() * now.skin * bind.skin.inverse() * frame;
    let stretch = SkinStretch::of_matrix(local);
    let is_finite = stretch.scale.is_finite() && stretch.shear.is_finite();
    if is_finite { stretch } else { SkinStretch::NONE }
}

/// The keys of a joint at times that were sampled so far.
#[derive(Default)]
struct SampledJoint {
    rotation: Vec<Knot<Vec3>>,
    offset: Vec<Knot<Vec3>>,
    scale: Vec<Knot<Vec3>>,
    shear: Vec<Knot<Vec3>>,
    /// The angles at the last time, in radians.
    last: DVec3,
}
