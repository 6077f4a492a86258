use serde::{Deserialize, Serialize};

/// Colour theme of the window and the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

/// A part of the scene that is shown or hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Overlay {
    /// The targets.
    Cursor,
    /// The Pointer of the limb: the axis from its base through hand and target.
    Pointer,
    /// The sphere around the limb's base that the hand cannot enter.
    InnerLimit,
    /// The sphere around the limb's base that the hand cannot leave.
    OuterLimit,
    /// The circle on which the elbow can be while the hand stays.
    ElbowCircle,
    /// The grid on the plane z = 0.
    GridXy,
    /// The grid on the plane y = 0.
    GridXz,
    /// The grid on the plane x = 0.
    GridYz,
    /// The ground.
    Ground,
    /// The axes of the world.
    Axes,
    /// The names of the parts.
    Labels,
    /// The shadow on the ground.
    Shadow,
    /// The path of the selected joint's tip over time; without a selection, of the limb's hand.
    Trail,
    /// The paths that heads follow.
    Paths,
    /// The rig at some frames before and after the current time.
    OnionSkins,
    /// The Outer Limit, coloured by how fast the elbow swings when the Pointer turns there.
    SingularityGlobe,
    /// The limb as every other kind of twist reference would pose it.
    TwistReferences,
    /// The limbs as tapered cylinders instead of bones.
    Cylinders,
    /// A hand at the end of each limb that is a cylinder, whose forearm winds as it rolls.
    Hand,
    /// The axes of the limb's Root, Limb and Socket.
    Frames,
    /// The FK pose, beside the pose that the targets give.
    FkPose,
    /// The skeleton as this frame alone would pose it, beside the pose to which its motion has
    /// come.
    ByItself,
    /// The skin of a skeleton that has one.
    Skin,
    /// The bones of a skeleton with a skin, through the skin. Without it, the bones are hidden
    /// while the skin is shown.
    Bones,
    /// The edges of the skin's triangles.
    Wireframe,
    /// The weights of the selected joint, as colours of the skin.
    SkinWeights,
    /// The skin three times side by side, once for each way of blending joints.
    CompareSkinning,
    /// The bones, through the skin, coloured by the stiffness of their joints.
    Stiffness,
    /// The centre of mass, and what the figure stands on.
    Balance,
    /// The places at which the target of the selected joint is reached.
    ReachRegion,
    /// The limits of the selected joint, as fans.
    JointLimits,
}

impl Overlay {
    /// Name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cursor => "cursor",
            Self::Pointer => "pointer",
            Self::InnerLimit => "inner_limit",
            Self::OuterLimit => "outer_limit",
            Self::ElbowCircle => "elbow_circle",
            Self::GridXy => "grid_xy",
            Self::GridXz => "grid_xz",
            Self::GridYz => "grid_yz",
            Self::Ground => "ground",
            Self::Axes => "axes",
            Self::Labels => "labels",
            Self::Shadow => "shadow",
            Self::Trail => "trail",
            Self::Paths => "paths",
            Self::OnionSkins => "onion_skins",
            Self::SingularityGlobe => "singularity_globe",
            Self::TwistReferences => "twist_references",
            Self::Cylinders => "cylinders",
            Self::Hand => "hand",
            Self::Frames => "frames",
            Self::FkPose => "fk_pose",
            Self::ByItself => "by_itself",
            Self::Skin => "skin",
            Self::Bones => "bones",
            Self::Wireframe => "wireframe",
            Self::SkinWeights => "skin_weights",
            Self::CompareSkinning => "compare_skinning",
            Self::Stiffness => "stiffness",
            Self::Balance => "balance",
            Self::ReachRegion => "reach_region",
            Self::JointLimits => "joint_limits",
        }
    }

    /// The overlay that has this [`name`](Self::name); `None` if no overlay has it.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|overlay| overlay.name() == name)
    }

    /// All overlays, in the order in which panels list them.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_limb = Self::GUIDES.into_iter().chain(Self::LIMB);
        of_limb.chain(Self::POSE).chain(Self::MOTION).chain(Self::SURROUNDINGS)
    }

    /// Guides of a limb: Cursor, Pointer, limits and the circle of elbows.
    pub const GUIDES: [Self; 5] =
        [Self::Cursor, Self::Pointer, Self::InnerLimit, Self::OuterLimit, Self::ElbowCircle];

    /// Overlays of limbs besides [`Self::GUIDES`].
    pub const LIMB: [Self; 5] =
        [Self::Cylinders, Self::Hand, Self::Frames, Self::SingularityGlobe, Self::TwistReferences];

    /// Other poses, the skin, and properties of joints.
    pub const POSE: [Self; 11] = [
        Self::FkPose,
        Self::ByItself,
        Self::Skin,
        Self::Bones,
        Self::Wireframe,
        Self::SkinWeights,
        Self::CompareSkinning,
        Self::Stiffness,
        Self::Balance,
        Self::ReachRegion,
        Self::JointLimits,
    ];

    /// Overlays that show motion over time.
    pub const MOTION: [Self; 3] = [Self::Trail, Self::OnionSkins, Self::Paths];

    /// Overlays of the rig's surroundings.
    pub const SURROUNDINGS: [Self; 7] = [
        Self::GridXy,
        Self::GridXz,
        Self::GridYz,
        Self::Ground,
        Self::Axes,
        Self::Labels,
        Self::Shadow,
    ];
}

/// The set of overlays that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Display {
    shown: u32,
}

impl Display {
    /// True if an overlay is shown.
    pub fn shows(self, overlay: Overlay) -> bool {
        self.shown & bit(overlay) != 0
    }

    /// Shows or hides an overlay.
    #[must_use]
    pub fn with(mut self, overlay: Overlay, shown: bool) -> Self {
        if shown {
            self.shown |= bit(overlay);
        } else {
            self.shown &= !bit(overlay);
        }
        self
    }

    /// True if the bones are drawn although the skin is shown.
    pub fn shows_bones_in_skin(self) -> bool {
        self.shows(Overlay::Bones) || self.shows(Overlay::Stiffness)
    }

    /// The overlays that are shown.
    pub fn overlays(self) -> impl Iterator<Item = Overlay> {
        Overlay::all().filter(move |overlay| self.shows(*overlay))
    }
}

/// Collects overlays into a display that shows exactly these.
impl FromIterator<Overlay> for Display {
    fn from_iter<T: IntoIterator<Item = Overlay>>(overlays: T) -> Self {
        overlays.into_iter().fold(Self { shown: 0 }, |display, overlay| display.with(overlay, true))
    }
}

impl Display {
    /// The display of the arm: the default, with Pointer, cylinders and hand. The limits are hidden,
    /// since their spheres would cover the arm.
    pub fn of_arm() -> Self {
        let limb = [Overlay::Pointer, Overlay::Cylinders, Overlay::Hand];
        limb.into_iter().fold(Self::default(), |display, overlay| display.with(overlay, true))
    }
}

impl Default for Display {
    /// A display of the surroundings without the walls, targets, skin, trail and paths.
    fn default() -> Self {
        let shown = [Overlay::Cursor, Overlay::Skin, Overlay::Trail, Overlay::Paths];
        let is_wall = |overlay: &Overlay| matches!(overlay, Overlay::GridXy | Overlay::GridYz);
        let surroundings = Overlay::SURROUNDINGS.into_iter().filter(|overlay| !is_wall(overlay));
        surroundings.chain(shown).collect()
    }
}

fn bit(overlay: Overlay) -> u32 {
    1 << overlay as u16
}
