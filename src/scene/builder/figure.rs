//! A line of the arm's figures and formulas, lit up where it belongs in the view.

use glam::{Quat, Vec3};

use crate::document::{Arm, Posed};
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::{ArmPart, ArmRig};
use crate::scene::{Label, LabelSide, Line, Scene};
use crate::session::ArmFigure;

/// The frames of the hierarchy, with the length of their axes as fractions of the arm's length.
/// Their origins coincide, and the Limb and the Socket have the same x axis: the lengths tell them
/// apart.
const FRAMES: [(ArmPart, f32); 3] =
    [(ArmPart::Root, 0.28), (ArmPart::Limb, 0.36), (ArmPart::Socket, 0.44)];
/// Radius of the arcs of angles, as a fraction of the arm's length.
const ARC: f32 = 0.22;
/// Radius of lines, as a fraction of the arm's length.
const THICK: f32 = 0.009;
/// Radius of a limb that is lit up, as a multiple of its own.
const SLEEVE: f32 = 1.06;

/// Adds the axes of Root, Limb and Socket, with their names.
pub(super) fn add_frames(scene: &mut Scene, posed: &Posed) {
    let drawing = FigureDrawing::new(posed);
    for (part, _) in FRAMES {
        drawing.add_frame(scene, part);
    }
}

/// Adds a figure of the posed arm.
pub(super) fn add(scene: &mut Scene, posed: &Posed, figure: ArmFigure) {
    FigureDrawing::new(posed).add(scene, figure);
}

/// World positions of what the figures consist of.
struct FigureDrawing<'a> {
    arm: &'a Arm,
    pose: &'a TwoBonePose,
    rig: ArmRig,
    shoulder: Vec3,
    elbow: Vec3,
    hand: Vec3,
    /// The point that the Pointer goes through: the Cursor, or without IK the hand.
    cursor: Vec3,
    /// The point of the Pointer nearest to the elbow.
    foot: Vec3,
    /// Length of the straight arm.
    length: f32,
}

impl<'a> FigureDrawing<'a> {
    fn new(posed: &'a Posed) -> Self {
        let (arm, pose) = (posed.arm(), posed.arm_pose());
        let shoulder = arm.root;
        Self {
            arm,
            pose,
            rig: arm.rig(pose),
            shoulder,
            elbow: shoulder + pose.elbow,
            hand: shoulder + pose.hand,
            cursor: shoulder + arm.pointed_at(pose),
            foot: shoulder + pose.along * pose.pointer.direction,
            length: arm.bones.outer_limit(),
        }
    }

    fn add(&self, scene: &mut Scene, figure: ArmFigure) {
        let Self { pose, shoulder, elbow, hand, cursor, foot, .. } = *self;
        match figure {
            ArmFigure::Root => self.add_frame(scene, ArmPart::Root),
            ArmFigure::Limb => self.add_frame(scene, ArmPart::Limb),
            ArmFigure::Socket => self.add_frame(scene, ArmPart::Socket),
            ArmFigure::Upper => self.add_sleeve(scene, shoulder, elbow),
            ArmFigure::Lower => self.add_sleeve(scene, elbow, hand),
            ArmFigure::Cursor => self.add_coordinates(scene, cursor),
            ArmFigure::Elbow => self.add_coordinates(scene, elbow),
            ArmFigure::Distance => self.add_line(scene, shoulder, hand),
            ArmFigure::Along => self.add_line(scene, shoulder, foot),
            ArmFigure::Out => self.add_line(scene, foot, elbow),
            ArmFigure::Level => {
                self.add_line(scene, shoulder, self.level());
                self.add_dashes(scene, self.level(), cursor);
            }
            ArmFigure::Yaw => {
                self.add_dashes(scene, shoulder, shoulder + 1.6 * ARC * self.length * Vec3::X);
                self.add_dashes(scene, shoulder, self.level());
                // The yaw turns from x towards z, against the right-handed turn about y.
                self.add_angle(scene, shoulder, Vec3::X, Vec3::NEG_Y, pose.yaw());
            }
            ArmFigure::Pitch => {
                self.add_dashes(scene, shoulder, self.level());
                self.add_dashes(scene, shoulder, cursor);
                let heading = self.heading();
                self.add_angle(scene, shoulder, heading, heading.cross(Vec3::Y), pose.pitch());
            }
            ArmFigure::ShoulderAngle => {
                let (pointer, axis) = (pose.pointer.direction, self.bending_axis());
                self.add_angle(scene, shoulder, pointer, axis, pose.shoulder_angle());
            }
            ArmFigure::ElbowAngle => {
                let to_shoulder = (shoulder - elbow).normalize_or(Vec3::X);
                self.add_angle(scene, elbow, to_shoulder, self.bending_axis(), pose.elbow_angle());
            }
        }
    }

