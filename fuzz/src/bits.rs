use glam::{Affine3A, Quat, Vec3};

/// Bytes as numbers, from the first to the last; zeros after the end.
pub struct Bits<'a>(&'a [u8]);

impl<'a> Bits<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    pub fn byte(&mut self) -> u8 {
        let [byte] = self.bytes();
        byte
    }

    pub fn coin(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    pub fn below(&mut self, end: usize) -> usize {
        usize::from(self.byte()) % end
    }

    /// Any bits as a number: huge, tiny, infinite, not a number; often one that one might write.
    pub fn number(&mut self) -> f32 {
        use core::f32::consts::{FRAC_PI_2, PI};
        const SPECIAL: [f32; 16] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f32::MIN_POSITIVE,
            f32::from_bits(1),
            f32::EPSILON,
            f32::MAX,
            f32::MIN,
            f32::INFINITY,
            f32::NAN,
            PI,
            FRAC_PI_2,
            -FRAC_PI_2,
            1e-3,
            1e3,
        ];
        const STEP: f32 = 1.0 / 4096.0;
        match self.byte() {
            0..64 => f32::from_bits(u32::from_le_bytes(self.bytes())),
            special @ 64..128 => SPECIAL[usize::from(special) % SPECIAL.len()],
            128.. => f32::from(i16::from_le_bytes(self.bytes())) * STEP,
        }
    }

    /// Like [`Bits::number`], but finite.
    pub fn finite(&mut self) -> f32 {
        let number = self.number();
        if number.is_finite() { number } else { 0.0 }
    }

    /// From 0 to less than 1.
    pub fn part(&mut self) -> f32 {
        f32::from(u16::from_le_bytes(self.bytes())) / 65_536.0
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.number()))
    }

    pub fn finite_vector(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.finite()))
    }

    pub fn matrix(&mut self) -> Affine3A {
        let [x, y, z, translation] = [(); 4].map(|()| self.vector().into());
        Affine3A::from_cols(x, y, z, translation)
    }

    /// Of unit length.
    pub fn rotation(&mut self) -> Quat {
        let [x, y, z, w] = [(); 4].map(|()| self.part() - 0.5);
        let quat = Quat::from_xyzw(x, y, z, w);
        if quat.length() > 1e-3 { quat.normalize() } else { Quat::IDENTITY }
    }

    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        let (taken, left) = self.0.split_at(N.min(self.0.len()));
        bytes[..taken.len()].copy_from_slice(taken);
        self.0 = left;
        bytes
    }
}
