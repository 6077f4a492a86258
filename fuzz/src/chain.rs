use std::collections::HashSet;

use glam::{Affine3A, DMat3, DVec3, Mat3, Mat3A, Quat, Vec3};
use ik_arm::kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, Orientation, Report, Root, SolverOptions, jacobian,
};
use ik_arm::kinematics::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton};

use super::bits::Bits;
use super::opened::is_readable;

/// A skeleton of a few joints with targets, of any numbers, by every method: invalid problems are
/// refused with a short message; else the solver moves only the chains of targets, within limits,
/// and reports the true error of the places.
pub fn chain(data: &[u8]) {
    let bits = &mut Bits::new(data);
    let Some(skeleton) = skeleton(bits) else { return };
    let targets = targets(bits, &skeleton);
    let options = options(bits);
    for joint in 0..skeleton.joints().len() {
        let _ = jacobian(&skeleton, JointId::new(joint));
    }
    for method in Method::ALL {
        solve(&skeleton, &targets, &options.with_method(method), bits.finite_vector());
    }
}

fn skeleton(bits: &mut Bits<'_>) -> Option<Skeleton> {
    const MOST: usize = 8;
    let mut joints: Vec<Joint> = Vec::new();
    for index in 0..1 + bits.below(MOST) {
        let joint = joint(bits, index, &joints);
        joints.push(joint);
    }
    let transform = transform(bits);
    let mut skeleton = match Skeleton::from_joints(joints) {
        Ok(skeleton) => skeleton,
        Err(error) => {
            is_readable(&error.to_string());
            return None;
        }
    };
    assert_eq!(skeleton.set_transform(transform).is_ok(), transform.is_finite());
    Some(skeleton)
}

fn joint(bits: &mut Bits<'_>, index: usize, before: &[Joint]) -> Joint {
    let what = bits.byte();
    // Mostly a chain.
    let parent =
        if what & 3 == 0 { bits.below(index + 1).checked_sub(1) } else { index.checked_sub(1) };
    let on_tip = parent.and_then(|parent| before.get(parent)).map(|parent| parent.axis);
    let joint = Joint::new(&format!("joint {index}"), parent.map(JointId::new), bits.vector());
    Joint {
        offset: if what & 4 == 0 { on_tip.unwrap_or_default() } else { bits.vector() },
        rotation: if what & 8 == 0 { Vec3::ZERO } else { bits.vector() },
        frame: if what & 16 == 0 { Mat3::IDENTITY } else { Mat3::from_quat(bits.rotation()) },
        limits: if what & 32 == 0 {
            JointLimits::NONE
        } else {
            JointLimits::new([(); 3].map(|()| limit(bits)))
        },
        locked: what & 192 == 192,
        ..joint
    }
}

fn limit(bits: &mut Bits<'_>) -> Option<Limit> {
    let (one, other) = (bits.number(), bits.number());
    match bits.below(4) {
        0 => None,
        1 => Some(Limit { min: one, max: other }),
        _ => Some(Limit { min: one.min(other), max: one.max(other) }),
    }
}

fn transform(bits: &mut Bits<'_>) -> Affine3A {
    match bits.byte() {
        0..128 => Affine3A::IDENTITY,
        128..160 => bits.matrix(),
        160.. => {
            let (scale, rotation) = (bits.vector(), bits.rotation());
            Affine3A::from_scale_rotation_translation(scale, rotation, bits.vector())
        }
    }
}

fn targets(bits: &mut Bits<'_>, skeleton: &Skeleton) -> Vec<ChainTarget> {
    const MOST: usize = 3;
    // Including one index out of range.
    let places = skeleton.joints().len() + 1;
    let count = 1 + bits.below(MOST);
    let target = |_| {
        let target = ChainTarget::at(JointId::new(bits.below(places)), bits.vector())
            .with_weight(if bits.coin() { 1.0 } else { bits.number() });
        let orientation = match bits.byte() {
            0..32 => Orientation::Rotation(Quat::from_vec4(bits.vector().extend(bits.number()))),
            32..64 => Orientation::Aim { axis: bits.vector(), point: bits.vector() },
            _ => return target,
        };
        let target = target.with_orientation(orientation);
        if bits.coin() { target } else { target.with_orientation_weight(bits.number()) }
    };
    (0..count).map(target).collect()
}

fn options(bits: &mut Bits<'_>) -> SolverOptions {
    const MOST: u8 = 40;
    let mut options = SolverOptions::default();
    let any = bits.byte();
    options.iterations = Some(u32::from(bits.byte() % MOST));
    options.tolerance = (any & 1 == 1).then(|| bits.number());
    if any & 2 != 0 {
        options.damping = bits.number();
    }
    if any & 4 != 0 {
        options.step = bits.number();
    }
    options.root = match any & 24 {
        24 => Root::Free,
        16 => Root::Locked,
        _ => Root::Turns,
    };
    options
}

fn solve(before: &Skeleton, targets: &[ChainTarget], options: &SolverOptions, elsewhere: Vec3) {
    let mut solve = match ChainSolver::new(before, targets, options) {
        Ok(solve) => solve,
        Err(error) => return is_readable(&error.to_string()),
    };
    let mut after = before.clone();
    let mut case = Case { before, options, way: farthest(before, targets) };
    // Roots that are free go near their targets at once.
    solve.write(&mut after);
    case.check(&after, targets, solve.report());
    solve.run();
    assert!(solve.is_over());
    solve.write(&mut after);
    case.check(&after, targets, solve.report());

    let moved: Vec<_> =
        targets.iter().map(|target| ChainTarget { point: elsewhere, ..*target }).collect();
    solve.retarget(&moved).expect("the same joints");
    solve.run();
    solve.write(&mut after);
    case.check(&after, &moved, solve.report());
}

