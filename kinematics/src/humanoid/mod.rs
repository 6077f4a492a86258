//! Recognition of human-like figures: which joints are hips, knees, feet, shoulders, elbows and
//! hands, by their names or, where these do not tell all four limbs, by the shape of the
//! bind pose.
//!
//! Names alone are not believed: the two sides must have the same lengths, and the legs must go
//! down from the trunk, in the bind pose or in the pose that the skeleton has. So horses and birds
//! whose joints are called like a person's are refused.

mod body;
mod names;
mod shape;

pub use body::{BodyPart, Humanoid, HumanoidDirections, HumanoidLimb, NotHumanoid};

use crate::skeleton::Skeleton;

impl Humanoid {
    /// Recognises a human-like figure.
    ///
    /// # Errors
    ///
    /// [`NotHumanoid`] if the figure is not human-like, or the match is ambiguous.
    pub fn of(skeleton: &Skeleton) -> Result<Self, NotHumanoid> {
        let with_head = |humanoid: Self| {
            let (directions, pose) = humanoid.directions(skeleton)?;
            shape::head(skeleton, pose, &humanoid, directions)
        };
        let named = names::humanoid(skeleton)
            .and_then(|humanoid| humanoid.checked(skeleton))
            .map(|it| Self { head: it.head.or_else(|| with_head(it)), ..it });
        match named {
            Err(error @ NotHumanoid::Missing { .. }) => {
                let is_unnamed =
                    matches!(&error, NotHumanoid::Missing { found, .. } if found.is_empty());
                let by_shape = shape::humanoid(skeleton).and_then(|it| it.checked(skeleton));
                by_shape.map_err(|of_shape| if is_unnamed { of_shape } else { error })
            }
            named => named,
        }
    }
}
