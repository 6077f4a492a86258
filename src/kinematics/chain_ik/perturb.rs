//! A small bend for chains that lie on one line with their target. There no joint has a moment, and
//! no method can start.

use glam::{Vec3, Vec3A};

use super::configuration::Configuration;
use super::problem::Problem;
use crate::kinematics::normalize;
use crate::kinematics::skeleton::clamp_to_limits;

/// Total angle of a bend in radians, distributed over the joints of a path.
const BEND: f32 = 0.5;

/// Whether any path from a root to a tip lies on one line with its target, so that no method can
/// start.
pub(super) fn is_stuck(problem: &Problem, config: &Configuration) -> bool {
    (0..problem.effectors.len())
        .any(|effector| stuck_line(problem, config, effector, path(problem, effector)).is_some())
}

/// Bends the paths that lie on one line with their targets. Changes only the configuration's
/// angles.
pub(super) fn bend(problem: &Problem, config: &mut Configuration) {
    for effector in 0..problem.effectors.len() {
        let Some(line) = stuck_line(problem, config, effector, path(problem, effector)) else {
            continue;
        };
        let by = BEND / path(problem, effector).count() as f32;
        for link in path(problem, effector) {
            bend_link(problem, config, link, line, by);
        }
    }
}

/// Indices of the links from the end effector's link up to the root's.
fn path(problem: &Problem, effector: usize) -> impl Iterator<Item = usize> + Clone + '_ {
    std::iter::successors(problem.effectors[effector].link, |link| problem.links[*link].parent)
}

/// Direction of the line on which a path and its target lie; `None` if there is no such line, or if
/// the path is already stretched towards a target out of reach.
fn stuck_line(
    problem: &Problem,
    config: &Configuration,
    index: usize,
    path: impl Iterator<Item = usize> + Clone,
) -> Option<Vec3A> {
    // Relative distance from the line below which methods move away from it slowly.
    const STRAIGHT: f32 = 1e-3;
    let (effector, tip) = (&problem.effectors[index], config.tips[index]);
    let base = config.bases[path.clone().last()?];
    let points = path.map(|link| config.bases[link]).chain([tip]).map(|point| point - base);
    let farthest = points
        .clone()
        .max_by(|one, other| one.length_squared().total_cmp(&other.length_squared()))?;
    let line = normalize(farthest)?;
    let reach = farthest.length();
    let is_beside = |point: Vec3A| {
        point.reject_from_normalized(line).length() > STRAIGHT * reach.max(point.length())
    };
    if points.clone().any(is_beside) || is_beside(effector.target - base) {
        return None;
    }
    (!is_stretched(problem, index, line, tip, base)).then_some(line)
}

/// Whether a path that lies on a line is fully stretched towards its target.
fn is_stretched(problem: &Problem, index: usize, line: Vec3A, tip: Vec3A, base: Vec3A) -> bool {
    // Relative shortening of a stretched path whose joints are within `STRAIGHT` of its line.
    const STRETCHED: f32 = 1e-3;
    let effector = &problem.effectors[index];
    let inner = path(problem, index).filter(|link| problem.links[*link].parent.is_some());
    let bones: f32 = inner.map(|link| problem.links[link].pivot.length()).sum();
    let reached = (tip - base).dot(line);
    let beyond = (effector.target - base).dot(line);
    reached >= (bones + effector.tip.length()) * (1.0 - STRETCHED) && beyond >= reached
}

/// Changes one angle of a link by `by` or `-by` (radians), within its limits. Of the three angles
/// and both signs, it takes the one that swings the direction `line` most.
pub(super) fn bend_link(
    problem: &Problem,
    config: &mut Configuration,
    link: usize,
    line: Vec3A,
    by: f32,
) {
    let (limits, angles) = (&problem.links[link].limits, config.angles[link]);
    let mut best = (0.0, angles);
    for (axis, unit) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        let swing = config.axes[link].col(axis).cross(line).length();
        for side in [by, -by] {
            let bent = clamp_to_limits(limits, angles + unit * side);
            let swung = swing * (bent - angles).length();
            // A margin, so that rounding does not decide between equal swings.
            if swung > best.0 * 1.01 {
                best = (swung, bent);
            }
        }
    }
    config.angles[link] = best.1;
}