/// Input of a solver run.
struct Case<'a> {
    before: &'a Skeleton,
    options: &'a SolverOptions,
    /// Largest distance of roots and targets from the origin, in world space.
    way: f64,
}

impl Case<'_> {
    fn check(&mut self, after: &Skeleton, targets: &[ChainTarget], report: Report) {
        let Self { before, options, .. } = *self;
        let is_free = options.root == Root::Free;
        let on_path: HashSet<JointId> =
            targets.iter().flat_map(|target| before.ancestors(target.joint)).collect();
        for ((joint, was), is) in before.iter().zip(after.joints()) {
            let by = options.method;
            assert!(is.rotation.is_finite() && is.offset.is_finite(), "{by:?}: {is:?}");
            assert_eq!(is.limits.project(is.rotation), is.rotation, "{by:?}: {is:?}");
            let may_move = is_free && is.parent.is_none() && on_path.contains(&joint);
            let is_locked = was.locked || (options.root == Root::Locked && was.parent.is_none());
            let may_turn = !is_locked && on_path.contains(&joint);
            let offset = if may_move { is.offset } else { was.offset };
            let rotation = if may_turn { is.rotation } else { was.rotation };
            assert_eq!(**is, Joint { offset, rotation, ..was.clone() }, "{by:?}");
            is_rigid(is);
        }
        // A root that has gone far and come back has the seven digits that it had there.
        self.way = self.way.max(farthest(after, targets));
        is_truth(after, targets, report, if is_free { self.way } else { 0.0 });
    }
}

fn farthest(skeleton: &Skeleton, targets: &[ChainTarget]) -> f64 {
    let roots = skeleton.joints().iter().filter(|joint| joint.parent.is_none());
    let scale = scale(skeleton);
    let roots = roots.map(|root| scale * root.offset.as_dvec3().length());
    roots.chain(targets.iter().map(|target| target.point.as_dvec3().length())).fold(0.0, f64::max)
}

/// Upper bound of the scale: the Frobenius norm of the transform.
fn scale(skeleton: &Skeleton) -> f64 {
    let matrix = skeleton.transform().matrix3.as_dmat3();
    matrix.to_cols_array().into_iter().fold(0.0, f64::hypot)
}

/// A bone keeps its length under any rotation.
fn is_rigid(joint: &Joint) {
    let turn = joint.local_rotation();
    let squared = turn.transpose() * turn;
    assert!(squared.abs_diff_eq(Mat3A::IDENTITY, 1e-5), "{joint:?} is turned by {turn}");
}

/// The reported error is the distance from tips to targets, within rounding. Angles of many
/// turns leave few digits for their fraction.
fn is_truth(skeleton: &Skeleton, targets: &[ChainTarget], report: Report, way: f64) {
    const COARSE: f64 = 1e-6;
    const FEW_TURNS: f32 = 100.0;
    assert!((0.0..=f32::MAX).contains(&report.error), "{report:?}");
    if skeleton.joints().iter().any(|joint| joint.rotation.abs().max_element() > FEW_TURNS) {
        return;
    }
    let placed = targets.iter().filter(|target| target.weight > 0.0);
    let twins: Vec<_> = placed.map(|target| Twin::new(skeleton, target)).collect();
    let error = twins.iter().map(|twin| twin.error).fold(0.0, f64::max);
    let blur = twins.iter().map(|twin| twin.blur).fold(0.0, f64::max);
    let off = (error.min(f64::from(f32::MAX)) - f64::from(report.error)).abs();
    // The smallest step of a root's coordinates may be large in world space.
    let least = f64::from(f32::from_bits(2)) * scale(skeleton).max(1.0);
    assert!(
        off <= TRUE * (error + blur) + COARSE * way + least,
        "{error} away, {blur} long: {report:?} of {targets:?} and {skeleton:?}"
    );
}

/// Allowed error relative to a length.
const TRUE: f64 = 1e-4;

/// A tip and its target by the formulas, in f64.
struct Twin {
    error: f64,
    /// Longest path from the root to the tip in world space, and its f64 rounding.
    blur: f64,
}

impl Twin {
    fn new(skeleton: &Skeleton, target: &ChainTarget) -> Self {
        let joints = skeleton.joints();
        let mut path: Vec<_> =
            skeleton.ancestors(target.joint).map(|joint| &joints[joint.index()]).collect();
        path.reverse();
        let mut turn = DMat3::IDENTITY;
        // From the root: it may be far from all else.
        let (mut at, mut length) = (DVec3::ZERO, 0.0);
        for (index, joint) in path.iter().enumerate() {
            if index > 0 {
                at += turn * joint.offset.as_dvec3();
                length += joint.offset.as_dvec3().length();
            }
            turn *= local(joint);
        }
        let axis = joints[target.joint.index()].axis.as_dvec3();
        let matrix = skeleton.transform().matrix3.as_dmat3();
        let root = path.first().map_or(DVec3::ZERO, |root| matrix * root.offset.as_dvec3());
        let origin = skeleton.transform().translation.as_dvec3();
        let asked = target.point.as_dvec3();
        let error = (matrix * (at + turn * axis) + (root + (origin - asked))).length();
        let rounding = f64::EPSILON * (root.length() + origin.length() + asked.length()) / TRUE;
        Self { error, blur: scale(skeleton) * (length + axis.length()) + rounding }
    }
}

/// R.
fn local(joint: &Joint) -> DMat3 {
    let DVec3 { x, y, z } = joint.rotation.as_dvec3();
    let turned = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    let frame = joint.frame.as_dmat3();
    frame * turned * frame.transpose()
}
