use glam::{Affine3A, Mat3, Vec2, Vec3};

use super::Colour;
use crate::document::{Camera, Display, Overlay};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::{SkinPose, Skinning};
use crate::kinematics::twist::TwistReference;
use crate::rig::{AttachedMesh, Crowd, TaperedCylinder};

/// Distance of a text from its ball, in points.
const GAP: f32 = 3.0;
/// Distance from a point along both axes of the picture at which a text is clear of the squares and
/// the free handle around the point, in points.
const HANDLES: f32 = 46.0;

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
    /// Angle in radians by which the side winds from base to tip, right-handed about the solid's +x.
    /// The section of a solid that winds becomes flatter towards the tip, thinnest along its y; it
    /// stays round if this is `None` or not finite.
    pub winding: Option<f32>,
}

impl Solid {
    /// A cone from base to tip, both in the world.
    pub(super) fn cone(
        base: Vec3,
        tip: Vec3,
        base_radius: f32,
        tip_radius: f32,
        colour: Colour,
    ) -> Self {
        let (transform, shape) = TaperedCylinder::between(base, tip, base_radius, tip_radius);
        Self { transform, shape, colour, winding: None }
    }
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

/// A right hand with the surface of [`hand_mesh`](super::hand_mesh).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// Rigid transform to the world from the space of the wrist.
    pub transform: Affine3A,
    /// Distance from the wrist to the tip of the middle finger, in world units.
    pub size: f32,
    /// Colour of the surface.
    pub colour: Colour,
}

impl Hand {
    /// Centres and radii in the world of two balls whose hull is about the hand.
    pub fn ends(&self) -> [(Vec3, f32); 2] {
        [(0.1, 0.16), (0.75, 0.13)].map(|(along, radius)| {
            (self.transform.transform_point3(Vec3::X * along * self.size), radius * self.size)
        })
    }
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
    /// The joint whose weights colour the surface, and how; `None` for the plain colour.
    pub weights_of: Option<(JointId, WeightColours)>,
}

/// Colours of the weights of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WeightColours {
    /// The colours of [`Palette::weight`](super::Palette::weight).
    Ramp,
    /// This colour over the plain one: with its own opacity where the weight is 1.
    Tint(Colour),
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
    /// Opacity of the ground, from 0 to 1.
    pub ground_opacity: f32,
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
    /// Opacity of the ground while everything stands on it, and while a part of the rig is well below
    /// it and must be seen.
    const SOLID: f32 = 1.0;
    const CLEAR: f32 = 0.75;
    /// Depth below the ground from which it is clear, as a fraction of the rig's reach.
    const DEPTH: f32 = 0.08;

    /// The planes that `display` shows, around a rig of this centre and reach.
    pub(super) fn around(centre: Vec3, reach: f32, cell: f32, display: Display) -> Self {
        Self {
            grid_xy: display.shows(Overlay::GridXy),
            grid_xz: display.shows(Overlay::GridXz),
            grid_yz: display.shows(Overlay::GridYz),
            ground: display.shows(Overlay::Ground),
            ground_opacity: Self::SOLID,
            centre,
            radius: (Self::RADIUS * reach).min(f32::MAX),
            cell,
        }
    }

    /// Lets joints below the ground be seen through it. `lowest` is the least y of a joint, and `reach`
    /// that of the rig.
    pub(super) fn clear(&mut self, lowest: f32, reach: f32) {
        let part = if lowest < 0.0 { (-lowest / (Self::DEPTH * reach)).min(1.0) } else { 0.0 };
        self.ground_opacity = Self::SOLID + part * (Self::CLEAR - Self::SOLID);
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

/// Sphere of all directions of the Pointer, coloured by the [gain](TwistReference::gain) of the
/// twist reference in each direction: radians that the elbow swings per radian that the Pointer
/// turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Globe {
    /// Position of the shoulder in the world.
    pub centre: Vec3,
    /// Radius in world units.
    pub radius: f32,
    /// Twist reference, whose gains colour the globe, in Root space.
    pub reference: TwistReference,
    /// Axes of Root space in the world.
    pub axes: Mat3,
}

