use super::edit_action::EditAction;
use super::pops::Spike;
use crate::document::{Arm, TwistReferenceKind};
use crate::kinematics::pop::Pop;
use crate::kinematics::soft_reach::SoftReach;

/// What can be done against a pop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PopFix {
    /// Another reference for the elbow's spin.
    ChangeReference(TwistReferenceKind),
    /// A softer way into the limits.
    Soften(SoftReach),
    /// A smallest elbow angle, with which the arm does not fold up.
    KeepOpen(SoftReach),
}

impl PopFix {
    /// Nothing where nothing helps: at the shoulder, with what is the remedy already, or where
    /// something has been done.
    pub fn new(spike: &Spike, arm: &Arm) -> Option<Self> {
        if !spike.persists(arm) {
            return None;
        }
        match spike.pop {
            Pop::Singular { .. } => match arm.twist_reference {
                TwistReferenceKind::Limb | TwistReferenceKind::Pole => {
                    Some(Self::ChangeReference(TwistReferenceKind::Stereographic))
                }
                TwistReferenceKind::Stereographic => {
                    Some(Self::ChangeReference(TwistReferenceKind::Transport))
                }
                TwistReferenceKind::Transport => None,
            },
            Pop::Straight => softer(arm.soft_reach).map(Self::Soften),
            Pop::Folded if arm.soft_reach.softness() == 0.0 => {
                softer(arm.soft_reach).map(Self::Soften)
            }
            Pop::Folded => opener(arm.soft_reach).map(Self::KeepOpen),
            Pop::Shoulder => None,
        }
    }

    pub fn action(self) -> EditAction {
        match self {
            Self::ChangeReference(twist_reference) => {
                EditAction::SetTwistReference(twist_reference)
            }
            Self::Soften(soft_reach) | Self::KeepOpen(soft_reach) => {
                EditAction::SetSoftReach(soft_reach)
            }
        }
    }
}

/// A quarter is enough for arms of all proportions to be calm at both limits; twice as much as there
/// is, up to a half, for who wants it calmer.
fn softer(soft_reach: SoftReach) -> Option<SoftReach> {
    const ENOUGH: f32 = 0.25;
    const MOST: f32 = 0.5;
    let softness = (2.0 * soft_reach.softness()).clamp(ENOUGH, MOST);
    let softer =
        SoftReach::new(softness, soft_reach.max_stretch(), soft_reach.min_elbow_angle()).ok()?;
    (softness > soft_reach.softness()).then_some(softer)
}

/// With an elbow that stays open by 30 degrees, or 30 more.
fn opener(soft_reach: SoftReach) -> Option<SoftReach> {
    const OPEN: f32 = core::f32::consts::FRAC_PI_6;
    const MOST: f32 = core::f32::consts::FRAC_PI_2;
    let angle = soft_reach.min_elbow_angle() + OPEN;
    let open = SoftReach::new(soft_reach.softness(), soft_reach.max_stretch(), angle).ok()?;
    (angle <= MOST).then_some(open)
}
