//! A limb's twist: the circle of elbows, and the same twist measured from other references.

use core::f32::consts::TAU;
use core::fmt::{self, Display, Formatter};

use glam::{Quat, Vec3};

use crate::document::TwistReferenceKind;
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::LimbFrames;
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene};
use crate::session::TwistReferencePoses;

/// Radii of a ghost's limbs and of its elbow, on an arm of thickness 1.
const LIMB_RADIUS: f32 = 7.0;
const ELBOW_RADIUS: f32 = 13.0;

/// Angle in radians between two elbows below which they share a label, since two labels would
/// overlap.
const SHARED_LABEL_ANGLE: f32 = 20.0 * core::f32::consts::PI / 180.0;

/// Adds ghosts of a limb: thin limbs with the same twist, each measured from another kind of twist
/// reference. Labels show the angles from the limb's elbow to those of the ghosts.
pub(super) fn add_references(scene: &mut Scene, limb: &LimbFrames, poses: TwistReferencePoses) {
    let own = limb.solution.pose;
    let mut ghosts = [None; TwistReferenceKind::ALL.len()];
    for (ghost, (kind, pose)) in ghosts.iter_mut().zip(poses.iter()) {
        let (turn, is_own) = (own.elbow_turn_to(pose), kind == limb.posed.kind);
        *ghost = Some(ReferenceGhost { twist_reference: kind, pose: *pose, turn, is_own });
    }
    let turn = |ghost: &Option<ReferenceGhost>| ghost.map_or(f32::INFINITY, |it| it.turn);
    ghosts.sort_by(|a, b| turn(a).total_cmp(&turn(b)));
    let ghosts: &[Option<ReferenceGhost>] = &ghosts;
    for ghost in ghosts.iter().flatten().filter(|ghost| !ghost.is_own) {
        ghost.add_limbs(scene, limb);
    }
    let present = &ghosts[..ghosts.iter().flatten().count()];
    for group in present.chunk_by(|a, b| turn(b) - turn(a) < SHARED_LABEL_ANGLE) {
        add_label(scene, limb, group);
    }
}

/// The limb posed with one of the kinds of twist reference.
#[derive(Clone, Copy)]
struct ReferenceGhost {
    twist_reference: TwistReferenceKind,
    pose: TwoBonePose,
    /// Angle in radians about the Pointer from the limb's elbow to the ghost's elbow.
    turn: f32,
    is_own: bool,
}

impl ReferenceGhost {
    fn add_limbs(&self, scene: &mut Scene, limb: &LimbFrames) {
        let thickness = limb.thickness();
        let colour = scene.palette.twist_reference(self.twist_reference);
        let [base, elbow, hand] =
            [Vec3::ZERO, self.pose.elbow, self.pose.hand].map(|point| limb.in_world(point));
        let radius = LIMB_RADIUS * thickness;
        scene.add_solid(base, elbow, radius, radius, colour);
        scene.add_solid(elbow, hand, radius, radius, colour);
        scene.balls.push(Ball { centre: elbow, radius: ELBOW_RADIUS * thickness, colour });
    }
}

/// Adds one label for ghosts with nearly the same elbow, like "Stereographic · Limb −17°". The
/// limb's own reference has no angle.
fn add_label(scene: &mut Scene, limb: &LimbFrames, group: &[Option<ReferenceGhost>]) {
    let ghosts = || group.iter().flatten();
    let Some(ghost) = ghosts().find(|ghost| ghost.is_own).or(ghosts().last()) else { return };
    let (ball, colour) = if ghost.is_own {
        (LimbFrames::JOINT_BALL, scene.palette.text)
    } else {
        (ELBOW_RADIUS, scene.palette.twist_reference(ghost.twist_reference))
    };
    let at = limb.in_world(ghost.pose.elbow);
    let label = Label::new(at, ball * limb.thickness(), LabelSide::Above, colour);
    scene.add_label(label, format_args!("{}", GhostNames(group)));
}

/// Text of a shared label: the names of its references, the limb's own first. Names with the same
/// angle share it.
struct GhostNames<'a>(&'a [Option<ReferenceGhost>]);

impl Display for GhostNames<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let degrees = |ghost: &ReferenceGhost| ghost.turn.to_degrees().round();
        let own = self.0.iter().flatten().filter(|ghost| ghost.is_own);
        let others = self.0.iter().flatten().filter(|ghost| !ghost.is_own);
        let mut ghosts = own.chain(others).peekable();
        while let Some(ghost) = ghosts.next() {
            f.write_str(ghost.twist_reference.name())?;
            let next = ghosts.peek();
            let turn = degrees(ghost);
            let is_shared = next.is_some_and(|next| !ghost.is_own && degrees(next) == turn);
            if !ghost.is_own && !is_shared {
                write!(f, " {}{:.0}°", if turn < 0.0 { '−' } else { '+' }, turn.abs())?;
            }
            if next.is_some() {
                f.write_str(if is_shared { ", " } else { " · " })?;
            }
        }
        Ok(())
    }
}

