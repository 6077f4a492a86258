use glam::{Affine3A, Mat3, Mat3A, Vec3};

use crate::soft_reach::ReachLimits;
use crate::two_bone::{TwoBone, TwoBonePose};

/// A part of the arm. Parents come before their children in the order of the variants.
///
/// Symbols are those of [`two_bone`](crate::two_bone) and
/// [`twist`](crate::twist).
///
/// ```text
/// Root                 translation = shoulder in the world
///  ├ Limb              rotation = R_y(−θ_z)·R_z(θ_y): points +x, the Pointer, at the hand
///  │  ├ Socket         rotation = R_x(ψ_ref + ψ): rotates the elbow about the Pointer
///  │  │  ├ UpperLimb   from the origin to (h_e, o_e, 0)
///  │  │  ├ LowerLimb   from (h_e, o_e, 0) to (D, 0, 0)
///  │  │  ├ Elbow       at (h_e, o_e, 0)
///  │  │  └ Hand        at (D, 0, 0)
///  │  └ Pointer        along +x, as far as the hand can reach
///  ├ Cursor            the hand's target
///  ├ InnerLimit        sphere of radius ReachLimits::inner, |d₁ − d₂| with hard limits
///  └ OuterLimit        sphere of radius ReachLimits::outer, d₁ + d₂ with hard limits
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArmPart {
    /// The shoulder; the root of the hierarchy.
    Root,
    /// Frame whose +x points at the hand.
    Limb,
    /// Frame of the Limb, rotated about the Pointer by the twist.
    Socket,
    /// Upper limb, from shoulder to elbow.
    UpperLimb,
    /// Lower limb, from elbow to hand.
    LowerLimb,
    /// Elbow joint.
    Elbow,
    /// Hand.
    Hand,
    /// Axis from the shoulder through the hand.
    Pointer,
    /// Target of the hand.
    Cursor,
    /// Sphere that the hand cannot enter.
    InnerLimit,
    /// Sphere that the hand cannot leave.
    OuterLimit,
}

impl ArmPart {
    /// All parts, parents before children.
    pub const ALL: [Self; 11] = [
        Self::Root,
        Self::Limb,
        Self::Socket,
        Self::UpperLimb,
        Self::LowerLimb,
        Self::Elbow,
        Self::Hand,
        Self::Pointer,
        Self::Cursor,
        Self::InnerLimit,
        Self::OuterLimit,
    ];

    /// The parent in the hierarchy; `None` for the Root.
    pub fn parent(self) -> Option<Self> {
        match self {
            Self::Root => None,
            Self::Limb | Self::Cursor | Self::InnerLimit | Self::OuterLimit => Some(Self::Root),
            Self::Socket | Self::Pointer => Some(Self::Limb),
            Self::UpperLimb | Self::LowerLimb | Self::Elbow | Self::Hand => Some(Self::Socket),
        }
    }
}

/// A posed arm as a hierarchy of rigid transforms.
///
/// World transforms are products of the local transforms down the hierarchy. They do not use the
/// positions of elbow and hand in the solver's pose.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmRig {
    local: [Affine3A; ArmPart::ALL.len()],
    upper: TaperedCylinder,
    lower: TaperedCylinder,
    pointer: TaperedCylinder,
    limits: ReachLimits,
}

impl ArmRig {
    /// Radius of a limb at its base for an arm of length [`Self::SEED_LENGTH`], as in Palmieri's
    /// report; [`Self::TIP_RADIUS`] is the radius at its tip. [`Self::thickness`] scales both to
    /// other arms.
    const BASE_RADIUS: f32 = 30.0;
    const TIP_RADIUS: f32 = 20.0;
    const POINTER_RADIUS: f32 = 4.0;
    const SEED_LENGTH: f32 = 500.0;

