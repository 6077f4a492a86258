//! What to draw: plain lists of solids, balls, shells, lines and labels, made from a document.
//!
//! Nothing here knows how things are drawn; nothing in [`crate::render`] knows what they mean.

mod arm;
mod globe;
mod hand;
mod label;
mod motion;
mod palette;
mod references;
mod scratch;
mod shadow;
mod skeleton;

use glam::{Affine3A, Vec3};

pub use globe::Globe;
pub use label::{Label, Side, Words};
pub use palette::{Colour, Palette};
use scratch::Scratch;

use crate::document::{Camera, Display, Document, Overlay, RigKind, Theme};
use crate::rig::{Cone, Crowd};
use crate::session::Overlays;

/// A picture to be drawn.
///
/// Made anew in place, by [`Scene::refill`], it takes no memory that it has not had before.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub camera: Camera,
    pub palette: Palette,
    pub stage: Stage,
    /// What casts a shadow on the ground, above it.
    pub shadows: Vec<Shadow>,
    pub solids: Vec<Solid>,
    pub balls: Vec<Ball>,
    /// Solids and balls that show faintly through what hides them.
    pub guide_solids: Vec<Solid>,
    pub guide_balls: Vec<Ball>,
    pub shells: Vec<Shell>,
    /// Drawn over everything solid.
    pub globe: Option<Globe>,
    /// Many arms in the rig's place, solved where they are drawn.
    pub crowd: Option<Crowd>,
    pub lines: Vec<Line>,
    pub labels: Vec<Label>,
    /// What all labels say, one after the other.
    letters: String,
    scratch: Scratch,
}

/// The planes around the arm: which are drawn, and the middle and radius within which they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    pub grid_xy: bool,
    pub grid_xz: bool,
    pub grid_yz: bool,
    pub ground: bool,
    pub centre: Vec3,
    pub radius: f32,
    /// How wide the grids' cells are.
    pub cell: f32,
}

/// A cone at a rigid place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    pub place: Affine3A,
    pub shape: Cone,
    pub colour: Colour,
    /// Darker lines along the side that wind by so many radians from base to tip, right-handed about
    /// the solid's +x; none without a finite angle.
    pub stripes: Option<f32>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    pub centre: Vec3,
    pub radius: f32,
    pub colour: Colour,
}

/// A sphere that one can see through, with a brighter rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    pub centre: Vec3,
    pub radius: f32,
    pub colour: Colour,
}

/// A line, as wide on screen wherever it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    pub from: Vec3,
    pub to: Vec3,
    pub colour: Colour,
    pub dashed: bool,
}

/// A limb as its shadow sees it: two balls and what is between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadow {
    pub base: Vec3,
    pub base_radius: f32,
    pub tip: Vec3,
    pub tip_radius: f32,
}

/// Of crowds that are drawn: beyond, squares of their lengths end, on the device too.
const SIZES: core::ops::Range<f32> = 1e-12..1e15;

impl Scene {
    /// The document as it stands, with what goes on around it.
    pub fn new(document: &Document, overlays: &Overlays, theme: Theme) -> Self {
        let mut scene = Self::empty(document, theme);
        scene.refill(document, overlays, theme);
        scene
    }

    /// Becomes what [`Scene::new`] would make, in the memory that it has.
    pub fn refill(&mut self, document: &Document, overlays: &Overlays, theme: Theme) {
        self.clear();
        let display = document.display;
        let (centre, reach, cell) = match document.rig {
            RigKind::Arm => {
                let arm = &document.arm;
                (arm.root, arm.bones.outer_limit(), arm.cell())
            }
            RigKind::Skeleton => skeleton::stage(&document.skeleton_rig, &mut self.scratch),
        };
        self.camera = document.camera;
        self.palette = Palette::new(theme);
        if let Some(crowd) = overlays.crowd {
            if SIZES.contains(&crowd.bounds().1) {
                self.stage = Stage::around_crowd(&crowd, display);
                self.crowd = Some(crowd);
            }
            return;
        }
        self.stage = Stage::around(centre, reach, cell, display);
        if display.shows(Overlay::Axes) {
            self.add_axes(reach);
        }
        match document.rig {
            RigKind::Arm => {
                arm::add(self, &document.arm, &document.arm.pose(), display);
                if display.shows(Overlay::References) {
                    references::add(self, &document.arm, overlays.transported);
                }
            }
            RigKind::Skeleton => skeleton::add(self, &document.skeleton_rig, overlays, display),
        }
        motion::add(self, document, overlays, reach);
        self.leave_out_endless();
    }

