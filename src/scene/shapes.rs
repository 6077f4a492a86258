use glam::{Affine3A, Vec3};

use super::Colour;
use crate::document::{Display, Overlay};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::{SkinPose, Skinning};
use crate::rig::{AttachedMesh, Crowd, TaperedCylinder};

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
    /// True if the line is dashed.
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

impl Shadow {
    /// Cuts off the part of the limb below the ground, since that part casts no shadow; `None` if
    /// the whole limb is below.
    pub(super) fn above_ground(self) -> Option<Self> {
        let at = |fraction: f32| {
            let radius = self.base_radius + (self.tip_radius - self.base_radius) * fraction;
            (self.base.lerp(self.tip, fraction), radius)
        };
        let (base_y, tip_y) = (self.base.y, self.tip.y);
        let crossing = base_y / (base_y - tip_y);
        let (from, to) = match (base_y >= 0.0, tip_y >= 0.0) {
            (true, true) => return Some(self),
            (true, false) => (0.0, crossing),
            (false, true) => (crossing, 1.0),
            (false, false) => return None,
        };
        let ((base, base_radius), (tip, tip_radius)) = (at(from), at(to));
        let flat = |v: Vec3| Vec3 { y: v.y.max(0.0), ..v };
        Some(Self { base: flat(base), base_radius, tip: flat(tip), tip_radius })
    }
}

/// A skin in a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinInstance {
    /// The mesh. Clones of one mesh are sent to the device once.
    pub mesh: Shared<AttachedMesh>,
    /// Transforms by which the joints move the mesh.
    pub pose: Shared<SkinPose>,
    /// Way of blending the joints of a vertex.
    pub skinning: Skinning,
    /// Offset in the world.
    pub offset: Vec3,
    /// Colour of the surface, with opacity. Where a see-through skin overlaps itself, only its
    /// nearest surface is drawn.
    pub colour: Colour,
    /// Colour of the edges of the triangles; `None` hides them.
    pub wireframe: Option<Colour>,
    /// The joint whose weights colour the surface; `None` for the plain colour.
    pub weights_of: Option<JointId>,
}

/// The ground and the grids: planes through the world's origin, drawn around a centre up to a
/// radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    /// True if the grid in the plane z = 0 is drawn.
    pub grid_xy: bool,
    /// True if the grid in the plane y = 0 is drawn.
    pub grid_xz: bool,
    /// True if the grid in the plane x = 0 is drawn.
    pub grid_yz: bool,
    /// True if the ground is drawn.
    pub ground: bool,
    /// Centre of the drawn part, in the world.
    pub centre: Vec3,
    /// Radius in world units at which the vertical grids have faded out. The ground reaches about
    /// twice as far.
    pub radius: f32,
    /// Width of a grid cell in world units.
    pub cell: f32,
}

impl Planes {
    /// Ratio of the radius of the planes to the reach of the rig, large enough that the rig has
    /// ground below it in every pose.
    const RADIUS: f32 = 1.7;

    /// The planes that `display` shows, around a rig of this centre and reach.
    pub(super) fn around(centre: Vec3, reach: f32, cell: f32, display: Display) -> Self {
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

    /// The ground and its grid under a crowd. A grid cell is as wide as an arm is long, or a power
    /// of ten times that in a large crowd.
    pub(super) fn around_crowd(crowd: &Crowd, display: Display) -> Self {
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
}