const SEGMENTS: u16 = 96;
/// Radius of the arc of the twist, as a fraction of the circle's.
const ARC: f32 = 0.4;
/// Distance of the twist's label from the centre, as a fraction of the circle's radius.
const LABEL: f32 = 0.6;
/// Radius of the circle, as a fraction of the arm's length, from which it is drawn: the circle of a
/// straight or folded arm is a point.
const LEAST: f32 = 1e-3;
/// Twist in radians from which its arc is drawn.
const LEAST_TWIST: f32 = 1e-3;

/// Part of the sky in the colour of a circle, so that it stays behind the limb.
const FADED: f32 = 0.5;

/// Distance of the circle's name from the circle, as a part of the limb's length.
const CLEAR: f32 = 0.015;

/// Adds the circle with spokes to the twist reference's direction and to the elbow, and the arc of
/// the twist between them. Where FK has a part in the pose, the elbow has no circle; without marks,
/// and where limits of the upper joint turn the elbow aside, the circle has one spoke, to the
/// elbow.
pub(super) fn add_circle(scene: &mut Scene, limb: &LimbFrames, has_marks: bool) {
    let (posed, pose) = (&limb.posed, limb.pose());
    if posed.influence < 1.0 || pose.out < LEAST * limb.bones().outer_limit() {
        return;
    }
    let circle = ElbowCircle::new(limb);
    let palette = scene.palette;
    let accent = palette.accent;
    circle.add_arc(scene, TAU, 1.0, palette.guide.mixed(palette.sky_bottom, FADED));
    if has_marks {
        let at = circle.point(circle.twist + 0.5 * TAU, 1.0);
        let centre = circle.point(0.0, 0.0);
        let side = LabelSide::clear_of(&[centre], at, &scene.camera);
        let clear = CLEAR * limb.bones().outer_limit();
        let label = Label::new(at, clear, side, palette.text);
        scene.add_label(label, format_args!("Elbow circle"));
    }
    let has_marks = has_marks && !limb.is_limited();
    if circle.twist > LEAST_TWIST {
        circle.add_spoke(scene, circle.twist, accent, false);
    }
    if has_marks && circle.twist > LEAST_TWIST {
        circle.add_spoke(scene, 0.0, palette.twist_reference(posed.kind), true);
        circle.add_arc(scene, circle.twist, ARC, accent);
        let at = circle.point(circle.twist / 2.0, LABEL);
        let label = Label::new(at, 0.0, LabelSide::Above, accent);
        scene.add_label(label, format_args!("twist {:.0}°", circle.twist.to_degrees()));
    }
}

/// A circle around the Pointer. Angles are Socket twists: 0 is the direction of the twist
/// reference.
struct ElbowCircle<'a> {
    limb: &'a LimbFrames,
    twist: f32,
}

impl<'a> ElbowCircle<'a> {
    fn new(limb: &'a LimbFrames) -> Self {
        Self { limb, twist: limb.posed.twist.rem_euclid(TAU) }
    }

    /// The point of the world at a twist; `part` is its distance from the centre as a fraction of
    /// the radius.
    fn point(&self, twist: f32, part: f32) -> Vec3 {
        let pose = self.limb.pose();
        let axis = pose.pointer.direction;
        let out = Quat::from_axis_angle(axis, twist - self.twist) * pose.outward() * pose.out;
        self.limb.in_world(axis * pose.along + part * out)
    }

    fn add_spoke(&self, scene: &mut Scene, twist: f32, colour: Colour, dashed: bool) {
        let [from, to] = [0.0, 1.0].map(|part| self.point(twist, part));
        scene.lines.push(Line { from, to, colour, dashed });
    }

    /// Adds the arc from twist 0 to `end`.
    fn add_arc(&self, scene: &mut Scene, end: f32, part: f32, colour: Colour) {
        let count = (f32::from(SEGMENTS) * end / TAU).ceil().max(1.0) as u16;
        let point = |index: u16| self.point(end * f32::from(index) / f32::from(count), part);
        scene.lines.extend((0..count).map(|index| Line {
            from: point(index),
            to: point(index + 1),
            colour,
            dashed: false,
        }));
    }
}
