use crate::document::{Theme, TwistReferenceKind};
use crate::kinematics::chain_ik::Method;

/// A colour as a screen has it: sRGB, with opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub [u8; 4]);

impl Colour {
    const fn rgb(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self([r, g, b, 255])
    }

    /// As seen through: 0 is nothing, 1 the colour itself.
    #[must_use]
    pub fn with_opacity(self, opacity: f32) -> Self {
        let [r, g, b, _] = self.0;
        Self([r, g, b, (opacity * 255.0).round() as u8])
    }

    /// Part of the way to another colour, as a screen mixes them.
    #[must_use]
    pub fn mixed(self, other: Self, part: f32) -> Self {
        let mix =
            |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * part).round() as u8;
        Self(std::array::from_fn(|channel| mix(self.0[channel], other.0[channel])))
    }

    /// Red, green, blue and opacity from 0 to 1, still sRGB.
    pub fn channels(self) -> [f32; 4] {
        self.0.map(|channel| f32::from(channel) / 255.0)
    }
}

/// The colours of a theme. The two limbs' and the accent's are the panels' too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    pub theme: Theme,
    /// Upper limb, d₁.
    pub upper: Colour,
    /// Lower limb, d₂.
    pub lower: Colour,
    pub joint: Colour,
    /// Cursor, Pointer and limits.
    pub guide: Colour,
    pub accent: Colour,
    /// x, y, z.
    pub axes: [Colour; 3],
    pub sky_top: Colour,
    pub sky_bottom: Colour,
    pub ground: Colour,
    pub grid: Colour,
    pub text: Colour,
    /// The ramp of [`Palette::gain`]: further and further from the background in lightness, and ever
    /// less seen through, so that it reads without its hues. Steps are alike in Oklab.
    pub gains: [Colour; Palette::GAINS],
    /// How dark the darkest shadow is.
    pub shadow: f32,
}

impl Palette {
    /// How many colours the ramp of gains is given by.
    pub const GAINS: usize = 5;
    /// The gain at which the ramp ends: what is beyond has its last colour.
    pub const HOT: f32 = 8.0;

    pub fn new(theme: Theme) -> Self {
        match theme {
            Theme::Dark => Self {
                theme,
                upper: Colour::rgb(0xd8744b),
                lower: Colour::rgb(0x6492c6),
                joint: Colour::rgb(0xc4c8ce),
                guide: Colour::rgb(0xeef0f4),
                accent: Colour::rgb(0xb397f5),
                axes: [0xe04b4b, 0x6fb33c, 0x4a86f0].map(Colour::rgb),
                sky_top: Colour::rgb(0x2c313a),
                sky_bottom: Colour::rgb(0x171a1f),
                ground: Colour::rgb(0x3a404a),
                grid: Colour::rgb(0x9aa4b4),
                text: Colour::rgb(0xeef0f4),
                gains: ramp([0x4d667f, 0x954f9d, 0xd63f71, 0xf76c43, 0xffa83f]),
                shadow: 0.62,
            },
            Theme::Light => Self {
                theme,
                upper: Colour::rgb(0xb4502c),
                lower: Colour::rgb(0x4771a3),
                joint: Colour::rgb(0xbcc1c8),
                guide: Colour::rgb(0x1c1f24),
                accent: Colour::rgb(0x6a42c4),
                axes: [0xd03232, 0x458f20, 0x2864d8].map(Colour::rgb),
                sky_top: Colour::rgb(0xf6f8fa),
                sky_bottom: Colour::rgb(0xd9dfe6),
                ground: Colour::rgb(0xffffff),
                grid: Colour::rgb(0x5a6678),
                text: Colour::rgb(0x1c1f24),
                gains: ramp([0x7cabcc, 0xa17cd4, 0xc4499a, 0xbb1a40, 0x850609]),
                shadow: 0.42,
            },
        }
    }

    /// The colour that a swivel reference has wherever they are beside each other.
    pub fn twist_reference(&self, twist_reference: TwistReferenceKind) -> Colour {
        let [dark, light] = match twist_reference {
            TwistReferenceKind::Limb => [0xf2d06b, 0x866400],
            TwistReferenceKind::Pole => [0x8fd460, 0x3f7a15],
            TwistReferenceKind::Stereographic => [0x3fb8a5, 0x0b7466],
            TwistReferenceKind::Transport => [0xf08fb4, 0xb02a63],
        };
        Colour::rgb(if self.theme == Theme::Dark { dark } else { light })
    }

    /// The colour that a solver has wherever solvers are beside each other.
    pub fn method(&self, method: Method) -> Colour {
        let [dark, light] = match method {
            Method::TransposeFixed => [0xc9a227, 0x7d6300],
            Method::Transpose => [0xf2d06b, 0x9a7b1c],
            Method::DampedLeastSquares => [0x3fb8a5, 0x0b7466],
            Method::Ccd => [0x8fd460, 0x3f7a15],
            Method::Fabrik => [0xb397f5, 0x6a42c4],
            Method::TwoBone => [0xf08fb4, 0xb02a63],
        };
        Colour::rgb(if self.theme == Theme::Dark { dark } else { light })
    }

    /// The colour of a [gain](crate::kinematics::twist::TwistReference::gain), as seen through as it is on
    /// the globe: calm at 0, hot at [`Palette::HOT`] and beyond, evenly in the logarithm of 1 + gain
    /// between.
    pub fn gain(&self, gain: f32) -> Colour {
        let last = Self::GAINS - 1;
        let along = gain.max(0.0).ln_1p() / Self::HOT.ln_1p() * last as f32;
        let step = (along as usize).min(last - 1);
        self.gains[step].mixed(self.gains[step + 1], (along - step as f32).min(1.0))
    }
}

fn ramp(hex: [u32; Palette::GAINS]) -> [Colour; Palette::GAINS] {
    const OPACITY: [f32; Palette::GAINS] = [0.05, 0.11, 0.21, 0.36, 0.54];
    std::array::from_fn(|step| Colour::rgb(hex[step]).with_opacity(OPACITY[step]))
}
