use core::f32::consts::TAU;
use core::fmt::{Arguments, Write as _};
use core::ops::Range;

use glam::{Quat, Vec3};

use super::shapes::TextRange;
use super::{
    Ball, Colour, Globe, Hand, Label, LabelSide, Line, Palette, Planes, Shadow, SkinInstance,
    Solid, SphereShell,
};
use crate::document::{Camera, Display, Overlay, Theme};
use crate::kinematics::Shared;
use crate::kinematics::skin::SkinPose;
use crate::rig::Crowd;

/// Ratio of the radius of a singular direction's mark to the radius of the globe.
const MARK_RADIUS: f32 = 0.02;

/// The gains whose lines on the globe have a number: those of `LEVELS` in `globe.wgsl`.
const LEVELS: [u8; 3] = [1, 2, 5];

/// Bytes of the labels of a scene with all guides, more than there are: a longer number then takes no
/// memory.
const TEXT: usize = 1024;

/// Everything that is drawn in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Camera that views the scene.
    pub camera: Camera,
    /// Colours of the background, the grids and all parts without a colour of their own.
    pub palette: Palette,
    /// Ground and grids.
    pub planes: Planes,
    /// Shadows on the ground, each of a limb above the ground.
    pub shadows: Vec<Shadow>,
    /// Cones and cylinders.
    pub solids: Vec<Solid>,
    /// Balls.
    pub balls: Vec<Ball>,
    /// Hands.
    pub hands: Vec<Hand>,
    /// Cones and cylinders that also show faintly through the surfaces that hide them.
    pub guide_solids: Vec<Solid>,
    /// Balls that also show faintly through the surfaces that hide them.
    pub guide_balls: Vec<Ball>,
    /// See-through spheres.
    pub shells: Vec<SphereShell>,
    /// Globe coloured by the gain of a twist reference.
    pub globe: Option<Globe>,
    /// Crowd that is drawn instead of the rig. The renderer solves it.
    pub crowd: Option<Crowd>,
    /// Skins.
    pub skins: Vec<SkinInstance>,
    /// Lines.
    pub lines: Vec<Line>,
    /// Labels, drawn over everything else.
    pub labels: Vec<Label>,
    /// Texts of all labels, concatenated.
    text: String,
    /// False if labels that are added are left out.
    pub(super) has_labels: bool,
    /// The pose of a skin of the last picture, while the scene is refilled: its memory is used
    /// again.
    pub(super) spare_skin_pose: Option<Shared<SkinPose>>,
}

impl Scene {
    /// Range of the bounding radius of a crowd that is drawn, in world units. Outside this range
    /// squared lengths overflow or underflow on the CPU or the device.
    pub const CROWD_RADII: Range<f32> = 1e-12..1e15;

    /// Number of lines of a whole circle.
    pub(super) const CIRCLE: u16 = 64;

    /// A scene of the planes alone.
    pub(super) fn empty(camera: Camera, display: Display, theme: Theme) -> Self {
        Self {
            camera,
            palette: Palette::new(theme),
            planes: Planes::around(Vec3::ZERO, 0.0, 1.0, display),
            shadows: Vec::new(),
            solids: Vec::new(),
            balls: Vec::new(),
            hands: Vec::new(),
            guide_solids: Vec::new(),
            guide_balls: Vec::new(),
            shells: Vec::new(),
            globe: None,
            crowd: None,
            skins: Vec::new(),
            lines: Vec::new(),
            labels: Vec::new(),
            text: String::new(),
            has_labels: display.shows(Overlay::Labels),
            spare_skin_pose: None,
        }
    }

    /// Empties the scene but keeps the memory of its lists. Camera, palette and planes stay.
    pub(super) fn clear(&mut self) {
        self.shadows.clear();
        self.solids.clear();
        self.balls.clear();
        self.hands.clear();
        self.guide_solids.clear();
        self.guide_balls.clear();
        self.shells.clear();
        self.globe = None;
        self.crowd = None;
        self.spare_skin_pose = self.skins.drain(..).next().map(|skin| skin.pose);
        self.lines.clear();
        self.labels.clear();
        self.text.clear();
        self.text.reserve(TEXT);
    }

    /// Text of a label of this scene; empty for a label of another scene.
    pub fn text(&self, label: &Label) -> &str {
        self.text.get(label.text.from..label.text.to).unwrap_or_default()
    }

    /// Adds a label with this text, if the scene has labels.
    pub(super) fn add_label(&mut self, label: Label, text: Arguments<'_>) {
        if !self.has_labels {
            return;
        }
        let from = self.text.len();
        // Writing to a string never fails.
        let _ = self.text.write_fmt(text);
        let text = TextRange { from, to: self.text.len() };
        self.labels.push(Label { text, ..label });
    }

