//! A small bend for chains that lie on one line with their target: there no joint has a moment, and
//! every method would stay as it is.

use glam::{Vec3, Vec3A};

use super::configuration::Configuration;
use super::problem::Problem;
use crate::kinematics::normalize;
use crate::kinematics::skeleton::within;

/// Radians, shared by the joints of a path.
const BEND: f32 = 0.5;

pub(super) fn is_stuck(rig: &Problem, pose: &Configuration) -> bool {
    (0..rig.goals.len()).any(|goal| stuck(rig, pose, goal, path(rig, goal)).is_some())
}

/// Bends what is stuck: angles only.
pub(super) fn bend(rig: &Problem, pose: &mut Configuration) {
    for goal in 0..rig.goals.len() {
        let Some(line) = stuck(rig, pose, goal, path(rig, goal)) else { continue };
        let by = BEND / path(rig, goal).count() as f32;
        for body in path(rig, goal) {
            bend_body(rig, pose, body, line, by);
        }
    }
}

/// From the body that carries a goal's tip to the root.
fn path(rig: &Problem, goal: usize) -> impl Iterator<Item = usize> + Clone + '_ {
    std::iter::successors(rig.goals[goal].body, |body| rig.bodies[*body].parent)
}

/// The line that a path and its target lie on, unless the path is stretched towards a target
/// beyond.
fn stuck(
    rig: &Problem,
    pose: &Configuration,
    index: usize,
    path: impl Iterator<Item = usize> + Clone,
) -> Option<Vec3A> {
    // In lengths: nearer to a line than this, methods leave it slowly.
    const STRAIGHT: f32 = 1e-3;
    let (goal, tip) = (&rig.goals[index], pose.tips[index]);
    let base = pose.bases[path.clone().last()?];
    let points = path.map(|body| pose.bases[body]).chain([tip]).map(|point| point - base);
    let farthest = points
        .clone()
        .max_by(|one, other| one.length_squared().total_cmp(&other.length_squared()))?;
    let line = normalize(farthest)?;
    let reach = farthest.length();
    let is_beside = |point: Vec3A| {
        point.reject_from_normalized(line).length() > STRAIGHT * reach.max(point.length())
    };
    if points.clone().any(is_beside) || is_beside(goal.point - base) {
        return None;
    }
    (!is_stretched(rig, index, line, tip, base)).then_some(line)
}

fn is_stretched(rig: &Problem, index: usize, line: Vec3A, tip: Vec3A, base: Vec3A) -> bool {
    // In lengths: what a chain as near to its line as counts as straight may be short of.
    const STRETCHED: f32 = 1e-3;
    let goal = &rig.goals[index];
    let inner = path(rig, index).filter(|body| rig.bodies[*body].parent.is_some());
    let bones: f32 = inner.map(|body| rig.bodies[body].pivot.length()).sum();
    let reached = (tip - base).dot(line);
    let beyond = (goal.point - base).dot(line);
    reached >= (bones + goal.tip.length()) * (1.0 - STRETCHED) && beyond >= reached
}

/// Turns a body by the angle that swings the line most: all of them as far as limits let it.
pub(super) fn bend_body(
    rig: &Problem,
    pose: &mut Configuration,
    body: usize,
    line: Vec3A,
    by: f32,
) {
    let (limits, angles) = (&rig.bodies[body].limits, pose.angles[body]);
    let mut best = (0.0, angles);
    for (axis, unit) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        let swing = pose.axes[body].col(axis).cross(line).length();
        for side in [by, -by] {
            let bent = within(limits, angles + unit * side);
            let swung = swing * (bent - angles).length();
            // A shade more, so that rounding does not choose.
            if swung > best.0 * 1.01 {
                best = (swung, bent);
            }
        }
    }
    pose.angles[body] = best.1;
}