    fn empty(document: &Document, theme: Theme) -> Self {
        Self {
            camera: document.camera,
            palette: Palette::new(theme),
            stage: Stage::around(Vec3::ZERO, 0.0, 1.0, document.display),
            shadows: Vec::new(),
            solids: Vec::new(),
            balls: Vec::new(),
            guide_solids: Vec::new(),
            guide_balls: Vec::new(),
            shells: Vec::new(),
            globe: None,
            crowd: None,
            lines: Vec::new(),
            labels: Vec::new(),
            letters: String::new(),
            scratch: Scratch::default(),
        }
    }

    fn clear(&mut self) {
        self.shadows.clear();
        self.solids.clear();
        self.balls.clear();
        self.guide_solids.clear();
        self.guide_balls.clear();
        self.shells.clear();
        self.globe = None;
        self.crowd = None;
        self.lines.clear();
        self.labels.clear();
        self.letters.clear();
    }

    /// What is so far away or so large that numbers end is not drawn.
    fn leave_out_endless(&mut self) {
        let is_size = |size: f32| size.is_finite();
        for solids in [&mut self.solids, &mut self.guide_solids] {
            solids.retain(|Solid { place, shape, .. }| {
                let sizes = [shape.length, shape.base_radius, shape.tip_radius];
                place.is_finite() && sizes.into_iter().all(is_size)
            });
        }
        for balls in [&mut self.balls, &mut self.guide_balls] {
            balls.retain(|ball| ball.centre.is_finite() && is_size(ball.radius));
        }
        self.shells.retain(|shell| shell.centre.is_finite() && is_size(shell.radius));
        self.lines.retain(|line| line.from.is_finite() && line.to.is_finite());
        self.labels.retain(|label| label.at.is_finite() && is_size(label.clearance));
        self.shadows.retain(|Shadow { base, base_radius, tip, tip_radius }| {
            let ends = base.is_finite() && tip.is_finite();
            ends && is_size(*base_radius) && is_size(*tip_radius)
        });
    }

    /// Shows the globe, and marks each singular direction on it with a ball and a label.
    pub fn add_globe(&mut self, globe: Globe) {
        globe::add(self, globe);
    }

    /// Adds a right hand of cones and balls, in a cuff of the lower limb's colour. `place` is its
    /// wrist, rigid: +x is towards the fingertips, +y out of the back (the palm faces −y), +z on the
    /// little finger's side (the thumb is at −z). `size` is from the wrist to the tip of the middle
    /// finger.
    pub fn add_hand(&mut self, place: Affine3A, size: f32, colour: Colour) {
        hand::add(self, place, size, colour);
    }

    /// Three arrows from the world's origin, half as long as the rig reaches.
    fn add_axes(&mut self, reach: f32) {
        let length = 0.5 * reach;
        let (shaft, head, head_length) = (length * 0.009, length * 0.034, length * 0.12);
        for (axis, colour) in Vec3::AXES.into_iter().zip(self.palette.axes) {
            let neck = axis * (length - head_length);
            self.add_solid(Vec3::ZERO, neck, shaft, shaft, colour);
            self.add_solid(neck, axis * length, head, 0.0, colour);
        }
    }

    fn add_solid(
        &mut self,
        base: Vec3,
        tip: Vec3,
        base_radius: f32,
        tip_radius: f32,
        colour: Colour,
    ) {
        let (place, shape) = Cone::between(base, tip, base_radius, tip_radius);
        self.solids.push(Solid { place, shape, colour, stripes: None });
    }
}

impl Stage {
    /// The planes reach well past the rig, so that it has ground to stand on wherever it points.
    const RADIUS: f32 = 1.7;

    /// As far as there are arms, on the ground alone, with cells as large as an arm's share of it or
    /// tens of times as large.
    fn around_crowd(crowd: &Crowd, display: Display) -> Self {
        const CELLS: f32 = 200.0;
        let (centre, radius) = crowd.bounds();
        let reach = crowd.bones.outer_limit();
        let tens = (radius / (CELLS * reach)).max(1.0).log10().ceil();
        Self {
            grid_xy: false,
            grid_yz: false,
            ..Self::around(centre, radius, reach * 10_f32.powf(tens), display)
        }
    }

    fn around(centre: Vec3, reach: f32, cell: f32, display: Display) -> Self {
        Self {
            grid_xy: display.shows(Overlay::GridXy),
            grid_xz: display.shows(Overlay::GridXz),
            grid_yz: display.shows(Overlay::GridYz),
            ground: display.shows(Overlay::Ground),
            centre,
            radius: (Self::RADIUS * reach).min(f32::MAX),
            cell,
        }
    }
}
