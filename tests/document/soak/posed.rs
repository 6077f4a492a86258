//! Checks of poses in f64: lengths, reach, and references to joints and targets.

use glam::{DMat3, Vec3};
use ik_arm::kinematics::skeleton::{JointId, Skeleton, SkeletonPose};
use ik_arm::kinematics::two_bone::Reach;
use ik_arm::rig::{LimbFrames, SkeletonRig};
use ik_arm::session::{Drag, Playback, PointDrag, Session, SolverRun, TurnDrag};

use crate::soak::{Broken, hold};

/// Half an ulp of a number near 1.
const U: f64 = f32::EPSILON as f64 / 2.0;

pub fn all(session: &Session) -> Result<(), Broken> {
    for target in &session.rig().targets {
        session.posed().limb_frames(target.joint).as_ref().map_or(Ok(()), limb)?;
    }
    joints(session.posed().skeleton(), session.skeleton_pose())?;
    places(session)
}

fn limb(limb: &LimbFrames) -> Result<(), Broken> {
    let pose = limb.pose();
    let numbers = [pose.distance, pose.along, pose.out, pose.twist, pose.stretch];
    let are_finite = numbers.into_iter().all(f32::is_finite);
    hold!(
        are_finite && pose.elbow.is_finite() && pose.hand.is_finite(),
        "the limb is finite: {pose:?}"
    );
    let pointer = pose.pointer;
    hold!(
        pointer.direction.is_finite() && pointer.heading.is_finite(),
        "the limb faces: {pointer:?}"
    );
    lengths(limb)?;
    reach(limb)
}

/// |elbow| = σ d₁ and |hand − elbow| = σ d₂ to 3e-7·L, unless they overflow.
fn lengths(limb: &LimbFrames) -> Result<(), Broken> {
    const EXACT: f64 = 3e-7;
    let pose = limb.pose();
    let bones = limb.bones().stretched(pose.stretch);
    let [upper, lower] = [bones.upper(), bones.lower()].map(f64::from);
    let sum = upper + lower;
    if sum > f64::from(f32::MAX) * 0.4 {
        return Ok(());
    }
    let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
    let within = EXACT * sum + f64::from(f32::MIN_POSITIVE);
    let off = (elbow.length() - upper).abs().max((elbow.distance(hand) - lower).abs());
    hold!(off <= within, "limbs keep their lengths: off by {:e} of L: {limb:?}", off / sum);
    Ok(())
}

/// Checks the reported reach, with ε = 1e-6·L.
fn reach(limb: &LimbFrames) -> Result<(), Broken> {
    let (pose, cursor) = (limb.pose(), limb.posed.cursor);
    let [upper, lower] = [limb.bones().upper(), limb.bones().lower()].map(f64::from);
    let near = (1e-6 + 8.0 * U) * (upper + lower) + f64::from(f32::MIN_POSITIVE);
    let missed = pose.hand.as_dvec3().distance(cursor.as_dvec3());
    let is_reached = pose.reach == Some(Reach::Reached);
    let asked = cursor.as_dvec3().length();
    let rounding = 4.0 * U * asked;
    hold!(!is_reached || missed <= near + rounding, "reached is there: {missed:e} {limb:?}");
    let is_hard = limb.posed.ik.soft_reach.is_hard();
    let is_exact = limb.posed.influence == 1.0 && is_hard && !limb.is_limited();
    let is_there = !is_reached || pose.hand == cursor;
    hold!(!is_exact || is_there, "a hard hand is the cursor bit for bit: {limb:?}");
    let [inner, outer] = [limb.range.inner, limb.range.outer].map(f64::from);
    let is_clear = asked > inner * (1.0 + 1e-6) && asked < outer * (1.0 - 1e-6);
    let is_possible = !is_exact || !is_clear || is_reached;
    hold!(is_possible, "what can be reached is: {limb:?}");
    Ok(())
}

