//! Many two-bone arms at once: see [`two_bone`](super::two_bone) for what one does.
//!
//! Numbers of the same kind lie beside each other (a structure of arrays), so that one instruction
//! does the same for 4, 8 or 16 arms; which instructions the machine has is found out when it runs.
//!
//! ```
//! use ik_arm::kinematics::batch::{Arms, Bones, Places, Points, PointsMut, Spin};
//! use ik_arm::kinematics::two_bone::TwoBone;
//!
//! let (x, y, z) = ([250.0, 400.0], [120.0, 300.0], [60.0, 0.0]);
//! let arms = Arms::new(
//!     Bones::Same(TwoBone::new(200.0, 300.0)?),
//!     Points { x: &x, y: &y, z: &z },
//!     Spin::Angle(&[0.0, 0.5]),
//! )?;
//!
//! let mut elbow = [[0.0; 2]; 3];
//! let mut hand = [[0.0; 2]; 3];
//! arms.solve(Places { elbow: PointsMut::of(&mut elbow), hand: PointsMut::of(&mut hand) }, None)?;
//!
//! assert_eq!(hand[0][0], 250.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What it gives
//!
//! The bits that [`TwoBone::solve`] gives for each arm, whatever else is in the batch, however it is
//! cut up, on however many threads and on whatever machine. (A machine's own cosine may differ from
//! another's: batches that have to agree between machines take cosines and sines instead of angles.)
//! A hand is the cursor where that is reached, bit for bit; else it is on a limit's sphere.
//!
//! Root space, right-handed, radians; lengths of one arm in one unit, whichever.
//!
//! # What breaks
//!
//! What is not a finite number has no meaning: the arm that it belongs to is then anywhere, the
//! others are as they should be. An arm has no last pointer: a cursor at the shoulder faces +x, one
//! straight above or below has no yaw.
//!
//! # How fast
//!
//! `docs/performance.md` has the figures beside those of a copy of the same bytes. Plain numbers,
//! from about 1e-9 to 1e9, go the fast way. A block of 2,048 arms that has others, or a cursor
//! straight above, below or at its shoulder, is solved once more with care: half as fast. So is one with
//! a bone more than eight times as long as the other, if rotations are asked for.

#[cfg(feature = "parallel")]
mod cores;
mod kernel;

use core::ops::Range;

use thiserror::Error;

use super::two_bone::{LengthError, TwoBone};
use kernel::{BLOCK, Block, Lane};

/// What is asked of many arms.
#[derive(Clone, Copy, Debug)]
pub struct Arms<'a> {
    bones: Bones<'a>,
    cursor: [&'a [f32]; 3],
    spin: Spin<'a>,
}

/// How long the bones are.
#[derive(Clone, Copy, Debug)]
pub enum Bones<'a> {
    /// All arms have the same.
    Same(TwoBone),
    /// Each arm has its own, finite and above 0.
    Each { upper: &'a [f32], lower: &'a [f32] },
}

/// How far each elbow is turned about its Pointer from the Limb frame's +y.
#[derive(Clone, Copy, Debug)]
pub enum Spin<'a> {
    /// ψ in radians.
    Angle(&'a [f32]),
    /// cos ψ and sin ψ: several times as fast, and the same everywhere.
    Turn { cos: &'a [f32], sin: &'a [f32] },
}

/// Points, one an arm.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub z: &'a [f32],
}

/// Room for points.
#[derive(Debug)]
pub struct PointsMut<'a> {
    pub x: &'a mut [f32],
    pub y: &'a mut [f32],
    pub z: &'a mut [f32],
}

/// Room for unit quaternions.
#[derive(Debug)]
pub struct QuaternionsMut<'a> {
    pub x: &'a mut [f32],
    pub y: &'a mut [f32],
    pub z: &'a mut [f32],
    pub w: &'a mut [f32],
}

/// Where elbows and hands are put, in Root space.
#[derive(Debug)]
pub struct Places<'a> {
    pub elbow: PointsMut<'a>,
    pub hand: PointsMut<'a>,
}

