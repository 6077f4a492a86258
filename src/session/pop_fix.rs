use crate::kinematics::pop::{PopCause, PosedLimb};
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::TwistReferenceKind;
use crate::rig::{LimbSettings, SkeletonRig, Target, TargetKind};
use crate::session::action::Edit;
use crate::session::limb::ShownLimb;
use crate::session::pops::Spike;
use crate::session::skeleton::targets::TargetEdit;

/// A change of settings that prevents a pop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PopFix {
    /// Another twist reference.
    ChangeReference(TwistReferenceKind),
    /// More softness near the limits.
    Soften(SoftReach),
    /// A larger minimum elbow angle, which keeps the limb from folding up.
    KeepOpen(SoftReach),
}

impl PopFix {
    /// The fix for a pop. `None` if the pop cannot recur with the settings `now`, if its cause is a
    /// Cursor that passed the base of the limb, or if every fix is in use.
    pub fn new(spike: &Spike, now: &PosedLimb) -> Option<Self> {
        if !spike.persists(now) {
            return None;
        }
        let soft_reach = now.ik.soft_reach;
        match spike.pop {
            PopCause::Singular { .. } => match now.kind {
                TwistReferenceKind::Up | TwistReferenceKind::Pole | TwistReferenceKind::Fk => {
                    Some(Self::ChangeReference(TwistReferenceKind::Stereographic))
                }
                TwistReferenceKind::Stereographic => {
                    Some(Self::ChangeReference(TwistReferenceKind::Transport))
                }
                TwistReferenceKind::Transport => None,
            },
            PopCause::Straight => softer(soft_reach).map(Self::Soften),
            PopCause::Folded if soft_reach.softness() == 0.0 => {
                softer(soft_reach).map(Self::Soften)
            }
            PopCause::Folded => wider(soft_reach).map(Self::KeepOpen),
            PopCause::Shoulder => None,
        }
    }

    /// The edit that applies the fix to a limb; `None` if the limb has no such target any more.
    pub fn edit(self, rig: &SkeletonRig, limb: &ShownLimb) -> Option<Edit> {
        let joint = limb.target;
        let target = rig.targets[rig.target(joint)?];
        let settings = *target.limb()?;
        Some(match self {
            Self::ChangeReference(reference) => {
                TargetEdit::SetReference { joint, reference }.into()
            }
            Self::Soften(soft_reach) | Self::KeepOpen(soft_reach) => {
                let kind = TargetKind::Limb(LimbSettings { soft_reach, ..settings });
                TargetEdit::SetTarget(Target { kind, ..target }).into()
            }
        })
    }
}

/// Soft limits with twice the softness, at least 0.25 and at most 0.5; `None` if the softness is
/// 0.5 or more already. A softness of 0.25 keeps arms of all proportions calm at both limits.
fn softer(soft_reach: SoftReach) -> Option<SoftReach> {
    const ENOUGH: f32 = 0.25;
    const MOST: f32 = 0.5;
    let softness = (2.0 * soft_reach.softness()).clamp(ENOUGH, MOST);
    let softer =
        SoftReach::new(softness, soft_reach.max_stretch(), soft_reach.min_elbow_angle()).ok()?;
    (softness > soft_reach.softness()).then_some(softer)
}

/// Soft limits with a minimum elbow angle that is 30° larger; `None` if that is above 90°.
fn wider(soft_reach: SoftReach) -> Option<SoftReach> {
    const OPEN: f32 = core::f32::consts::FRAC_PI_6;
    const MOST: f32 = core::f32::consts::FRAC_PI_2;
    let angle = soft_reach.min_elbow_angle() + OPEN;
    let open = SoftReach::new(soft_reach.softness(), soft_reach.max_stretch(), angle).ok()?;
    (angle <= MOST).then_some(open)
}
