//! Changes of pose for chains that no method can move although they could come nearer.
//!
//! A straight chain whose target is on its line has no moment at any joint. A straight chain whose
//! joints are at limits stays straight if the moments push the joints against their limits: a knee
//! limited to 0 … 143°, with the target in front of the leg. [`bend`] bends both so that the chain
//! is as long as its target is far. Where limits hold a chain at another local minimum,
//! [`leave_limits`] moves angles away from their limits.

use glam::{Vec3, Vec3A};

use super::align::{PointPair, align_within};
use super::configuration::Configuration;
use super::problem::Problem;
use crate::normalize;
use crate::skeleton::RotationAxis;

/// Relative distance from a line, and relative moment, below which methods move a joint slowly.
const STRAIGHT: f32 = 1e-3;

/// The last links of the path from a root to a tip, on one line.
#[derive(Clone, Copy)]
struct StraightEnd {
    effector: usize,
    /// Number of links.
    links: usize,
    /// Index of the link nearest to the root.
    top: usize,
    /// Direction of the line.
    line: Vec3A,
}

/// Bends straight ends of paths that no method can bend. Changes only the configuration's angles
/// and what follows from them; `straight` is overwritten. Returns whether anything was bent.
pub(super) fn bend(
    problem: &Problem,
    config: &mut Configuration,
    straight: &mut Configuration,
) -> bool {
    let mut any = false;
    for effector in 0..problem.effectors.len() {
        if problem.effectors[effector].weight > 0.0
            && let Some(end) = straight_end(problem, config, effector)
            && is_stuck(problem, config, end)
        {
            straight.copy_from(config);
            if can_bend(problem, config, end) && must_bend(problem, config, end) {
                bend_to_target(problem, config, straight, end);
            }
            align_top(problem, config, end);
            any = true;
        }
    }
    any
}

/// Fractions of the range between two limits, tried by [`leave_limits`] in this order.
const FRACTIONS: [f32; 3] = [0.5, 0.25, 0.75];

/// Number of different starts that [`leave_limits`] knows for a problem.
pub(super) fn starts_inside(problem: &Problem) -> u32 {
    /// Further starts where there are cones, whose sides leave more minima.
    const SPREAD: u32 = 10;
    let has_cone = problem.links.iter().any(|link| link.limits.as_cone().is_some());
    ACROSS + if has_cone { SPREAD } else { 0 }
}

/// Number of starts across limits.
const ACROSS: u32 = 2 * FRACTIONS.len() as u32;

/// Moves angles inside their limits: the angles at limits or, for odd numbers `start`, all that
/// have limits; of later starts, those of cones. Returns whether any angle has changed.
pub(super) fn leave_limits(problem: &Problem, config: &mut Configuration, start: u32) -> bool {
    let fraction = FRACTIONS[start as usize / 2 % FRACTIONS.len()];
    let mut any = false;
    for (index, (link, angles)) in problem.links.iter().zip(&mut config.angles).enumerate() {
        let inside = match start.checked_sub(ACROSS) {
            None => link.limits.moved_inside(*angles, fraction, start % 2 == 1),
            Some(spread) => link.limits.spread(spread + 7 * index as u32, *angles),
        };
        any |= inside != *angles;
        *angles = inside;
    }
    config.forward(problem);
    any
}

/// The angles of a link with one of them changed by `by` or `-by` (radians), within its limits. Of
/// the three angles and both signs, it is the one that swings the direction `line` most.
pub(super) fn bent_angles(
    problem: &Problem,
    config: &Configuration,
    link: usize,
    line: Vec3A,
    by: f32,
) -> Vec3 {
    let (limits, angles) = (&problem.links[link].limits, config.angles[link]);
    let mut best = (0.0, angles);
    for (axis, unit) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        let swing = config.axes[link].col(axis).cross(line).length();
        for side in [by, -by] {
            let bent = limits.project(angles + unit * side);
            let swung = swing * (bent - angles).length();
            // A margin, so that rounding does not decide between equal swings.
            if swung > best.0 * 1.01 {
                best = (swung, bent);
            }
        }
    }
    best.1
}

/// Indices of the links from the end effector's link up to the root's.
fn path(problem: &Problem, effector: usize) -> impl Iterator<Item = usize> + Clone + '_ {
    std::iter::successors(problem.effectors[effector].link, |link| problem.links[*link].parent)
}

/// The longest end of a path that lies on one line: at least two links, or the only one.
fn straight_end(problem: &Problem, config: &Configuration, effector: usize) -> Option<StraightEnd> {
    // A shell or a line is reached from many sides.
    let is_point =
        !problem.effectors[effector].has_shell() && !problem.effectors[effector].is_of_mass();
    let count = if is_point { path(problem, effector).count() } else { 0 };
    (2.min(count)..=count).rev().filter(|links| *links > 0).find_map(|links| {
        let base = config.bases[path(problem, effector).nth(links - 1)?];
        let points = path(problem, effector).take(links).map(|link| config.bases[link]);
        let points = points.chain([config.tips[effector]]).map(|point| point - base);
        let farthest = points
            .clone()
            .max_by(|one, other| one.length_squared().total_cmp(&other.length_squared()))?;
        let line = normalize(farthest)?;
        let most = STRAIGHT * farthest.length();
        let is_straight =
            points.clone().all(|point| point.reject_from_normalized(line).length() <= most);
        let top = path(problem, effector).nth(links - 1)?;
        is_straight.then_some(StraightEnd { effector, links, top, line })
    })
}

