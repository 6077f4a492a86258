//! Many arms at once, in plain code over slices that the compiler turns into instructions on
//! vectors: for the widest that are common, and at run time the widest that the machine has.
//!
//! Nothing here may depend on how wide they are: no fused multiply-add, no sum in another order, no
//! approximate reciprocal. So every machine and every chunk of a batch gives the same bits.

use glam::{Mat3, Vec3};
use multiversion::multiversion;

use crate::kinematics::two_bone::{ClosedForm, Pointer, ScaledBones, TwoBone};

/// How many arms are placed before they are handed over.
///
/// They are first put where they stay in the cache, and then copied: a copy of whole pages does not
/// read what it overwrites, which stores from the middle of a computation do.
pub(super) const BLOCK: usize = 2048;

/// One number of each arm in a block, on a boundary of the widest vectors.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Lane(pub [f32; BLOCK]);

impl Lane {
    pub const ZERO: Self = Self([0.0; BLOCK]);
}

/// Up to so many times as long as the other, a bone leaves it long enough beside rounding that their
/// directions are of unit length to 1e-6 as they are.
const ALIKE: f32 = 8.0;

/// What is kept of arms that were placed.
pub(super) trait Block {
    /// Says whether the arm was plain enough for what is kept of it, or `ANY` has seen to it.
    fn keep<const ANY: bool>(&mut self, arm: usize, placed: &ClosedForm, hand: Vec3) -> bool;
}

/// Elbows and hands of a block: x, y, z each.
pub(super) struct Places {
    pub elbow: [Lane; 3],
    pub hand: [Lane; 3],
}

/// Those, and the rotations of the upper and lower limbs: x, y, z, w each.
pub(super) struct PlacesAndRotations {
    pub places: Places,
    pub upper: [Lane; 4],
    pub lower: [Lane; 4],
}

/// Places arms: with `ANY` of any finite numbers, without of plain ones. Says whether all were plain;
/// if not, and they had to be, what it keeps is not right.
///
/// With `SAME` all arms have the first bones. All slices are as long as the cursors' x, at most a
/// block.
#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512dq+avx512bw",
    "x86_64+avx2",
    "aarch64+neon",
))]
pub(super) fn place<const ANY: bool, const SAME: bool, B: Block>(
    bones: [&[f32]; 2],
    cursor: [&[f32]; 3],
    spin: [&[f32]; 2],
    block: &mut B,
) -> bool {
    let arms = cursor[0].len().min(BLOCK);
    let [upper, lower] = bones.map(|of| &of[..if SAME { 1 } else { arms }]);
    let [x, y, z] = cursor.map(|of| &of[..arms]);
    let [cos, sin] = spin.map(|of| &of[..arms]);
    let mut are_normal = true;
    for arm in 0..arms {
        let of = if SAME { 0 } else { arm };
        let bones = TwoBone { upper: upper[of], lower: lower[of] };
        let cursor = Vec3::new(x[arm], y[arm], z[arm]);
        let placed = ClosedForm::new::<ANY>(bones, cursor, cos[arm], sin[arm], Pointer::default());
        are_normal &= placed.is_normal & block.keep::<ANY>(arm, &placed, placed.hand_or(cursor));
    }
    are_normal
}

impl Places {
    pub const ZERO: Self = Self { elbow: [Lane::ZERO; 3], hand: [Lane::ZERO; 3] };
}

impl PlacesAndRotations {
    pub const ZERO: Self =
        Self { places: Places::ZERO, upper: [Lane::ZERO; 4], lower: [Lane::ZERO; 4] };
}

impl Block for Places {
    #[inline(always)]
    fn keep<const ANY: bool>(&mut self, arm: usize, placed: &ClosedForm, hand: Vec3) -> bool {
        put(&mut self.elbow, arm, placed.elbow.to_array());
        put(&mut self.hand, arm, hand.to_array());
        true
    }
}

impl Block for PlacesAndRotations {
    #[inline(always)]
    fn keep<const ANY: bool>(&mut self, arm: usize, placed: &ClosedForm, hand: Vec3) -> bool {
        self.places.keep::<ANY>(arm, placed, hand);
        let ScaledBones { upper, lower, .. } = placed.scaled;
        let are_alike = (upper <= ALIKE * lower) & (lower <= ALIKE * upper);
        let [of_upper, of_lower] = rotations(placed, ANY && !are_alike);
        put(&mut self.upper, arm, of_upper);
        put(&mut self.lower, arm, of_lower);
        are_alike
    }
}

#[inline(always)]
fn put<const N: usize>(lanes: &mut [Lane; N], arm: usize, values: [f32; N]) {
    for i in 0..N {
        lanes[i].0[arm] = values[i];
    }
}

/// The rotations of the upper and the lower limb, as quaternions: +x along the limb, +z the hinge.
#[inline(always)]
fn rotations(placed: &ClosedForm, is_uneven: bool) -> [[f32; 4]; 2] {
    let ClosedForm { pointer, outward, distance, along, out, scaled, .. } = *placed;
    let hinge = pointer.direction.cross(outward);
    let limb = |ahead: f32, aside: f32| {
        let (cos, sin) = if is_uneven { turn(ahead, aside) } else { (ahead, aside) };
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

/// Cosine and sine of an angle from what they should be: of a limb that is a millionth of the other
/// little is left of them. One that is nothing beside the other goes along the Pointer.
#[inline(always)]
fn turn(cos: f32, sin: f32) -> (f32, f32) {
    let square = cos * cos + sin * sin;
    let per_length = 1.0 / square.sqrt();
    if (square > 0.0) & (square < f32::INFINITY) {
        (cos * per_length, sin * per_length)
    } else {
        (1.0, 0.0)
    }
}

/// (x, y, z, w) of a rotation, w ≥ 0.
///
/// From its largest part, whose square is at least ¼, so that nothing cancels (S. W. Shepperd,
/// *Quaternion from Rotation Matrix*, 1978).
#[inline(always)]
fn quaternion(m: Mat3) -> [f32; 4] {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    // Four times the products of two parts each.
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
