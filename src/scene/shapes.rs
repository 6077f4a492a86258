use glam::{Affine3A, Vec3};

use super::Colour;
use crate::rig::TaperedCylinder;

/// A tapered cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Rigid transform to the world from the solid's space, where the base is at the origin and the
    /// axis along +x.
    pub transform: Affine3A,
    /// Length and radii.
    pub shape: TaperedCylinder,
    /// Colour of the surface.
    pub colour: Colour,
    /// Angle in radians by which darker stripes along the side wind from base to tip, right-handed
    /// about the solid's +x. `None` or an angle that is not finite means no stripes.
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

/// A line whose width on screen does not depend on its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Start in the world.
    pub from: Vec3,
    /// End in the world.
    pub to: Vec3,
    /// Colour, with opacity.
    pub colour: Colour,
    /// Whether the line is dashed.
    pub dashed: bool,
}

/// A limb that casts a shadow on the ground: the hull of a ball at its base and a ball at its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadow {
    /// Centre of the ball at the base, in the world.
    pub base: Vec3,
    /// Radius of the ball at the base, in world units.
    pub base_radius: f32,
    /// Centre of the ball at the tip, in the world.
    pub tip: Vec3,
    /// Radius of the ball at the tip, in world units.
    pub tip_radius: f32,
}