    /// Makes the hierarchy of `pose`, with the shoulder at `root` in the world and guides that show
    /// `limits`. `pose` and `cursor` are in Root space.
    pub fn new(
        arm: TwoBone,
        limits: ReachLimits,
        root: Vec3,
        cursor: Vec3,
        pose: &TwoBonePose,
    ) -> Self {
        let thickness = Self::thickness(arm);
        let (base_radius, tip_radius) =
            (Self::BASE_RADIUS * thickness, Self::TIP_RADIUS * thickness);
        let elbow = Vec3::new(pose.along, pose.out, 0.0);
        let hand = Vec3::new(pose.distance, 0.0, 0.0);
        let (upper_limb, upper) =
            TaperedCylinder::in_xy_plane(Vec3::ZERO, elbow, base_radius, tip_radius);
        let (lower_limb, lower) =
            TaperedCylinder::in_xy_plane(elbow, hand, base_radius, tip_radius);
        let pointer_radius = Self::POINTER_RADIUS * thickness;

        let local = ArmPart::ALL.map(|part| match part {
            ArmPart::Root => Affine3A::from_translation(root),
            ArmPart::Limb => Affine3A::from_mat3(pose.pointer.limb_frame()),
            ArmPart::Socket => Affine3A::from_mat3(Mat3A::from_rotation_x(pose.twist).into()),
            ArmPart::UpperLimb => upper_limb,
            ArmPart::LowerLimb => lower_limb,
            ArmPart::Elbow => Affine3A::from_translation(elbow),
            ArmPart::Hand => Affine3A::from_translation(hand),
            ArmPart::Cursor => Affine3A::from_translation(cursor),
            ArmPart::Pointer | ArmPart::InnerLimit | ArmPart::OuterLimit => Affine3A::IDENTITY,
        });
        Self {
            local,
            upper,
            lower,
            pointer: TaperedCylinder {
                length: limits.outer,
                base_radius: pointer_radius,
                tip_radius: pointer_radius,
            },
            limits,
        }
    }

    /// Ratio of the limbs' radii to the radii for an arm of length 500. It grows with the arm's
    /// length; the base radius never exceeds the length of the shorter bone.
    pub fn thickness(arm: TwoBone) -> f32 {
        let shorter = arm.upper().min(arm.lower());
        (arm.outer_limit() / Self::SEED_LENGTH).min(shorter / Self::BASE_RADIUS)
    }

    /// Transform from the part's space to its parent's; for the Root, to the world.
    pub fn local(&self, part: ArmPart) -> Affine3A {
        self.local[part as usize]
    }

    /// Transform from the part's space to the world.
    pub fn world(&self, part: ArmPart) -> Affine3A {
        match part.parent() {
            Some(parent) => self.world(parent) * self.local(part),
            None => self.local(part),
        }
    }

    /// Position of the part's origin in the world.
    pub fn origin(&self, part: ArmPart) -> Vec3 {
        self.world(part).translation.into()
    }

    /// Shape of the upper limb, along +x of [`ArmPart::UpperLimb`].
    pub fn upper(&self) -> TaperedCylinder {
        self.upper
    }

    /// Shape of the lower limb, along +x of [`ArmPart::LowerLimb`].
    pub fn lower(&self) -> TaperedCylinder {
        self.lower
    }

    /// Shape of the Pointer, along +x of [`ArmPart::Limb`].
    pub fn pointer(&self) -> TaperedCylinder {
        self.pointer
    }

    /// Radii of [`ArmPart::InnerLimit`] and [`ArmPart::OuterLimit`].
    pub fn limits(&self) -> ReachLimits {
        self.limits
    }
}

/// A tapered cylinder along +x from the origin.
///
/// [`TaperedCylinder::between`] builds the rotation from an orthonormal basis, without an arc
/// cosine, so that it is exact in every direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaperedCylinder {
    /// Length along +x.
    pub length: f32,
    /// Radius at the origin.
    pub base_radius: f32,
    /// Radius at `length`; 0 makes a true cone.
    pub tip_radius: f32,
}

impl TaperedCylinder {
    /// Returns the cylinder from `base` to `tip` and the transform that places it there: a
    /// translation to `base`, and a rotation that turns +x towards `tip`, with any roll. If both
    /// points coincide, +x keeps its direction.
    pub fn between(base: Vec3, tip: Vec3, base_radius: f32, tip_radius: f32) -> (Affine3A, Self) {
        let (x, length) = direction_and_length(tip - base);
        let (y, z) = x.any_orthonormal_pair();
        let place = Affine3A::from_mat3_translation(Mat3::from_cols(x, y, z), base);
        (place, Self { length, base_radius, tip_radius })
    }

    /// As [`Self::between`], for ends in the xy-plane: the rotation is about z.
    pub fn in_xy_plane(
        base: Vec3,
        tip: Vec3,
        base_radius: f32,
        tip_radius: f32,
    ) -> (Affine3A, Self) {
        let (x, length) = direction_and_length((tip - base).with_z(0.0));
        let y = Vec3::new(-x.y, x.x, 0.0);
        let place = Affine3A::from_mat3_translation(Mat3::from_cols(x, y, Vec3::Z), base);
        (place, Self { length, base_radius, tip_radius })
    }
}

/// Direction and length of a vector; +x and 0 for the zero vector. The vector is scaled before it
/// is squared, so that neither huge nor tiny vectors lose their direction.
fn direction_and_length(v: Vec3) -> (Vec3, f32) {
    let size = v.abs().max_element();
    if size == 0.0 {
        return (Vec3::X, 0.0);
    }
    let (direction, length) = (v / size).normalize_and_length();
    (direction, length * size)
}
