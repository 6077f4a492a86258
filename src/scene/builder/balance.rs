use core::f32::consts::TAU;
use core::fmt::Arguments;

use glam::{Vec2, Vec3};

use super::drawn_skeleton::DrawnSkeleton;
use crate::document::{LengthFormat, ShownLength};
use crate::kinematics::skeleton::{Balance, Skeleton};
use crate::scene::{Ball, Label, LabelSide, Line, Scene};

/// Radius of the ball at the centre of mass, and height of lines above the ground, so that it does
/// not hide them, as fractions of the reach.
const BALL: f32 = 0.012;
const ABOVE_GROUND: f32 = 2e-3;
/// Corners of the ring around the goal.
const GOAL_CORNERS: u8 = 24;

impl DrawnSkeleton<'_> {
    /// Adds the centre of mass, the point under it on the ground, and the edge of what the figure
    /// stands on: as guides while it is balanced, and in the colour of danger while it is not. A ring
    /// is around the goal of the centre.
    pub fn add_balance(
        &self,
        scene: &mut Scene,
        skeleton: &Skeleton,
        goal: Option<Vec2>,
        balance: &mut Balance,
    ) {
        if !balance.renew(skeleton, self.pose) {
            return;
        }
        let is_held = self.joints.iter().all(|joint| joint.parent.is_some() || joint.locked);
        let margin = balance.margin().filter(|_| !is_held);
        let colour = match margin {
            Some(margin) if margin < 0.0 => scene.palette.danger(),
            _ => scene.palette.guide,
        };
        let on_ground = |at: Vec2| Vec3::new(at.x, ABOVE_GROUND * self.reach, at.y);
        let edge = |[from, to]: [Vec2; 2]| [on_ground(from), on_ground(to)];
        let mut add_line =
            |[from, to]: [Vec3; 2], dashed| scene.lines.push(Line { from, to, colour, dashed });
        balance.edges().for_each(|it| add_line(edge(it), false));
        let (centre, below) = (balance.centre, on_ground(balance.centre_on_ground()));
        add_line([centre, below], true);
        let radius = BALL * self.reach;
        for arm in [Vec3::X, Vec3::Z].map(|axis| 2.0 * radius * axis) {
            add_line([below - arm, below + arm], false);
        }
        if let Some(goal) = goal {
            let corner = |at: u8| {
                let turn = TAU * f32::from(at) / f32::from(GOAL_CORNERS);
                on_ground(goal + 2.0 * radius * Vec2::from_angle(turn))
            };
            let colour = scene.palette.accent;
            let side = |at| Line { from: corner(at), to: corner(at + 1), colour, dashed: false };
            scene.lines.extend((0..GOAL_CORNERS).map(side));
        }
        scene.guide_balls.push(Ball { centre, radius, colour });
        let label = |at| Label::new(at, radius, LabelSide::Below, colour);
        scene.add_label(label(centre), format_args!("Centre of mass"));
        if is_held {
            return;
        }
        let decimals = LengthFormat::of_length(self.reach).decimals();
        let shown = |margin: f32| ShownLength { length: margin.abs(), decimals };
        let mut tell = |text: Arguments<'_>| scene.add_label(label(below), text);
        match margin {
            None => tell(format_args!("Stands on nothing")),
            Some(it) if it < 0.0 => tell(format_args!("Tips over: {} outside", shown(it))),
            Some(it) => tell(format_args!("Balanced: {} inside", shown(it))),
        }
    }
}
