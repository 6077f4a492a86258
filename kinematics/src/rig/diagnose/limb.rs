//! Causes for the targets of limbs, which are solved in closed form.

use glam::Vec3;

use super::RigCase;
use crate::diagnosis::{
    Angle, Boundary, Cause, Diagnosis, Remedy, TriedRemedy, WiderLimit, is_fixed, limited_angles,
};
use crate::limb_ik::{Limb, LimbReach};
use crate::rig::evaluate::{TargetOutcome, TargetReport};
use crate::rig::target::LimbSettings;
use crate::skeleton::{JointId, RotationAxis, Skeleton};

/// The bones of a limb against the distance of its target, in the world.
struct LimbSpan {
    upper: JointId,
    base: Vec3,
    shortest: f32,
    longest: f32,
    distance: f32,
}

impl LimbSpan {
    /// The span of a limb with its lengths in the FK pose, whose base is at `base`.
    fn new(fk: &Skeleton, limb: Limb, base: Vec3, target: Vec3) -> Self {
        let elbow = fk.base(limb.lower);
        let lengths = [fk.base(limb.upper).distance(elbow), elbow.distance(fk.tip(limb.lower))];
        Self {
            upper: limb.upper,
            base,
            shortest: (lengths[0] - lengths[1]).abs(),
            longest: lengths[0] + lengths[1],
            distance: base.distance(target),
        }
    }

    fn cause(&self, boundary: Boundary) -> Cause {
        let Self { upper, distance, shortest, longest, .. } = *self;
        Cause::OutOfReach { base: upper, distance, shortest, longest, boundary }
    }
}

