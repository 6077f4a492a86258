use crate::document::{Theme, TwistReferenceKind};
use crate::kinematics::chain_ik::Method;
use crate::kinematics::skin::Skinning;
use crate::session::OnionSkin;

/// Colours of the scene in a theme. The panels use the colours of the two limbs and the accent too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// Theme that the colours belong to.
    pub theme: Theme,
    /// Upper limb.
    pub upper: Colour,
    /// Lower limb.
    pub lower: Colour,
    /// Joints and the hand.
    pub joint: Colour,
    /// Cursor, Pointer and limits.
    pub guide: Colour,
    /// Selection, trails, and gaps between a target and what should reach it.
    pub accent: Colour,
    /// Axes x, y and z.
    pub axes: [Colour; 3],
    /// Background at the top of the picture.
    pub sky_top: Colour,
    /// Background at the bottom of the picture.
    pub sky_bottom: Colour,
    /// Floor. Its opacity is that of [`Planes::ground_opacity`](super::Planes::ground_opacity).
    pub ground: Colour,
    /// Lines of the grid in the floor, with opacity.
    pub grid: Colour,
    /// Lines of the grids in the walls, with opacity.
    pub wall: Colour,
    /// Labels.
    pub text: Colour,
    /// Colour ramp of [`Palette::gain`], in steps that are equal in Oklab. Opacity and contrast
    /// with the background increase along the ramp, so that it is readable without hues.
    pub gains: [Colour; Palette::GAINS],
    /// Opacity of the darkest shadow, from 0 to 1.
    pub shadow: f32,
}

impl Palette {
    /// Number of colours in the ramp of gains.
    pub const GAINS: usize = 5;
    /// Gain at the end of the ramp. Higher gains have the ramp's last colour.
    pub const MAX_GAIN: f32 = 8.0;

