//! A line of a limb's figures and formulas, lit up where it belongs in the view.

use glam::{Quat, Vec3};

use crate::document::LengthFormat;
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::{LimbFrames, LimbPart};
use crate::scene::{Colour, Label, LabelSide, Line, Scene};
use crate::session::LimbFigure;

/// The frames of the hierarchy, with the length of their axes as fractions of the limb's length.
/// Their origins coincide, and the Limb and the Socket have the same x axis: the lengths tell them
/// apart.
const FRAMES: [(LimbPart, f32); 3] =
    [(LimbPart::Root, 0.28), (LimbPart::Limb, 0.36), (LimbPart::Socket, 0.44)];
/// Radius of the arcs of angles, as a fraction of the limb's length.
const ARC: f32 = 0.22;
/// Radius of lines, as a fraction of the limb's length.
const THICK: f32 = 0.009;
/// Radius of a limb that is lit up, as a multiple of its own.
const SLEEVE: f32 = 1.06;

/// Adds the axes of Root, Limb and Socket, with their names.
pub(super) fn add_frames(scene: &mut Scene, limb: &LimbFrames) {
    let drawing = FigureDrawing::new(limb);
    for (part, _) in FRAMES {
        drawing.add_frame(scene, part);
    }
}

/// Adds a figure of a limb.
pub(super) fn add(scene: &mut Scene, limb: &LimbFrames, figure: LimbFigure) {
    FigureDrawing::new(limb).add(scene, figure);
}

/// Positions in Root space of what the figures consist of.
struct FigureDrawing<'a> {
    limb: &'a LimbFrames,
    pose: &'a TwoBonePose,
    elbow: Vec3,
    hand: Vec3,
    /// The point that the Pointer goes through: the Cursor, or without IK the hand.
    cursor: Vec3,
    /// The point of the Pointer nearest to the elbow.
    foot: Vec3,
    /// Length of the straight limb.
    length: f32,
}

/// The origin of Root space.
const SHOULDER: Vec3 = Vec3::ZERO;

impl<'a> FigureDrawing<'a> {
    fn new(limb: &'a LimbFrames) -> Self {
        let pose = limb.pose();
        Self {
            limb,
            pose,
            elbow: pose.elbow,
            hand: pose.hand,
            cursor: limb.pointed_at(),
            foot: pose.along * pose.pointer.direction,
            length: limb.bones().outer_limit(),
        }
    }

