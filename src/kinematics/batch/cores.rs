//! A batch shared out among threads.

use super::kernel::BLOCK;
use super::{Arms, Places, PointsMut, QuaternionsMut, Rotations};

/// Many blocks, so that handing them out costs little beside solving them.
const SHARE: usize = 8 * BLOCK;

pub(super) fn share_out(
    arms: Arms<'_>,
    mut places: Places<'_>,
    mut rotations: Option<Rotations<'_>>,
) {
    if arms.len() <= SHARE {
        arms.solve_into(&mut places, rotations.as_mut());
        return;
    }
    let middle = (arms.len() / 2).next_multiple_of(BLOCK);
    let first = arms.part(0..middle);
    let second = arms.part(middle..arms.len());
    let (first_places, second_places) = places.split_at(middle);
    let (first_rotations, second_rotations) = rotations.map(|of| of.split_at(middle)).unzip();
    rayon::join(
        || share_out(first, first_places, first_rotations),
        || share_out(second, second_places, second_rotations),
    );
}

impl Places<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (elbow, second_elbow) = self.elbow.split_at(middle);
        let (hand, second_hand) = self.hand.split_at(middle);
        (Self { elbow, hand }, Self { elbow: second_elbow, hand: second_hand })
    }
}

impl Rotations<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (upper, second_upper) = self.upper.split_at(middle);
        let (lower, second_lower) = self.lower.split_at(middle);
        (Self { upper, lower }, Self { upper: second_upper, lower: second_lower })
    }
}

impl PointsMut<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let [(x, x2), (y, y2), (z, z2)] =
            [self.x, self.y, self.z].map(|of| of.split_at_mut(middle));
        (Self { x, y, z }, Self { x: x2, y: y2, z: z2 })
    }
}

impl QuaternionsMut<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let [(x, x2), (y, y2), (z, z2), (w, w2)] =
            [self.x, self.y, self.z, self.w].map(|of| of.split_at_mut(middle));
        (Self { x, y, z, w }, Self { x: x2, y: y2, z: z2, w: w2 })
    }
}