fn joints(skeleton: &Skeleton, pose: &SkeletonPose) -> Result<(), Broken> {
    let joints = skeleton.joints();
    hold!(pose.len() == joints.len(), "every joint is posed");
    let stand =
        DMat3::from_cols_array(&skeleton.transform().matrix3.to_cols_array().map(f64::from));
    let back = (stand.determinant().abs() > 1e-30).then(|| stand.inverse());
    let size = |m: DMat3| m.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    for (index, joint) in joints.iter().enumerate() {
        let (base, tip) = (pose.base(JointId::new(index)), pose.tip(JointId::new(index)));
        hold!(base.is_finite() && tip.is_finite(), "{:?} is somewhere: {base} {tip}", joint.name);
        let Some(back) = back else { continue };
        let [base, tip] = [base, tip].map(Vec3::as_dvec3);
        let farthest = f64::from(f32::MAX) * 0.1;
        if base.abs().max(tip.abs()).max_element() > farthest {
            continue;
        }
        let (bone, length) = (back * (tip - base), joint.axis.as_dvec3().length());
        let coarse = 8.0 * U * base.abs().max(tip.abs()).max_element() * 3.0 * size(back);
        // A product of rotations is a rotation up to one rounding each.
        let depth = skeleton.ancestors(JointId::new(index)).count() as f64;
        let skew = 4.0 * size(stand) * size(back) * (4.0 + depth) * U * length;
        // Numbers below the least normal one are rounded to multiples of the least of all.
        let tiny = 8.0 * f64::from(f32::from_bits(1)) * (1.0 + size(back));
        let off = (bone.length() - length).abs();
        hold!(
            off <= coarse + skew + tiny,
            "{:?} is as long as it is: off by {off:e} of {length}",
            joint.name
        );
    }
    Ok(())
}

/// Every reference to a joint, target or key exists.
fn places(session: &Session) -> Result<(), Broken> {
    let joints = session.skeleton().joints().len();
    hold!(
        session.selection().joints().iter().all(|joint| *joint < JointId::new(joints)),
        "selected joints are there"
    );
    hold!(
        session.selection().hovered().is_none_or(|joint| joint < JointId::new(joints)),
        "the joint pointed at is there"
    );
    let document = session.document();
    for (channel, time) in session.selection().keys() {
        let key = document.keys.track(*channel).and_then(|track| track.get(*time));
        hold!(key.is_some(), "the selected key {channel:?} at {time} is there");
    }
    for channel in session.selection().channels() {
        hold!(channel.value(document).is_some(), "the selected channel {channel:?} is there");
    }
    hold!(
        session.playback().time().is_finite(),
        "the time is finite: {}",
        session.playback().time()
    );
    let (slowest, fastest) = Playback::SPEEDS;
    hold!(
        (slowest..=fastest).contains(&session.playback().speed()),
        "the speed is one: {}",
        session.playback().speed()
    );
    let held = session.history().point_drag().map_or(Vec3::ZERO, PointDrag::moved);
    let turned = session.history().drag().and_then(Drag::turn).map_or(0.0, TurnDrag::turned);
    hold!(held.is_finite() && turned.is_finite(), "what is held is somewhere: {held} {turned}");
    session.solvers().runs().try_for_each(solver_run)
}

fn solver_run(run: &SolverRun) -> Result<(), Broken> {
    let errors = run.iterates().iter().all(|it| it.error.is_finite() && it.error >= 0.0);
    hold!(errors && run.report().error.is_finite(), "a solver knows how far it is off");
    let latest = run.iterates().latest().iteration;
    hold!(latest == run.report().iterations, "the latest iterate is kept");
    hold!(run.shown().iteration <= latest, "the shown iterate is one of them");
    let of_iterate = || run.shown().joints().collect::<Vec<_>>();
    let of_part = |part: usize| {
        let joints = run.parts()[part].pose.joints().iter();
        joints.map(|joint| (joint.rotation, joint.offset)).collect()
    };
    let expected = run.shown_part().map_or_else(of_iterate, of_part);
    let mut is_posed = run.skeleton().joints().iter().zip(expected);
    let is_posed = is_posed.all(|(joint, local)| (joint.rotation, joint.offset) == local);
    hold!(is_posed, "the ghost has the angles of the shown iterate, or of its shown part");
    Ok(())
}

/// An applied pose turns no locked joint, but those that follow a path.
pub fn locked(before: &SkeletonRig, after: &Skeleton) -> Result<(), Broken> {
    let heads = before.follow_paths.iter();
    let following: Vec<JointId> = heads.flat_map(|path| before.path_joints(path.root)).collect();
    for ((id, before), after) in before.skeleton.iter().zip(after.joints()) {
        let bits = |v: Vec3| v.to_array().map(f32::to_bits);
        let has_turned = bits(before.rotation) != bits(after.rotation);
        let is_held = before.locked && !following.contains(&id);
        hold!(!(is_held && has_turned), "{:?} is locked and does not turn", before.name);
        let is_same = before.axis == after.axis && before.name == after.name;
        hold!(is_same && before.limits == after.limits, "a solver only turns {:?}", before.name);
    }
    Ok(())
}