    /// Adds a cone from base to tip, both in the world.
    pub(super) fn add_solid(
        &mut self,
        base: Vec3,
        tip: Vec3,
        base_radius: f32,
        tip_radius: f32,
        colour: Colour,
    ) {
        self.solids.push(Solid::cone(base, tip, base_radius, tip_radius, colour));
    }

    /// Adds a cone from base to tip, both in the world, that also shows faintly through the
    /// surfaces that hide it.
    pub(super) fn add_guide_solid(
        &mut self,
        base: Vec3,
        tip: Vec3,
        base_radius: f32,
        tip_radius: f32,
        colour: Colour,
    ) {
        self.guide_solids.push(Solid::cone(base, tip, base_radius, tip_radius, colour));
    }

    /// Adds an arc that begins at `centre + start` and goes round `axis`.
    pub(super) fn add_arc(
        &mut self,
        centre: Vec3,
        start: Vec3,
        axis: Vec3,
        angle: f32,
        colour: Colour,
    ) {
        let Some(axis) = axis.try_normalize() else { return };
        let point = |turn| centre + Quat::from_axis_angle(axis, turn) * start;
        self.add_curve_of(angle, colour, point);
    }

    /// Adds the arc through the points of the angles from 0 to `angle`, in radians.
    pub(super) fn add_curve_of(&mut self, angle: f32, colour: Colour, point: impl Fn(f32) -> Vec3) {
        let count = (f32::from(Self::CIRCLE) * angle.abs() / TAU).ceil().clamp(1.0, 256.0) as u16;
        let point = |index: u16| point(angle * f32::from(index) / f32::from(count));
        let line = |index| Line { from: point(index), to: point(index + 1), colour, dashed: false };
        self.lines.extend((0..count).map(line));
    }

    /// Shows a globe and marks each singular direction with a ball and a label. Does nothing if the
    /// globe cannot be drawn, see [`Globe::has_size`].
    pub fn add_globe(&mut self, globe: Globe) {
        if !globe.has_size() {
            return;
        }
        self.globe = Some(globe);
        let (ball, text) = (self.palette.danger(), self.palette.text);
        for direction in globe.singular() {
            let (centre, radius) =
                (globe.centre + direction * globe.radius, MARK_RADIUS * globe.radius);
            self.balls.push(Ball { centre, radius, colour: ball });
            let label = Label::new(centre, radius, LabelSide::Above, text);
            self.add_label(label, format_args!("Elbow spins here"));
        }
        self.label_levels(globe);
    }

    /// Writes the gains of the lines on a globe beside them, at the left as the camera sees them: at the
    /// right is the label of the singular direction.
    fn label_levels(&mut self, globe: Globe) {
        let left = -self.camera.projection(1.0).right;
        for direction in globe.singular() {
            let aside = left.reject_from_normalized(direction);
            let aside = aside.try_normalize().unwrap_or_else(|| direction.any_orthonormal_vector());
            for gain in LEVELS {
                let (sin, cos) = globe.angle_of_gain(f32::from(gain)).sin_cos();
                let at = globe.centre + globe.radius * (cos * direction + sin * aside);
                let label = Label::new(at, 0.0, LabelSide::AboveLeft, self.palette.text);
                self.add_label(label, format_args!("{gain}×"));
            }
        }
    }

    /// Removes all shapes and labels with a position or size that is not finite.
    pub(super) fn remove_non_finite(&mut self) {
        for solids in [&mut self.solids, &mut self.guide_solids] {
            solids.retain(|Solid { transform, shape, .. }| {
                let sizes = [shape.length, shape.base_radius, shape.tip_radius];
                transform.is_finite() && sizes.into_iter().all(f32::is_finite)
            });
        }
        for balls in [&mut self.balls, &mut self.guide_balls] {
            balls.retain(|ball| ball.centre.is_finite() && ball.radius.is_finite());
        }
        self.hands.retain(|hand| hand.transform.is_finite() && hand.size.is_finite());
        self.shells.retain(|shell| shell.centre.is_finite() && shell.radius.is_finite());
        self.lines.retain(|line| line.from.is_finite() && line.to.is_finite());
        self.labels.retain(|label| label.at.is_finite() && label.clearance.is_finite());
        self.shadows.retain(|Shadow { base, base_radius, tip, tip_radius }| {
            let ends = base.is_finite() && tip.is_finite();
            ends && base_radius.is_finite() && tip_radius.is_finite()
        });
    }
}
