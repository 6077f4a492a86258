//! Poses a humanoid by its hands, feet, head and pelvis:
//!
//! ```text
//! cargo run --release --example humanoid
//! ```
//!
//! All of it is one skeleton and one list of targets: places for the wrists, the ankles and the
//! pelvis, and a point at which the head looks. The spine is stiff, so that the arms go first.
//! Lengths are in metres; +y is up, and the figure looks along +z.

use glam::Vec3;
use ik_arm_kinematics::chain_ik::{
    ChainTarget, Method, Orientation, Root, SolveError, SolverOptions, solve,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonError};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut human = Skeleton::default();
    let pelvis = add(&mut human, "pelvis", None, Vec3::Y * 0.95, Vec3::ZERO)?;
    let spine = add(&mut human, "spine", Some(pelvis), Vec3::ZERO, Vec3::Y * 0.5)?;
    let head = add(&mut human, "head", Some(spine), Vec3::Y * 0.5, Vec3::Y * 0.25)?;
    human.change(spine, |spine| spine.stiffness = Vec3::splat(0.6))?;
    let mut ends = Vec::new();
    for (name, side) in [("left", 1.0), ("right", -1.0)] {
        let (shoulder, hip) = (Vec3::new(0.2 * side, 0.45, 0.0), Vec3::new(0.1 * side, -0.05, 0.0));
        let arm = [Vec3::new(0.1 * side, -0.3, 0.05), Vec3::new(0.05 * side, -0.22, 0.1)];
        let leg = [Vec3::new(0.0, -0.44, 0.04), Vec3::new(0.0, -0.42, -0.04)];
        for (limb, parent, base, bones) in
            [("arm", spine, shoulder, arm), ("leg", pelvis, hip, leg)]
        {
            let upper = format!("{name} upper {limb}");
            let upper = add(&mut human, &upper, Some(parent), base, bones[0])?;
            let lower = format!("{name} lower {limb}");
            ends.push(add(&mut human, &lower, Some(upper), bones[0], bones[1])?);
        }
    }
    let [left_hand, left_foot, right_hand, right_foot] = ends[..] else { return Ok(()) };

    // Both hands go to a box on the floor, at which the head looks; the feet stay.
    let target = Vec3::new(0.0, 0.25, 0.55);
    let targets = [
        ChainTarget::at(pelvis, Vec3::new(0.0, 0.75, -0.1)).with_weight(0.1),
        ChainTarget::at(left_hand, target + 0.15 * Vec3::X),
        ChainTarget::at(right_hand, target - 0.15 * Vec3::X),
        ChainTarget::at(left_foot, human.tip(left_foot)),
        ChainTarget::at(right_foot, human.tip(right_foot)),
        ChainTarget::turned(head, Orientation::Aim { axis: Vec3::Z, point: target }),
    ];
    let options = SolverOptions::new(Method::DampedLeastSquares).with_root(Root::Free);
    report(&mut human, &targets, &options)?;
    Ok(())
}

fn add(
    human: &mut Skeleton,
    name: &str,
    parent: Option<JointId>,
    offset: Vec3,
    axis: Vec3,
) -> Result<JointId, SkeletonError> {
    human.add(Joint { offset, ..Joint::new(name, parent, axis) })
}

fn report(
    human: &mut Skeleton,
    targets: &[ChainTarget],
    options: &SolverOptions,
) -> Result<(), SolveError> {
    let report = solve(human, targets, options)?;
    println!("{} after {} iterations", report.status, report.iterations);
    for target in targets.iter().filter(|target| target.weight > 0.0) {
        let missed = human.tip(target.joint).distance(target.point);
        println!("{:16} {:.2} missed by {missed:.4}", human[target.joint].name, target.point);
    }
    println!("the head misses its aim by {:.2} rad", report.orientation_error);
    Ok(())
}
