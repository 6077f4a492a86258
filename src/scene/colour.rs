/// An sRGB colour with opacity, each channel 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub [u8; 4]);

impl Colour {
    /// Opaque colour from its hexadecimal code 0xRRGGBB.
    pub(super) const fn rgb(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self([r, g, b, 255])
    }

    /// The colour with another opacity, from 0 (invisible) to 1 (opaque).
    #[must_use]
    pub fn with_opacity(self, opacity: f32) -> Self {
        let [r, g, b, _] = self.0;
        Self([r, g, b, (opacity * 255.0).round() as u8])
    }

    /// Linear interpolation to another colour in sRGB: a fraction of 0 is this colour, 1 the other
    /// one.
    #[must_use]
    pub fn mixed(self, other: Self, fraction: f32) -> Self {
        let mix =
            |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * fraction).round() as u8;
        Self(std::array::from_fn(|channel| mix(self.0[channel], other.0[channel])))
    }

    /// Red, green, blue and opacity from 0 to 1, in sRGB.
    pub fn channels(self) -> [f32; 4] {
        self.0.map(|channel| f32::from(channel) / 255.0)
    }
}