/// True if a straight end could come nearer to its target, but no method can move the joints below
/// its top: the target has no moment about them, or pushes them against their limits.
fn is_stuck(problem: &Problem, config: &Configuration, end: StraightEnd) -> bool {
    if !inner_links(problem, end).all(|link| is_held(problem, config, end.effector, link)) {
        return false;
    }
    let towards = problem.effectors[end.effector].target - config.bases[end.top];
    let is_behind = towards.dot(end.line) < 0.0 && is_held(problem, config, end.effector, end.top);
    is_behind || (can_bend(problem, config, end) && must_bend(problem, config, end))
}

/// True if an end effector has no moment about a link, or its moments push the link against its
/// limits.
fn is_held(problem: &Problem, config: &Configuration, effector: usize, link: usize) -> bool {
    let arm = config.tips[effector] - config.bases[link];
    let residual = problem.effectors[effector].target - config.tips[effector];
    let moments = config.axes[link].transpose() * arm.cross(residual);
    let least = STRAIGHT * arm.length() * residual.length();
    RotationAxis::ALL.into_iter().all(|axis| {
        let moment = moments[axis.index()];
        let limits = &problem.links[link].limits;
        moment.abs() <= least || limits.stops(config.angles[link], axis, moment, 0.0)
    })
}

/// Links of a straight end below its top.
fn inner_links(problem: &Problem, end: StraightEnd) -> impl Iterator<Item = usize> + '_ {
    path(problem, end.effector).take(end.links - 1)
}

/// True if a straight end has a joint between its ends that brings them nearer to each other.
fn can_bend(problem: &Problem, config: &Configuration, end: StraightEnd) -> bool {
    let (base, tip) = (config.bases[end.top], config.tips[end.effector]);
    let least = STRAIGHT * tip.distance(base);
    inner_links(problem, end)
        .map(|link| config.bases[link])
        .any(|joint| joint.distance(base) > least && joint.distance(tip) > least)
}

/// True if a straight end is folded, or longer than its target is far.
fn must_bend(problem: &Problem, config: &Configuration, end: StraightEnd) -> bool {
    // Relative shortening of a stretched path whose joints are within `STRAIGHT` of its line.
    const STRETCHED: f32 = 1e-3;
    let (effector, base) = (&problem.effectors[end.effector], config.bases[end.top]);
    let bones: f32 = inner_links(problem, end).map(|link| problem.links[link].pivot.length()).sum();
    let reached = (config.tips[end.effector] - base).dot(end.line);
    let is_folded = reached < (bones + effector.tip.length()) * (1.0 - STRETCHED);
    is_folded || effector.target.distance(base) < reached
}

/// Bends the links of a straight end below its top by equal angles, so that the tip is as far from
/// the top's joint as the target. If no angle does that, bends them a little.
fn bend_to_target(
    problem: &Problem,
    config: &mut Configuration,
    straight: &Configuration,
    end: StraightEnd,
) {
    const BEND: f32 = 0.5;
    // Halvings after which the angle is below rounding.
    const HALVINGS: u32 = 24;
    let base = straight.bases[end.top];
    let distance = problem.effectors[end.effector].target.distance(base);
    let mut excess = |by: f32| {
        for link in inner_links(problem, end) {
            config.angles[link] = bent_angles(problem, straight, link, end.line, by);
        }
        config.forward(problem);
        config.tips[end.effector].distance(base) - distance
    };
    let (mut least, mut most) = (0.0, core::f32::consts::PI);
    let start = excess(least);
    if start * excess(most) > 0.0 {
        excess(BEND / end.links as f32);
        return;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (least + most);
        if start * excess(middle) > 0.0 {
            least = middle;
        } else {
            most = middle;
        }
    }
}

/// Turns the top link of an end within its limits, so that the tip is in its target's direction.
fn align_top(problem: &Problem, config: &mut Configuration, end: StraightEnd) {
    // One pass over the three angles comes near the best rotation; a few come nearer.
    const PASSES: u32 = 3;
    let link = &problem.links[end.top];
    for _ in 0..PASSES {
        let base = config.bases[end.top];
        let axes = config.axes[end.top];
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
        let mut pairs = [PointPair {
            from: config.tips[end.effector] - base,
            to: problem.effectors[end.effector].target - base,
            weight: 1.0,
        }];
        align_within(&link.limits, axes, 1.0, &mut config.angles[end.top], &mut pairs);
        config.forward(problem);
    }
}