    /// The palette of a theme.
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
                ground: Colour::rgb(0x3a3f48),
                grid: Colour::rgb(0x9aa4b4).with_opacity(0.75),
                wall: Colour::rgb(0x9aa4b4),
                text: Colour::rgb(0xeef0f4),
                gains: ramp([0x6fb7ff, 0xa98af0, 0xe0609a, 0xf76c43, 0xffa83f]),
                shadow: 0.7,
            },
            Theme::Light => Self {
                theme,
                upper: Colour::rgb(0xb4502c),
                lower: Colour::rgb(0x4771a3),
                joint: Colour::rgb(0xbcc1c8),
                guide: Colour::rgb(0x1c1f24),
                accent: Colour::rgb(0x6a42c4),
                axes: [0xd03232, 0x458f20, 0x2864d8].map(Colour::rgb),
                sky_top: Colour::rgb(0xe9edf1),
                sky_bottom: Colour::rgb(0xd0d7df),
                ground: Colour::rgb(0xedf0f3),
                grid: Colour::rgb(0x5a6678).with_opacity(0.7),
                wall: Colour::rgb(0x5a6678),
                text: Colour::rgb(0x1c1f24),
                gains: ramp([0x7cabcc, 0xa17cd4, 0xc4499a, 0xbb1a40, 0x850609]),
                shadow: 0.5,
            },
        }
    }

    /// A colour under the mouse.
    pub fn lit(&self, colour: Colour) -> Colour {
        colour.mixed(self.guide, 0.3)
    }

    /// Colour of a twist reference in the comparison of all references.
    pub fn twist_reference(&self, twist_reference: TwistReferenceKind) -> Colour {
        let [dark, light] = match twist_reference {
            TwistReferenceKind::Up => [0xf2d06b, 0x866400],
            TwistReferenceKind::Pole => [0x8fd460, 0x3f7a15],
            TwistReferenceKind::Stereographic => [0x3fb8a5, 0x0b7466],
            TwistReferenceKind::Transport => [0xf08fb4, 0xb02a63],
            TwistReferenceKind::Fk => [0xb7a3f5, 0x5b3fc4],
        };
        Colour::rgb(if self.theme == Theme::Dark { dark } else { light })
    }

    /// See-through colour of an onion skin: the fainter, the farther it is from the playhead.
    pub(super) fn onion_skin(&self, skin: &OnionSkin) -> Colour {
        const OPACITY: f32 = 0.34;
        // Parts of the sky in the grey of the past, and of the joints' grey in the accent of the future,
        // which would draw more attention than the figure.
        let plain = match skin.past {
            true => self.guide.mixed(self.sky_bottom, 0.1),
            false => self.accent.mixed(self.joint, 0.45),
        };
        plain.with_opacity(OPACITY * skin.opacity)
    }

    /// Opaque colour of the bones of an onion skin.
    pub(super) fn onion_skin_bones(&self, skin: &OnionSkin) -> Colour {
        // Contrast of an opaque onion skin with the background, from 0 to 1.
        const CONTRAST: f32 = 0.7;
        let plain = if skin.past { self.joint } else { self.accent };
        self.sky_top.mixed(plain, CONTRAST * skin.opacity)
    }

    /// Colour of a way of blending joints where several are compared.
    pub fn skinning(&self, skinning: Skinning) -> Colour {
        match skinning {
            Skinning::Linear => self.upper,
            Skinning::DualQuaternion => self.lower,
            Skinning::SpreadTwist => self.accent,
        }
    }

    /// Colour of a solver method in the comparison of solvers.
    pub fn method(&self, method: Method) -> Colour {
        self.series(match method {
            Method::TransposeFixed => 0,
            Method::Transpose => 1,
            Method::DampedLeastSquares => 2,
            Method::Ccd => 3,
            Method::Fabrik => 4,
            Method::Relaxation => 5,
            Method::TwoBone => 6,
        })
    }

    /// Colour of a curve or part of a diagram, from a series of seven that differ in hue or
    /// brightness.
    pub fn series(&self, index: usize) -> Colour {
        /// For the dark and the light theme.
        const SERIES: [[u32; 2]; 7] = [
            [0xc9a227, 0x7d6300],
            [0xf2d06b, 0x9a7b1c],
            [0x3fb8a5, 0x0b7466],
            [0x8fd460, 0x3f7a15],
            [0xb397f5, 0x6a42c4],
            [0x5ccbe8, 0x0d7896],
            [0xf08fb4, 0xb02a63],
        ];
        let [dark, light] = SERIES[index % SERIES.len()];
        Colour::rgb(if self.theme == Theme::Dark { dark } else { light })
    }

    /// Colour of the weight of a joint from 0 to 1, of the same ramp.
    pub fn weight(&self, weight: f32) -> Colour {
        self.along_ramp(weight * (Self::GAINS - 1) as f32).with_opacity(1.0)
    }

    /// Colour and opacity of a [gain](crate::kinematics::twist::TwistReference::gain) on the globe.
    /// The ramp is linear in the logarithm of 1 + gain, from a gain of 0 to [`Palette::MAX_GAIN`].
    pub fn gain(&self, gain: f32) -> Colour {
        let last = Self::GAINS - 1;
        let along = gain.max(0.0).ln_1p() / Self::MAX_GAIN.ln_1p() * last as f32;
        self.along_ramp(along)
    }

    /// Colour of what is wrong, such as a singular direction or a joint at its limit: that of
    /// [`Palette::MAX_GAIN`], opaque.
    pub fn danger(&self) -> Colour {
        self.gain(Self::MAX_GAIN).with_opacity(1.0)
    }

    /// Colour of the ramp between its colours; the first is at 0, the next at 1.
    fn along_ramp(&self, along: f32) -> Colour {
        let step = (along as usize).min(Self::GAINS - 2);
        self.gains[step].mixed(self.gains[step + 1], (along - step as f32).min(1.0))
    }
}

fn ramp(hex: [u32; Palette::GAINS]) -> [Colour; Palette::GAINS] {
    const OPACITY: [f32; Palette::GAINS] = [0.06, 0.11, 0.17, 0.24, 0.31];
    std::array::from_fn(|step| Colour::rgb(hex[step]).with_opacity(OPACITY[step]))
}

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
