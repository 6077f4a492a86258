use glam::{DMat3, DVec3, Mat3A};

use super::joint_tracks::JointTracks;
use super::node_poser::{JointPlacement, NodePoser};
use super::nodes::at_node;
use super::tracks::NodeTracks;
use crate::document::Timeline;
use crate::io::json::FieldError;
use crate::kinematics::skeleton::Joint;

/// Samples the motions of all joints in the first `frames` frames of `timeline`: keys at every frame,
/// with angles unwrapped from frame to frame. Leaves the angles of the last frame in `joints`.
pub fn sample(
    poser: &mut NodePoser<'_>,
    tracks: &NodeTracks<'_>,
    timeline: Timeline,
    frames: usize,
    joints: &mut [Joint],
    bind_pose: &[JointPlacement],
) -> Result<Vec<JointTracks>, FieldError> {
    let mut motions: Vec<JointTracks> = joints.iter().map(|_| JointTracks::default()).collect();
    for frame in 0..frames {
        let time = timeline.time(frame);
        let placements = poser.at(tracks, time)?;
        let rotations: Vec<DMat3> = placements
            .iter()
            .zip(bind_pose)
            .map(|(now, bind)| now.frame * bind.frame.transpose())
            .collect();
        for (index, motion) in motions.iter_mut().enumerate() {
            let joint = &mut joints[index];
            let (parent_inverse, origin) = match joint.parent {
                Some(parent) => {
                    (rotations[parent.index()].transpose(), placements[parent.index()].base)
                }
                None => (DMat3::IDENTITY, DVec3::ZERO),
            };
            let offset = (parent_inverse * (placements[index].base - origin)).as_vec3();
            if !offset.is_finite() {
                let reason = "must be within ±3.4028235e38 m of its parent";
                return Err(FieldError::new(at_node(poser.joints()[index]), reason));
            }
            // Unwrapped: the angles nearest to those of the previous frame.
            joint.rotation =
                joint.angles_of(Mat3A::from((parent_inverse * rotations[index]).as_mat3()));
            motion.rotation.insert(time, joint.rotation);
            motion.offset.insert(time, offset);
        }
    }
    Ok(motions)
}
