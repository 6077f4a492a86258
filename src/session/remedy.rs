use super::{Action, Spike};
use crate::document::{Arm, Swivel};
use crate::kinematics::pop::Pop;
use crate::kinematics::reach::Softening;

/// What can be done against a pop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Remedy {
    /// Another reference for the elbow's spin.
    Measure(Swivel),
    /// A softer way into the limits.
    Soften(Softening),
    /// A smallest elbow angle, with which the arm does not fold up.
    KeepOpen(Softening),
}

impl Remedy {
    /// Nothing where nothing helps: at the shoulder, with what is the remedy already, or where
    /// something has been done.
    pub fn new(spike: &Spike, arm: &Arm) -> Option<Self> {
        if !spike.stands(arm) {
            return None;
        }
        match spike.pop {
            Pop::Singular { .. } => match arm.swivel {
                Swivel::Limb | Swivel::Pole => Some(Self::Measure(Swivel::Stereographic)),
                Swivel::Stereographic => Some(Self::Measure(Swivel::Transport)),
                Swivel::Transport => None,
            },
            Pop::Straight => softer(arm.softening).map(Self::Soften),
            Pop::Folded if arm.softening.softness() == 0.0 => {
                softer(arm.softening).map(Self::Soften)
            }
            Pop::Folded => opener(arm.softening).map(Self::KeepOpen),
            Pop::Shoulder => None,
        }
    }

    pub fn action(self) -> Action {
        match self {
            Self::Measure(swivel) => Action::SetSwivel(swivel),
            Self::Soften(softening) | Self::KeepOpen(softening) => Action::SetSoftening(softening),
        }
    }
}

/// A quarter is enough for arms of all proportions to be calm at both limits; twice as much as there
/// is, up to a half, for who wants it calmer.
fn softer(softening: Softening) -> Option<Softening> {
    const ENOUGH: f32 = 0.25;
    const MOST: f32 = 0.5;
    let softness = (2.0 * softening.softness()).clamp(ENOUGH, MOST);
    let softer =
        Softening::new(softness, softening.max_stretch(), softening.min_elbow_angle()).ok()?;
    (softness > softening.softness()).then_some(softer)
}

/// With an elbow that stays open by 30 degrees, or 30 more.
fn opener(softening: Softening) -> Option<Softening> {
    const OPEN: f32 = core::f32::consts::FRAC_PI_6;
    const MOST: f32 = core::f32::consts::FRAC_PI_2;
    let angle = softening.min_elbow_angle() + OPEN;
    let open = Softening::new(softening.softness(), softening.max_stretch(), angle).ok()?;
    (angle <= MOST).then_some(open)
}
