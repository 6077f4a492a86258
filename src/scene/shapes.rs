use glam::{Affine3A, Vec3};

use super::Colour;
use crate::rig::TaperedCylinder;

/// A tapered cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Rigid transform from its space, in which it lies along +x, to the world.
    pub transform: Affine3A,
    /// Length and radii.
    pub shape: TaperedCylinder,
    /// Colour of the surface.
    pub colour: Colour,
    /// Winding of darker stripes along the side from base to tip, in radians, right-handed about the
    /// solid's +x; `None` or a non-finite angle for no stripes.
    pub stripes: Option<f32>,
}

/// An opaque sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre in the world.
    pub centre: Vec3,
    /// Radius in world units.
    pub radius: f32,
    /// Colour of the surface.
    pub colour: Colour,
}

/// A see-through sphere with a brighter rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereShell {
    /// Centre in the world.
    pub centre: Vec3,
    /// Radius in world units.
    pub radius: f32,
    /// Colour of the surface.
    pub colour: Colour,
}

/// A line of constant width on screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Start in the world.
    pub from: Vec3,
    /// End in the world.
    pub to: Vec3,
    /// Colour, with opacity.
    pub colour: Colour,
    /// Whether it is dashed.
    pub dashed: bool,
}

/// A limb that casts a shadow on the ground: two balls and the space between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadow {
    /// Centre of the ball at the base, in the world.
    pub base: Vec3,
    /// Radius at the base.
    pub base_radius: f32,
    /// Centre of the ball at the tip, in the world.
    pub tip: Vec3,
    /// Radius at the tip.
    pub tip_radius: f32,
}