impl Globe {
    /// Unit vectors in the world of the directions in which the reference is singular: none, one,
    /// or two opposite ones.
    ///
    /// A pole at the shoulder has no direction, so it acts like [`TwistReference::Transport`],
    /// which is singular nowhere.
    pub fn singular(&self) -> impl Iterator<Item = Vec3> + Clone {
        let both = |axis: Vec3| [Some(axis), Some(-axis)];
        let directions = match self.reference {
            TwistReference::Up => both(Vec3::Y),
            TwistReference::Pole(pole) => {
                let axis = pole.as_dvec3().try_normalize();
                axis.map_or([None; 2], |axis| both(axis.as_vec3()))
            }
            TwistReference::Stereographic(map) => [Some(map.singular()), None],
            TwistReference::Transport => [None; 2],
        };
        let axes = self.axes;
        directions.into_iter().flatten().map(move |it| (axes * it).normalize_or(Vec3::Y))
    }

    /// Angle in radians from a singular direction to the directions with this gain. Of two opposite
    /// singular directions, the gain is the cotangent of the angle, of one the cotangent of its half.
    pub(super) fn angle_of_gain(&self, gain: f32) -> f32 {
        let acot = f32::atan2(1.0, gain);
        if matches!(self.reference, TwistReference::Stereographic(_)) { 2.0 * acot } else { acot }
    }

    /// True if the globe can be drawn: its centre and radius are finite, and the radius is above 0.
    pub fn has_size(&self) -> bool {
        self.centre.is_finite() && self.radius.is_finite() && self.radius > 0.0
    }
}

/// A label beside a point; [`Scene::text`](super::Scene::text) returns its text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// Point in the world that is labelled.
    pub at: Vec3,
    /// Radius in world units of a ball around the point that the text does not cover.
    pub clearance: f32,
    /// Distance of the text from the ball, in points.
    pub gap: f32,
    /// Side of the ball on which the text is written, if there is room.
    pub side: LabelSide,
    /// Colour of the text.
    pub colour: Colour,
    pub(super) text: TextRange,
}

/// Byte range of a label's text in the string of its scene. One string holds the texts of all
/// labels, so that refilling a scene allocates nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TextRange {
    pub from: usize,
    pub to: usize,
}

impl Label {
    pub(super) fn new(at: Vec3, clearance: f32, side: LabelSide, colour: Colour) -> Self {
        Self { at, clearance, gap: GAP, side, colour, text: TextRange::default() }
    }

    /// A label that is clear of the handles around its point.
    pub(super) fn clear_of_handles(self) -> Self {
        Self { gap: HANDLES, ..self }
    }
}

/// Position of a label's text relative to the labelled point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelSide {
    /// Above and to the right.
    Above,
    /// Below and to the right.
    Below,
    /// Above and to the left.
    AboveLeft,
    /// Below and to the left.
    BelowLeft,
    /// Above, in the middle.
    Over,
    /// Below, in the middle.
    Under,
}

impl LabelSide {
    /// The sides beside a point, at which a label may be placed if its own is taken.
    pub const ALL: [Self; 4] = [Self::Above, Self::Below, Self::AboveLeft, Self::BelowLeft];

    /// True if the text is to the left of the point.
    pub fn is_left(self) -> bool {
        matches!(self, Self::AboveLeft | Self::BelowLeft)
    }

    /// True if the text is above the point.
    pub fn is_above(self) -> bool {
        matches!(self, Self::Above | Self::AboveLeft | Self::Over)
    }

    /// The side of the point `at` that is farthest from the directions in which `others` are seen.
    pub(super) fn clear_of(others: &[Vec3], at: Vec3, camera: &Camera) -> Self {
        let projection = camera.projection(1.0);
        let [right, up] = [projection.right, projection.up].map(Vec3::normalize_or_zero);
        let seen = |other: &Vec3| {
            let away = *other - at;
            Vec2::new(away.dot(right), away.dot(up)).normalize_or_zero()
        };
        let nearness = |side: Self| {
            let x = if side.is_left() { -1.0 } else { 1.0 };
            let y = if side.is_above() { 1.0 } else { -1.0 };
            others.iter().map(|other| seen(other).dot(Vec2::new(x, y))).fold(f32::MIN, f32::max)
        };
        // Rounding must not decide between sides that are equally far.
        let rounded = |side: &Self| (nearness(*side) * 1e4).round();
        let sides = Self::ALL.into_iter();
        let clearest = sides.min_by(|one, other| rounded(one).total_cmp(&rounded(other)));
        clearest.unwrap_or(Self::Above)
    }
}
