//! Brings the hand of a made-up skeleton to a target by turning two of its joints:
//!
//! ```text
//! cargo run --example two_bone_job
//! ```

use glam::{Affine3A, Quat, Vec3};
use ik_arm_kinematics::job::TwoBoneJob;

/// A joint: its parent, and its transform in the parent's space.
struct Joint(&'static str, Option<usize>, Quat, Vec3);

/// Each joint's matrix in the model's space: its parent's · its own.
fn forward(joints: &[Joint]) -> Vec<Affine3A> {
    joints.iter().fold(Vec::new(), |mut model, Joint(_, parent, turn, offset)| {
        let parent = parent.map_or(Affine3A::IDENTITY, |parent| model[parent]);
        model.push(parent * Affine3A::from_rotation_translation(*turn, *offset));
        model
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut joints = [
        Joint("spine", None, Quat::from_rotation_y(0.3), Vec3::new(0.0, 1.2, 0.0)),
        Joint("shoulder", Some(0), Quat::from_rotation_z(-0.9), Vec3::new(0.2, 0.2, 0.0)),
        Joint("elbow", Some(1), Quat::from_rotation_z(0.4), Vec3::new(0.3, 0.0, 0.0)),
        Joint("hand", Some(2), Quat::IDENTITY, Vec3::new(0.25, 0.0, 0.0)),
    ];
    let (shoulder, elbow, hand) = (1, 2, 3);
    let target = Vec3::new(0.3, 1.5, 0.4);

    let model = forward(&joints);
    let job = TwoBoneJob::new(model[shoulder], model[elbow], model[hand], target);
    let correction = TwoBoneJob { pole: Some(Vec3::NEG_Y), ..job }.run()?;
    joints[shoulder].2 *= correction.start_correction;
    joints[elbow].2 *= correction.middle_correction;

    println!("the hand is asked to be at {target}: {:?}", correction.reach);
    for (Joint(name, ..), (before, after)) in joints.iter().zip(model.iter().zip(forward(&joints)))
    {
        println!("{name:>8}  {:.4} → {:.4}", before.translation, after.translation);
    }
    Ok(())
}
