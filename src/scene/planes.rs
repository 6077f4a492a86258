use glam::Vec3;

use crate::document::{Display, Overlay};
use crate::rig::Crowd;

/// The ground and the grids: planes through the world's origin, drawn around a centre up to a
/// radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    /// Whether the grid in the plane z = 0 is drawn.
    pub grid_xy: bool,
    /// Whether the grid in the plane y = 0 is drawn.
    pub grid_xz: bool,
    /// Whether the grid in the plane x = 0 is drawn.
    pub grid_yz: bool,
    /// Whether the ground is drawn.
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