    /// Unit vector of the Pointer's heading in the horizontal plane.
    fn heading(&self) -> Vec3 {
        let heading = self.pose.pointer.heading;
        Vec3::new(heading.x, 0.0, heading.y)
    }

    /// The point below or above the Cursor at the height of the shoulder.
    fn level(&self) -> Vec3 {
        Vec3 { y: self.shoulder.y, ..self.cursor }
    }

    /// Unit vector across the triangle: the Pointer turns about it towards the elbow.
    fn bending_axis(&self) -> Vec3 {
        self.pose.pointer.direction.cross(self.pose.outward())
    }

    fn add_frame(&self, scene: &mut Scene, part: ArmPart) {
        let Some((_, length)) = FRAMES.into_iter().find(|frame| frame.0 == part) else { return };
        let frame = self.rig.world(part);
        let origin = Vec3::from(frame.translation);
        let radius = THICK * self.length;
        for (nth, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let axis = length * self.length * Vec3::from(frame.matrix3.col(nth));
            let (neck, to) = (origin + 0.88 * axis, origin + axis);
            let colour = scene.palette.axes[nth];
            scene.add_guide_solid(origin, neck, radius, radius, colour);
            scene.add_guide_solid(neck, to, 2.2 * radius, 0.0, colour);
            let label = Label::new(to, radius, LabelSide::Above, scene.palette.text);
            scene.add_label(label, format_args!("{part:?} {letter}"));
        }
    }

    fn add_line(&self, scene: &mut Scene, from: Vec3, to: Vec3) {
        let (radius, colour) = (THICK * self.length, scene.palette.accent);
        if from != to {
            scene.add_guide_solid(from, to, radius, radius, colour);
        }
    }

    /// Lights up a limb from end to end.
    fn add_sleeve(&self, scene: &mut Scene, from: Vec3, to: Vec3) {
        let limb = self.rig.upper();
        let [base, tip] = [limb.base_radius, limb.tip_radius].map(|radius| SLEEVE * radius);
        if from != to {
            scene.add_guide_solid(from, to, base, tip, scene.palette.accent);
        }
    }

    fn add_dashes(&self, scene: &mut Scene, from: Vec3, to: Vec3) {
        scene.lines.push(Line { from, to, colour: scene.palette.guide, dashed: true });
    }

    /// Adds the way from the shoulder to a point along x, then z, then y, with the coordinates.
    fn add_coordinates(&self, scene: &mut Scene, point: Vec3) {
        let radius = THICK * self.length;
        let mut from = self.shoulder;
        // x and z lie in the horizontal plane of the shoulder; the height comes last.
        for nth in [0, 2, 1] {
            let mut to = from;
            to[nth] = point[nth];
            let colour = scene.palette.axes[nth];
            if from != to {
                scene.add_guide_solid(from, to, radius, radius, colour);
            }
            from = to;
        }
        let label = Label::new(point, radius, LabelSide::Below, scene.palette.text);
        let way = (point - self.shoulder).to_array();
        let [x, y, z] = way.map(|coordinate| self.arm.format_length(coordinate));
        scene.add_label(label, format_args!("({x}, {y}, {z})"));
    }

    /// Adds an angle from `start`, a unit vector, about `axis`, with its degrees.
    fn add_angle(&self, scene: &mut Scene, centre: Vec3, start: Vec3, axis: Vec3, angle: f32) {
        let colour = scene.palette.accent;
        let radius = ARC * self.length;
        // Three arcs side by side are a broad one.
        for part in [1.0, 0.985, 0.97] {
            scene.add_arc(centre, part * radius * start, axis, angle, colour);
        }
        let Some(axis) = axis.try_normalize() else { return };
        let middle = Quat::from_axis_angle(axis, 0.5 * angle) * start;
        let at = centre + 1.1 * radius * middle;
        let label = Label::new(at, 0.0, LabelSide::Above, scene.palette.text);
        scene.add_label(label, format_args!("{:.1}°", angle.to_degrees()));
    }
}
