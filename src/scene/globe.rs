use glam::Vec3;

use super::{Ball, Label, Palette, Scene, Side, Words};
use crate::kinematics::twist::TwistReference;

/// The mark of a singular direction, as a part of the globe's radius.
const MARK: f32 = 0.026;

/// Every way that the Pointer can point, as a sphere that one can see through, coloured by the
/// [gain](TwistReference::gain) of the reference there: how far the elbow swings for every radian that
/// the Pointer turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Globe {
    /// The shoulder, in the world.
    pub centre: Vec3,
    pub radius: f32,
    /// Its directions are Root's, which are the world's.
    pub reference: TwistReference,
}

impl Globe {
    /// The unit vectors in which the reference is singular: none, one, or two opposite each other.
    ///
    /// A pole at the shoulder gives the elbow no direction anywhere, so that it is carried along, as
    /// with [`TwistReference::Transport`]: none either.
    pub fn singular(&self) -> impl Iterator<Item = Vec3> + Clone {
        let both = |axis: Vec3| [Some(axis), Some(-axis)];
        let directions = match self.reference {
            TwistReference::Limb => both(Vec3::Y),
            TwistReference::Pole(pole) => {
                let axis = pole.as_dvec3().try_normalize();
                axis.map_or([None; 2], |axis| both(axis.as_vec3()))
            }
            TwistReference::Stereographic(map) => [Some(map.singular()), None],
            TwistReference::Transport => [None; 2],
        };
        directions.into_iter().flatten()
    }

    /// Whether there is something to see: a finite place and a finite radius above 0.
    pub fn has_size(&self) -> bool {
        self.centre.is_finite() && self.radius.is_finite() && self.radius > 0.0
    }
}

/// Shows the globe, and marks each singular direction on it.
pub(super) fn add(scene: &mut Scene, globe: Globe) {
    if !globe.has_size() {
        return;
    }
    scene.globe = Some(globe);
    let (ball, text) = (scene.palette.gain(Palette::HOT).with_opacity(1.0), scene.palette.text);
    for direction in globe.singular() {
        let (centre, radius) = (globe.centre + direction * globe.radius, MARK * globe.radius);
        scene.balls.push(Ball { centre, radius, colour: ball });
        let (clearance, side, words) = (radius, Side::Above, Words::default());
        let label = Label { at: centre, clearance, side, words, colour: text };
        scene.add_label(label, format_args!("singular"));
    }
}
