//! The closed form for many arms: plain code over slices that the compiler vectorises for common
//! instruction sets. The widest set that the machine has is chosen at run time.
//!
//! No result depends on the vector width: there is no fused multiply-add, no reordered sum and no
//! approximate reciprocal. So every machine and every division of a batch gives the same bits.

use glam::{Mat3, Vec3};
use multiversion::multiversion;

use crate::two_bone::{ClosedForm, Pointer, ScaledBones, TwoBone};

/// Number of arms that are solved before their results are copied to the outputs.
///
/// A block stays in the cache. Copying whole pages does not read the memory that it overwrites;
/// storing single results during the computation does.
pub(super) const BLOCK: usize = 2048;

/// An array with one number for each arm of a block, aligned to the widest vectors.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct BlockArray(pub [f32; BLOCK]);

impl BlockArray {
    pub const ZERO: Self = Self([0.0; BLOCK]);
}

/// Largest ratio of bone lengths at which the bones' directions have unit length to 1e-6 without
/// normalization.
const MAX_RATIO: f32 = 8.0;

/// Results of a block of arms.
pub(super) trait Block {
    /// Stores an arm's results, and returns whether they are correct even without `ANY`.
    fn keep<const ANY: bool>(&mut self, arm: usize, solved: &ClosedForm, hand: Vec3) -> bool;
}

/// Elbows and hands of a block: x, y and z of each.
pub(super) struct PositionBlock {
    pub elbow: [BlockArray; 3],
    pub hand: [BlockArray; 3],
}

/// Positions and limb rotations of a block: x, y, z and w of each rotation.
pub(super) struct PoseBlock {
    pub positions: PositionBlock,
    pub upper: [BlockArray; 4],
    pub lower: [BlockArray; 4],
}

/// Solves the arms of a block. With `ANY`, the results are correct for all finite numbers; without
/// `ANY`, only if the function returns `true`: all numbers are normal, and every [`Block::keep`]
/// returned `true`.
///
/// With `SAME`, all arms have the bones that are first in `bones`. All other slices are as long as
/// the cursors' x, at most a block.
#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512dq+avx512bw",
    "x86_64+avx2",
    "aarch64+neon",
))]
pub(super) fn solve<const ANY: bool, const SAME: bool, B: Block>(
    bones: [&[f32]; 2],
    cursor: [&[f32]; 3],
    twist: [&[f32]; 2],
    block: &mut B,
) -> bool {
    let arms = cursor[0].len().min(BLOCK);
    let [upper, lower] = bones.map(|of| &of[..if SAME { 1 } else { arms }]);
    let [x, y, z] = cursor.map(|of| &of[..arms]);
    let [cos, sin] = twist.map(|of| &of[..arms]);
    let mut are_normal = true;
    for arm in 0..arms {
        let of = if SAME { 0 } else { arm };
        let bones = TwoBone { upper: upper[of], lower: lower[of] };
        let cursor = Vec3::new(x[arm], y[arm], z[arm]);
        let solved = ClosedForm::new::<ANY>(bones, cursor, cos[arm], sin[arm], Pointer::default());
        are_normal &= solved.is_normal & block.keep::<ANY>(arm, &solved, solved.hand_or(cursor));
    }
    are_normal
}

impl PositionBlock {
    pub const ZERO: Self = Self { elbow: [BlockArray::ZERO; 3], hand: [BlockArray::ZERO; 3] };
}

impl PoseBlock {
    pub const ZERO: Self = Self {
        positions: PositionBlock::ZERO,
        upper: [BlockArray::ZERO; 4],
        lower: [BlockArray::ZERO; 4],
    };
}

impl Block for PositionBlock {
    #[inline(always)]
    fn keep<const ANY: bool>(&mut self, arm: usize, solved: &ClosedForm, hand: Vec3) -> bool {
        put(&mut self.elbow, arm, solved.elbow.to_array());
        put(&mut self.hand, arm, hand.to_array());
        true
    }
}

impl Block for PoseBlock {
    #[inline(always)]
    fn keep<const ANY: bool>(&mut self, arm: usize, solved: &ClosedForm, hand: Vec3) -> bool {
        self.positions.keep::<ANY>(arm, solved, hand);
        let ScaledBones { upper, lower, .. } = solved.scaled;
        let are_similar = (upper <= MAX_RATIO * lower) & (lower <= MAX_RATIO * upper);
        let [of_upper, of_lower] = rotations(solved, ANY && !are_similar);
        put(&mut self.upper, arm, of_upper);
        put(&mut self.lower, arm, of_lower);
        are_similar
    }
}

#[inline(always)]
fn put<const N: usize>(arrays: &mut [BlockArray; N], arm: usize, values: [f32; N]) {
    for i in 0..N {
        arrays[i].0[arm] = values[i];
    }
}

/// Quaternions (x, y, z, w) of the upper and the lower limb's rotation: +x is along the limb, +z
/// along the hinge axis. If `is_uneven`, directions of the limbs are normalized.
#[inline(always)]
fn rotations(solved: &ClosedForm, is_uneven: bool) -> [[f32; 4]; 2] {
    let ClosedForm { pointer, outward, distance, along, out, scaled, .. } = *solved;
    let hinge = pointer.direction.cross(outward);
    let limb = |ahead: f32, aside: f32| {
        let (cos, sin) = if is_uneven { unit_angle(ahead, aside) } else { (ahead, aside) };
        quaternion(Mat3::from_cols(
            pointer.direction * cos + outward * sin,
            outward * cos - pointer.direction * sin,
            hinge,
        ))
    };
    let (per_upper, per_lower) = (1.0 / scaled.upper, 1.0 / scaled.lower);
    [
        limb(along * per_upper, out * per_upper),
        limb((distance - along) * per_lower, -out * per_lower),
    ]
}

/// Normalizes a cosine and a sine, which lose digits for a limb that is much shorter than the other
/// limb. A limb whose direction is lost points along the Pointer.
#[inline(always)]
fn unit_angle(cos: f32, sin: f32) -> (f32, f32) {
    let square = cos * cos + sin * sin;
    let per_length = 1.0 / square.sqrt();
    if (square > 0.0) & (square < f32::INFINITY) {
        (cos * per_length, sin * per_length)
    } else {
        (1.0, 0.0)
    }
}

/// Unit quaternion (x, y, z, w) of a rotation matrix, with w ≥ 0.
///
/// Computed from its largest component, whose square is at least ¼, so that nothing cancels (S. W.
/// Shepperd, *Quaternion from Rotation Matrix*, 1978).
#[inline(always)]
fn quaternion(m: Mat3) -> [f32; 4] {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    // Four times the product of two components each.
    let [xw, yw, zw] = [y.z - z.y, z.x - x.z, x.y - y.x];
    let [xy, xz, yz] = [x.y + y.x, z.x + x.z, y.z + z.y];
    let xx = 1.0 + x.x - y.y - z.z;
    let yy = 1.0 - x.x + y.y - z.z;
    let zz = 1.0 - x.x - y.y + z.z;
    let ww = 1.0 + x.x + y.y + z.z;

    let mut square = ww;
    let mut row = [xw, yw, zw, ww];
    if xx > square {
        (square, row) = (xx, [xx, xy, xz, xw]);
    }
    if yy > square {
        (square, row) = (yy, [xy, yy, yz, yw]);
    }
    if zz > square {
        (square, row) = (zz, [xz, yz, zz, zw]);
    }
    let part = 0.5 / square.sqrt();
    let part = if row[3] < 0.0 { -part } else { part };
    row.map(|product| product * part)
}