/// Where the rotations of the limbs in Root space are put: +x is along the limb, +z the hinge; w ≥ 0.
#[derive(Debug)]
pub struct Rotations<'a> {
    pub upper: QuaternionsMut<'a>,
    pub lower: QuaternionsMut<'a>,
}

/// Arrays that are no batch.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BatchError {
    #[error("{array} has {len} numbers; the cursors' x has {arms}, and there must be as many")]
    Len { array: &'static str, len: usize, arms: usize },
    #[error("arm {arm}: {source}")]
    Bone { arm: usize, source: LengthError },
}

impl<'a> Arms<'a> {
    /// # Errors
    ///
    /// If the arrays are not all as long as each other, or a bone's length is not finite or not
    /// above 0.
    pub fn new(bones: Bones<'a>, cursor: Points<'a>, spin: Spin<'a>) -> Result<Self, BatchError> {
        let arms = cursor.x.len();
        check("the cursors' y", cursor.y.len(), arms)?;
        check("the cursors' z", cursor.z.len(), arms)?;
        match spin {
            Spin::Angle(angle) => check("the spins' angle", angle.len(), arms)?,
            Spin::Turn { cos, sin } => {
                check("the spins' cos", cos.len(), arms)?;
                check("the spins' sin", sin.len(), arms)?;
            }
        }
        if let Bones::Each { upper, lower } = bones {
            check("the upper lengths", upper.len(), arms)?;
            check("the lower lengths", lower.len(), arms)?;
            if !(are_lengths(upper) && are_lengths(lower)) {
                for (arm, (upper, lower)) in upper.iter().zip(lower).enumerate() {
                    TwoBone::new(*upper, *lower)
                        .map_err(|source| BatchError::Bone { arm, source })?;
                }
            }
        }
        Ok(Self { bones, cursor: [cursor.x, cursor.y, cursor.z], spin })
    }