impl RigCase<'_> {
    /// The causes for which a limb misses its target, its place or its rotation; none for a
    /// whole-body target.
    pub fn limb(&self, report: &TargetReport) -> Vec<Diagnosis> {
        let (Some(settings), TargetOutcome::Limb(outcome)) = (self.target.limb(), &report.outcome)
        else {
            return Vec::new();
        };
        let fk = self.full.fk_at(self.time);
        let Ok(limb) = Limb::ending_at(&fk, self.target.joint) else { return Vec::new() };
        let turned = self.rotation_limits(limb, report);
        if report.error <= self.tolerance {
            return Vec::from_iter(turned);
        }
        let mut found = self.limb_place(limb, settings, outcome.reach, report.position, &fk);
        found.extend(turned);
        found
    }

    /// The causes for which the tip of a limb is not at its target.
    fn limb_place(
        &self,
        limb: Limb,
        settings: &LimbSettings,
        reach: LimbReach,
        target: Vec3,
        fk: &Skeleton,
    ) -> Vec<Diagnosis> {
        let span = LimbSpan::new(fk, limb, self.solved.base(limb.upper), target);
        let found = self
            .limb_out_of_reach(limb, &span, target)
            .or_else(|| self.soft_limit(limb, &span, settings));
        if let Some(found) = found {
            return vec![found];
        }
        let limits = self.limb_limits(limb, reach);
        let mut found: Vec<_> = limits.into_iter().chain(self.limb_locked(limb)).collect();
        if found.is_empty() {
            found.push(self.diagnosis(Cause::Limits, limb.joints().collect(), Vec::new()));
        }
        found
    }

    fn limb_out_of_reach(&self, limb: Limb, span: &LimbSpan, target: Vec3) -> Option<Diagnosis> {
        // The last part of the way to the boundary, where the elbow races.
        const INSIDE: f32 = 1e-4;
        let &LimbSpan { base, shortest, longest, distance, .. } = span;
        // Both can be NaN, with which `clamp` panics.
        let nearest = distance.max(shortest).min(longest);
        let missing = (distance - nearest).abs();
        if missing.is_nan() || missing <= self.tolerance {
            return None;
        }
        let joint = self.target.joint;
        let inside = nearest + INSIDE * (0.5 * (shortest + longest) - nearest);
        let direction = (target - base).try_normalize().unwrap_or(Vec3::X);
        let stretch = (distance > longest && longest > 0.0).then(|| Remedy::Stretch {
            joint,
            // A little more than needed, for rounding.
            max_stretch: 1.001 * distance / longest,
        });
        let point = base + inside * direction;
        let body = (!self.rig.body_follows && self.full.body_of(limb).next().is_some())
            .then_some(Remedy::FollowBody);
        let remedies = [Some(Remedy::MoveTarget { joint, point }), body, stretch];
        let tried = remedies.into_iter().flatten().filter_map(|remedy| self.try_remedy(remedy));
        let tried = tried.collect();
        Some(self.diagnosis(span.cause(Boundary::Bones), limb.joints().collect(), tried))
    }

    /// Softness or a smallest elbow angle that keeps a tip from a target that the bones reach.
    fn soft_limit(
        &self,
        limb: Limb,
        span: &LimbSpan,
        settings: &LimbSettings,
    ) -> Option<Diagnosis> {
        let remedy = Remedy::HardLimits(self.target.joint);
        if settings.soft_reach.is_hard() || !self.reaches(&remedy) {
            return None;
        }
        let boundary = if settings.soft_reach.softness() > 0.0 {
            Boundary::SoftLimit
        } else {
            Boundary::ElbowAngle
        };
        let tried = Vec::from_iter(self.try_remedy(remedy));
        Some(self.diagnosis(span.cause(boundary), limb.joints().collect(), tried))
    }

    /// Tries to reach the target without the limits of the joint that the solver names, then of
    /// both.
    fn limb_limits(&self, limb: Limb, reach: LimbReach) -> Option<Diagnosis> {
        let skeleton = &self.full.skeleton;
        let of = |joints: &[JointId]| limited_angles(skeleton, joints.iter().copied());
        let named = match reach {
            LimbReach::Limited(joint) => joint,
            _ => limb.lower,
        };
        let hinge: Vec<Angle> =
            of(&[named]).into_iter().filter(|it| !is_fixed(skeleton, *it)).collect();
        let sets = [hinge, of(&[named]), of(&[limb.upper, limb.lower])];
        let tried = sets.iter().filter(|angles| !angles.is_empty());
        let tried: TriedRemedy =
            tried.filter_map(|angles| self.widen(angles)).reduce(|one, other| {
                if other.residual < 0.5 * one.residual { other } else { one }
            })?;
        let Remedy::WidenLimits(widened) = &tried.remedy else { return None };
        let mut joints: Vec<JointId> = widened.iter().map(|it| it.joint).collect();
        joints.dedup();
        Some(self.diagnosis(Cause::Limits, joints, vec![tried]))
    }

    /// The limits that keep the hand from the rotation that its target asks for.
    fn rotation_limits(&self, limb: Limb, report: &TargetReport) -> Option<Diagnosis> {
        let missing = report.rotation_error.filter(|_| report.misses_rotation())?;
        let hand = limb.hand?;
        let angles = limited_angles(&self.full.skeleton, [hand].into_iter());
        let remedy = self.widened(&angles)?;
        let Remedy::WidenLimits(widened) = &remedy else { return None };
        let mut axes = [false; 3];
        for it in widened {
            match it.to {
                WiderLimit::Range { axis, .. } => axes[axis.index()] = true,
                WiderLimit::Cone(_) => axes = [true; 3],
            }
        }
        let tried = Vec::from_iter(self.try_rotation_remedy(remedy));
        Some(self.diagnosis(Cause::RotationLimits { missing, axes }, vec![hand], tried))
    }

    fn widen(&self, angles: &[(JointId, RotationAxis)]) -> Option<TriedRemedy> {
        self.try_remedy(self.widened(angles)?)
    }

    fn limb_locked(&self, limb: Limb) -> Option<Diagnosis> {
        let skeleton = &self.full.skeleton;
        let path = skeleton.ancestors(limb.lower).take_while(|joint| *joint != limb.upper);
        let locked: Vec<JointId> = path.filter(|joint| skeleton[*joint].locked).collect();
        if locked.is_empty() {
            return None;
        }
        let tried = self.try_remedy(Remedy::Unlock(locked.clone()))?;
        Some(self.diagnosis(Cause::Locked, locked, vec![tried]))
    }
}