    fn add(&self, scene: &mut Scene, figure: LimbFigure) {
        let Self { pose, elbow, hand, cursor, foot, .. } = *self;
        match figure {
            LimbFigure::Root => self.add_frame(scene, LimbPart::Root),
            LimbFigure::Limb => self.add_frame(scene, LimbPart::Limb),
            LimbFigure::Socket => self.add_frame(scene, LimbPart::Socket),
            LimbFigure::Upper => self.add_sleeve(scene, SHOULDER, elbow),
            LimbFigure::Lower => self.add_sleeve(scene, elbow, hand),
            LimbFigure::Cursor => self.add_coordinates(scene, cursor),
            LimbFigure::Elbow => self.add_coordinates(scene, elbow),
            LimbFigure::Distance => self.add_line(scene, SHOULDER, hand),
            LimbFigure::Along => self.add_line(scene, SHOULDER, foot),
            LimbFigure::Out => self.add_line(scene, foot, elbow),
            LimbFigure::Level => {
                self.add_line(scene, SHOULDER, self.level());
                self.add_dashes(scene, self.level(), cursor);
            }
            LimbFigure::Yaw => {
                self.add_dashes(scene, SHOULDER, 1.6 * ARC * self.length * Vec3::X);
                self.add_dashes(scene, SHOULDER, self.level());
                // The yaw turns from x towards z, against the right-handed turn about y.
                self.add_angle(scene, SHOULDER, Vec3::X, Vec3::NEG_Y, pose.yaw());
            }
            LimbFigure::Pitch => {
                self.add_dashes(scene, SHOULDER, self.level());
                self.add_dashes(scene, SHOULDER, cursor);
                let heading = self.heading();
                self.add_angle(scene, SHOULDER, heading, heading.cross(Vec3::Y), pose.pitch());
            }
            LimbFigure::ShoulderAngle => {
                let (pointer, axis) = (pose.pointer.direction, self.bending_axis());
                self.add_angle(scene, SHOULDER, pointer, axis, pose.shoulder_angle());
            }
            LimbFigure::ElbowAngle => {
                let to_shoulder = (SHOULDER - elbow).normalize_or(Vec3::X);
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
        Vec3 { y: 0.0, ..self.cursor }
    }

    /// Unit vector across the triangle: the Pointer turns about it towards the elbow.
    fn bending_axis(&self) -> Vec3 {
        self.pose.pointer.direction.cross(self.pose.outward())
    }

    fn add_frame(&self, scene: &mut Scene, part: LimbPart) {
        let Some((_, length)) = FRAMES.into_iter().find(|frame| frame.0 == part) else { return };
        let frame = self.limb.world(part);
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

    /// Adds a rod between two points of Root space.
    fn add_line(&self, scene: &mut Scene, from: Vec3, to: Vec3) {
        self.add_rod(scene, [from, to], [THICK * self.length; 2], scene.palette.accent);
    }

    /// Lights up a limb from end to end.
    fn add_sleeve(&self, scene: &mut Scene, from: Vec3, to: Vec3) {
        let limb = self.limb.upper();
        let radii = [limb.base_radius, limb.tip_radius].map(|radius| SLEEVE * radius);
        self.add_rod(scene, [from, to], radii, scene.palette.accent);
    }

    fn add_rod(&self, scene: &mut Scene, ends: [Vec3; 2], radii: [f32; 2], colour: Colour) {
        if ends[0] != ends[1] {
            let [from, to] = ends.map(|end| self.limb.in_world(end));
            scene.add_guide_solid(from, to, radii[0], radii[1], colour);
        }
    }

    fn add_dashes(&self, scene: &mut Scene, from: Vec3, to: Vec3) {
        let [from, to] = [from, to].map(|end| self.limb.in_world(end));
        scene.lines.push(Line { from, to, colour: scene.palette.guide, dashed: true });
    }

    /// Adds the way from the shoulder to a point along x, then z, then y of Root space, with the
    /// coordinates.
    fn add_coordinates(&self, scene: &mut Scene, point: Vec3) {
        let radius = THICK * self.length;
        let mut from = SHOULDER;
        // x and z lie in the level plane of the shoulder; the height comes last.
        for nth in [0, 2, 1] {
            let mut to = from;
            to[nth] = point[nth];
            self.add_rod(scene, [from, to], [radius; 2], scene.palette.axes[nth]);
            from = to;
        }
        let at = self.limb.in_world(point);
        let label = Label::new(at, radius, LabelSide::Below, scene.palette.text);
        let lengths = LengthFormat::of_limb(self.limb.bones());
        let [x, y, z] = point.to_array().map(|coordinate| lengths.show(coordinate));
        scene.add_label(label, format_args!("({x}, {y}, {z})"));
    }

    /// Adds an angle from `start`, a unit vector, about `axis`, with its degrees.
    fn add_angle(&self, scene: &mut Scene, centre: Vec3, start: Vec3, axis: Vec3, angle: f32) {
        let colour = scene.palette.accent;
        let radius = ARC * self.length;
        let Some(axis) = axis.try_normalize() else { return };
        let arm = |part: f32, turn: f32| {
            let arm = part * radius * (Quat::from_axis_angle(axis, turn) * start);
            self.limb.in_world(centre + arm)
        };
        // Three arcs side by side are a broad one.
        for part in [1.0, 0.985, 0.97] {
            scene.add_curve_of(angle, colour, |turn| arm(part, turn));
        }
        let at = arm(1.1, 0.5 * angle);
        let label = Label::new(at, 0.0, LabelSide::Above, scene.palette.text);
        scene.add_label(label, format_args!("{:.1}°", angle.to_degrees()));
    }
}
