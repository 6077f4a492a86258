use glam::Vec3;

use super::limb_settings::LimbSettings;
use super::target_motion::{TargetMotion, TargetPath};
use super::target_space::TargetSpace;
use crate::limb_ik::ElbowReference;
use crate::skeleton::{JointId, JointRemap, Skeleton};

/// A target of a skeleton: a point that the tip of a joint's bone should reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Joint whose tip should reach the target.
    pub joint: JointId,
    /// Position at time 0, in [`Target::space`].
    pub home: Vec3,
    /// The space of the position and of the hand's orientation.
    pub space: TargetSpace,
    /// The joints that the target moves, and how.
    pub kind: TargetKind,
    /// Fraction of the way from the FK pose, 0, to the solved pose, 1.
    pub influence: f32,
    /// Weight relative to the other whole-body targets, above 0.
    pub weight: f32,
    /// Whether the target has any effect.
    pub enabled: bool,
    /// Motion in time, in the target's space.
    pub motion: TargetMotion,
}

/// The joints that a target moves, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TargetKind {
    /// All joints from the root to the target's joint, together with those of the other whole-body
    /// targets, by the rig's solver.
    #[default]
    WholeBody,
    /// The two bones of the [`Limb`](crate::limb_ik::Limb) that ends at the tip of the
    /// target's joint, in closed form.
    Limb(LimbSettings),
}

impl Target {
    /// An enabled whole-body target in the world, without influence, that stays at its home. `radius`
    /// is the radius of the path that it will have once it moves.
    pub fn new(joint: JointId, home: Vec3, radius: f32) -> Self {
        let motion = TargetMotion { path: TargetPath::Still, radius, period: 4.0 };
        Self {
            joint,
            home,
            space: TargetSpace::World,
            kind: TargetKind::WholeBody,
            influence: 0.0,
            weight: 1.0,
            enabled: true,
            motion,
        }
    }

    /// Settings of a limb target; `None` for a whole-body target.
    pub fn limb(&self) -> Option<&LimbSettings> {
        match &self.kind {
            TargetKind::WholeBody => None,
            TargetKind::Limb(settings) => Some(settings),
        }
    }

    /// Settings of a limb target; `None` for a whole-body target.
    pub fn limb_mut(&mut self) -> Option<&mut LimbSettings> {
        match &mut self.kind {
            TargetKind::WholeBody => None,
            TargetKind::Limb(settings) => Some(settings),
        }
    }

    /// Whether the settings of a limb target are finite.
    pub fn has_finite_kind(&self) -> bool {
        self.limb().is_none_or(LimbSettings::is_finite)
    }

    /// Whether the target poses the skeleton.
    pub fn is_posing(&self) -> bool {
        self.enabled && self.influence > 0.0
    }

    /// Whether the target poses the skeleton between its FK pose and the solved one.
    pub fn is_blended(&self) -> bool {
        self.is_posing() && self.influence < 1.0
    }

    /// Whether the target moves over time without keys.
    pub fn is_moving(&self) -> bool {
        self.motion.path != TargetPath::Still
    }

    /// Position at a time in seconds, in the target's space.
    pub fn at(&self, time: f64) -> Vec3 {
        self.home + self.motion.offset(time)
    }

    /// Position at a time in seconds, in the world, for a pose of the skeleton.
    pub fn in_world(&self, pose: &Skeleton, time: f64) -> Vec3 {
        self.space.to_world(pose).transform_point3(self.at(time))
    }

    /// The target with its position at `time`, in seconds, at `point` in the world.
    #[must_use]
    pub fn placed(self, pose: &Skeleton, time: f64, point: Vec3) -> Self {
        let home = self.space.point_from_world(pose, point) - self.motion.offset(time);
        Self { home, ..self }
    }

    /// The target in another space, where it is in the world at `time`, in seconds; the hand keeps its
    /// orientation. Its angles are the equivalent ones nearest to `near`, or to those that it has.
    #[must_use]
    pub fn in_space(
        self,
        space: TargetSpace,
        pose: &Skeleton,
        time: f64,
        near: Option<Vec3>,
    ) -> Self {
        if space == self.space {
            return self;
        }
        let mut after = Self { space, ..self }.placed(pose, time, self.in_world(pose, time));
        if let Some(limb) = after.limb_mut()
            && let Some(rotation) = limb.hand_in_world(pose, self.space)
        {
            let near = near.or(limb.orientation).unwrap_or_default();
            limb.orientation = Some(space.angles_from_world(pose, rotation, near));
        }
        after
    }

    /// The target with its limb's pole in another space, where it is in the world.
    #[must_use]
    pub fn with_pole_in_space(mut self, space: TargetSpace, pose: &Skeleton) -> Self {
        if let Some(limb) = self.limb_mut() {
            let place = limb.pole_in_world(pose);
            if let Some(place) = place.filter(|_| space != limb.pole_space) {
                limb.reference = ElbowReference::Pole(space.point_from_world(pose, place));
            }
            limb.pole_space = space;
        }
        self
    }

    /// The spaces that the target's position, orientation and pole depend on.
    pub(super) fn spaces(&self) -> impl Iterator<Item = TargetSpace> {
        [self.space].into_iter().chain(self.limb().and_then(LimbSettings::pole).map(|pole| pole.0))
    }

    /// The same target after joints were renumbered; `None` if its joint was removed.
    #[must_use]
    pub(super) fn remapped(mut self, remap: &JointRemap) -> Option<Self> {
        self.joint = remap.get(self.joint)?;
        self.space = self.space.remapped(remap);
        if let Some(settings) = self.limb_mut() {
            settings.pole_space = settings.pole_space.remapped(remap);
        }
        Some(self)
    }
}