    /// How many arms there are.
    pub fn len(&self) -> usize {
        self.cursor[0].len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Solves all, on this thread, and allocates nothing.
    ///
    /// # Errors
    ///
    /// If there is not room for exactly as many arms as there are.
    pub fn solve(
        &self,
        mut places: Places<'_>,
        mut rotations: Option<Rotations<'_>>,
    ) -> Result<(), BatchError> {
        self.check_room(&places, rotations.as_ref())?;
        self.solve_into(&mut places, rotations.as_mut());
        Ok(())
    }

    /// As [`Self::solve`], on as many threads as [`rayon`] has: the same bits.
    ///
    /// # Errors
    ///
    /// As [`Self::solve`].
    #[cfg(feature = "parallel")]
    pub fn solve_on_all_cores(
        &self,
        places: Places<'_>,
        rotations: Option<Rotations<'_>>,
    ) -> Result<(), BatchError> {
        self.check_room(&places, rotations.as_ref())?;
        cores::share_out(*self, places, rotations);
        Ok(())
    }

    fn check_room(
        &self,
        places: &Places<'_>,
        rotations: Option<&Rotations<'_>>,
    ) -> Result<(), BatchError> {
        for (array, points) in [("the elbows", &places.elbow), ("the hands", &places.hand)] {
            for len in [points.x.len(), points.y.len(), points.z.len()] {
                check(array, len, self.len())?;
            }
        }
        let turns = rotations.into_iter().flat_map(|of| {
            [("the upper rotations", &of.upper), ("the lower rotations", &of.lower)]
        });
        for (array, of) in turns {
            for len in [of.x.len(), of.y.len(), of.z.len(), of.w.len()] {
                check(array, len, self.len())?;
            }
        }
        Ok(())
    }

    fn part(&self, arms: Range<usize>) -> Self {
        let of = |array: &'a [f32]| &array[arms.clone()];
        Self {
            bones: match self.bones {
                Bones::Same(bones) => Bones::Same(bones),
                Bones::Each { upper, lower } => Bones::Each { upper: of(upper), lower: of(lower) },
            },
            cursor: self.cursor.map(of),
            spin: match self.spin {
                Spin::Angle(angle) => Spin::Angle(of(angle)),
                Spin::Turn { cos, sin } => Spin::Turn { cos: of(cos), sin: of(sin) },
            },
        }
    }

    fn solve_into(&self, places: &mut Places<'_>, rotations: Option<&mut Rotations<'_>>) {
        match rotations {
            None => self.solve_blocks(kernel::Places::ZERO, |block, arms| places.take(block, arms)),
            Some(rotations) => {
                self.solve_blocks(kernel::PlacesAndRotations::ZERO, |block, arms| {
                    places.take(&block.places, arms.clone());
                    rotations.take(block, arms);
                });
            }
        }
    }

    fn solve_blocks<B: Block>(&self, mut block: B, mut hand_over: impl FnMut(&B, Range<usize>)) {
        for from in (0..self.len()).step_by(BLOCK) {
            let arms = from..self.len().min(from + BLOCK);
            self.part(arms.clone()).solve_block(&mut block);
            hand_over(&block, arms);
        }
    }

    fn solve_block(&self, block: &mut impl Block) {
        match self.spin {
            Spin::Turn { cos, sin } => self.place([cos, sin], block),
            Spin::Angle(angles) => {
                let mut turns = [Lane::ZERO; 2];
                let [Lane(cos), Lane(sin)] = &mut turns;
                for (angle, (cos, sin)) in angles.iter().zip(cos.iter_mut().zip(sin)) {
                    (*sin, *cos) = angle.sin_cos();
                }
                self.place(turns.each_ref().map(|Lane(of)| &of[..angles.len()]), block);
            }
        }
    }

    fn place(&self, spin: [&[f32]; 2], block: &mut impl Block) {
        match self.bones {
            Bones::Same(bones) => {
                self.place_with::<true>([&[bones.upper()], &[bones.lower()]], spin, block);
            }
            Bones::Each { upper, lower } => {
                self.place_with::<false>([upper, lower], spin, block);
            }
        }
    }

    /// The fast way, or if that was not enough with care.
    fn place_with<const SAME: bool>(
        &self,
        bones: [&[f32]; 2],
        spin: [&[f32]; 2],
        block: &mut impl Block,
    ) {
        let is_done = kernel::place::<false, SAME, _>(bones, self.cursor, spin, block);
        if !is_done {
            kernel::place::<true, SAME, _>(bones, self.cursor, spin, block);
        }
    }
}

impl<'a> PointsMut<'a> {
    /// Three arrays, of x, y and z.
    pub fn of([x, y, z]: &'a mut [impl AsMut<[f32]>; 3]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut() }
    }
}

impl<'a> QuaternionsMut<'a> {
    /// Four arrays, of x, y, z and w.
    pub fn of([x, y, z, w]: &'a mut [impl AsMut<[f32]>; 4]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut(), w: w.as_mut() }
    }
}

impl Places<'_> {
    fn take(&mut self, block: &kernel::Places, arms: Range<usize>) {
        let Self { elbow, hand } = self;
        copy(&block.elbow, [&mut *elbow.x, &mut *elbow.y, &mut *elbow.z], arms.clone());
        copy(&block.hand, [&mut *hand.x, &mut *hand.y, &mut *hand.z], arms);
    }
}

impl Rotations<'_> {
    fn take(&mut self, block: &kernel::PlacesAndRotations, arms: Range<usize>) {
        for (lanes, QuaternionsMut { x, y, z, w }) in
            [(&block.upper, &mut self.upper), (&block.lower, &mut self.lower)]
        {
            copy(lanes, [&mut **x, &mut **y, &mut **z, &mut **w], arms.clone());
        }
    }
}

fn copy<const N: usize>(lanes: &[Lane; N], arrays: [&mut [f32]; N], arms: Range<usize>) {
    for (Lane(lane), array) in lanes.iter().zip(arrays) {
        array[arms.clone()].copy_from_slice(&lane[..arms.len()]);
    }
}

/// Looks at all of them, which is faster than to stop at the first.
fn are_lengths(values: &[f32]) -> bool {
    values.iter().fold(true, |are, value| are & (*value > 0.0) & (*value < f32::INFINITY))
}

fn check(array: &'static str, len: usize, arms: usize) -> Result<(), BatchError> {
    if len == arms { Ok(()) } else { Err(BatchError::Len { array, len, arms }) }
}
