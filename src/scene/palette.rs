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

    /// Red, green, blue and opacity from 0 to 1, still sRGB.
    pub fn channels(self) -> [f32; 4] {
        self.0.map(|channel| f32::from(channel) / 255.0)
    }
}

/// Whether the picture is bright or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    #[default]
    Dark,
    Light,
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
    /// How dark the darkest shadow is.
    pub shadow: f32,
}

impl Palette {
    pub fn new(theme: Theme) -> Self {
        match theme {
            Theme::Dark => Self {
                theme,
                upper: Colour::rgb(0xd2_6e_46),
                lower: Colour::rgb(0x5c_88_ba),
                joint: Colour::rgb(0xc4_c8_ce),
                guide: Colour::rgb(0xee_f0_f4),
                accent: Colour::rgb(0xb3_97_f5),
                axes: [0xe0_4b_4b, 0x6f_b3_3c, 0x4a_86_f0].map(Colour::rgb),
                sky_top: Colour::rgb(0x2c_31_3a),
                sky_bottom: Colour::rgb(0x17_1a_1f),
                ground: Colour::rgb(0x3a_40_4a),
                grid: Colour::rgb(0x9a_a4_b4),
                text: Colour::rgb(0xee_f0_f4),
                shadow: 0.62,
            },
            Theme::Light => Self {
                theme,
                upper: Colour::rgb(0xc4_5c_36),
                lower: Colour::rgb(0x47_71_a3),
                joint: Colour::rgb(0xbc_c1_c8),
                guide: Colour::rgb(0x1c_1f_24),
                accent: Colour::rgb(0x6a_42_c4),
                axes: [0xd0_32_32, 0x45_8f_20, 0x28_64_d8].map(Colour::rgb),
                sky_top: Colour::rgb(0xf6_f8_fa),
                sky_bottom: Colour::rgb(0xd9_df_e6),
                ground: Colour::rgb(0xff_ff_ff),
                grid: Colour::rgb(0x5a_66_78),
                text: Colour::rgb(0x1c_1f_24),
                shadow: 0.42,
            },
        }
    }
}
