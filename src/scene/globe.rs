use glam::Vec3;

use crate::kinematics::twist::TwistReference;

/// Sphere of all directions of the Pointer, coloured by the [gain](TwistReference::gain) of the
/// twist reference in each direction: radians that the elbow swings per radian that the Pointer
/// turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Globe {
    /// Position of the shoulder in the world.
    pub centre: Vec3,
    /// Radius in world units.
    pub radius: f32,
    /// Twist reference, whose gains colour the globe. Its directions are in Root space, which has
    /// the world's axes.
    pub reference: TwistReference,
}

impl Globe {
    /// Unit vectors of the directions in which the reference is singular: none, one, or two
    /// opposite ones.
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
        directions.into_iter().flatten()
    }

    /// True if the globe can be drawn: its centre and radius are finite, and the radius is above 0.
    pub fn has_size(&self) -> bool {
        self.centre.is_finite() && self.radius.is_finite() && self.radius > 0.0
    }
}
