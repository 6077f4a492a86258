//! Values of arguments that more than one command takes. clap adds the argument's name and its text
//! to the errors.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use glam::Vec3;
use thiserror::Error;

use crate::document::{AxisView, Camera, Display, Document, Overlay, Theme, Timeline};
use crate::export::ExportOptions;
use crate::kinematics::two_bone::TwoBone;

/// Rule that the text of an argument breaks.
#[derive(Debug, Error, PartialEq)]
pub enum ArgumentError {
    #[error("size must be like 1280x800, each side 1 to {max}", max = ExportOptions::MAX_SIDE)]
    Size,
    #[error("point must be three numbers like 250,120,60")]
    Point,
    #[error("number must be finite and fit a 32-bit float")]
    Number,
    #[error("time must be a finite number of seconds")]
    Time,
    #[error(
        "frames per second must be a number like 29.97 or 30000/1001, {min} to {max}",
        min = Timeline::MIN_FRAME_RATE, max = Timeline::MAX_FRAME_RATE
    )]
    FrameRate,
    #[error("limb length must be finite and above 0, got {0}")]
    Length(f32),
    #[error(
        "guides must be some of cursor, pointer, inner, outer, circle, or none alone, got {0:?}"
    )]
    Guide(String),
}

/// Reads frames per second, which need not be whole and may be a fraction.
pub fn frame_rate(text: &str) -> Result<f64, ArgumentError> {
    let number = |text: &str| text.parse::<f64>().ok();
    let rate = match text.split_once('/') {
        Some((frames, seconds)) => {
            number(frames).zip(number(seconds)).map(|(frames, seconds)| frames / seconds)
        }
        None => number(text),
    };
    rate.filter(|rate| Timeline::is_frame_rate(*rate)).ok_or(ArgumentError::FrameRate)
}

/// Reads the width and height of a picture in pixels.
pub fn size(text: &str) -> Result<(u32, u32), ArgumentError> {
    let is_side = |side: &u32| (1..=ExportOptions::MAX_SIDE).contains(side);
    let side = |text: &str| text.parse().ok().filter(is_side).filter(|_| !text.starts_with('+'));
    let sides = text.split_once('x').and_then(|(width, height)| side(width).zip(side(height)));
    sides.ok_or(ArgumentError::Size)
}

/// Reads a finite number.
pub fn number(text: &str) -> Result<f32, ArgumentError> {
    let number = text.trim().parse().ok();
    number.filter(|number: &f32| number.is_finite()).ok_or(ArgumentError::Number)
}

/// Reads a finite time in seconds.
pub fn time(text: &str) -> Result<f64, ArgumentError> {
    let time = text.trim().parse().ok();
    time.filter(|time: &f64| time.is_finite()).ok_or(ArgumentError::Time)
}

/// Reads the length of a limb.
pub fn length(text: &str) -> Result<f32, ArgumentError> {
    let length = number(text)?;
    TwoBone::new(length, length).map(|_| length).map_err(|_| ArgumentError::Length(length))
}

/// Reads a point with finite coordinates.
pub fn point(text: &str) -> Result<Vec3, ArgumentError> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(number).collect();
    match numbers.as_deref() {
        Ok([x, y, z]) => Ok(Vec3::new(*x, *y, *z)),
        _ => Err(ArgumentError::Point),
    }
}

/// The guides that are shown; all others are hidden.
#[derive(Clone, Debug)]
pub struct ShownGuides(Vec<Overlay>);

/// Reads the guides that are shown.
pub fn guides(text: &str) -> Result<ShownGuides, ArgumentError> {
    if text == "none" {
        return Ok(ShownGuides(Vec::new()));
    }
    let guide = |name: &str| match name.trim() {
        "cursor" => Ok(Overlay::Cursor),
        "pointer" => Ok(Overlay::Pointer),
        "inner" => Ok(Overlay::InnerLimit),
        "outer" => Ok(Overlay::OuterLimit),
        "circle" => Ok(Overlay::ElbowCircle),
        _ => Err(ArgumentError::Guide(name.to_owned())),
    };
    text.split(',').map(guide).collect::<Result<_, _>>().map(ShownGuides)
}

impl ShownGuides {
    /// Returns `display` with these guides shown, the other guides hidden and all other overlays
    /// unchanged.
    pub fn shown_in(&self, display: Display) -> Display {
        let show = |display: Display, guide| display.with(guide, self.0.contains(&guide));
        Overlay::GUIDES.into_iter().fold(display, show)
    }
}

impl ValueEnum for Theme {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Dark, Self::Light]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Self::Dark => "dark",
            Self::Light => "light",
        }))
    }
}

/// A side from which a rig is shown.
#[derive(Clone, Copy, ValueEnum)]
pub enum ViewName {
    Front,
    Right,
    Top,
    Perspective,
}

impl ViewName {
    /// The default camera, turned to look from this side.
    pub fn camera(self) -> Camera {
        let camera = Camera::default();
        match self {
            Self::Front => camera.along(AxisView::Front),
            Self::Right => camera.along(AxisView::Right),
            Self::Top => camera.along(AxisView::Top),
            Self::Perspective => camera,
        }
    }

    /// A camera that looks from this side and frames the rig over the timeline, for a picture
    /// of this width and height.
    pub fn framing(self, document: &Document, (width, height): (u32, u32)) -> Camera {
        let (centre, radius) = document.motion_bounds_with_guides();
        self.camera().framing(centre, radius, width as f32 / height as f32)
    }
}
