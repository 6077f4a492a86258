//! Values of arguments that more than one command takes.

use std::str::FromStr;

use clap::ValueEnum;
use glam::Vec3;
use thiserror::Error;

use crate::document::{Display, Overlay, Theme, Timeline};
use crate::export::ExportOptions;
use crate::kinematics::two_bone::TwoBone;

/// Rule that the text of an argument breaks. clap adds the argument's name and its text to the
/// message.
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

/// Width and height of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeArgument {
    pub width: u32,
    pub height: u32,
}

/// A finite number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberArgument(pub f32);

/// Finite time in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeArgument(pub f64);

/// Frames per second; need not be whole, and may be a fraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRateArgument(pub f64);

/// Length of a limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthArgument(pub f32);

/// A point with finite coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointArgument(pub Vec3);

#[derive(Clone, Copy, ValueEnum)]
pub enum ThemeName {
    Dark,
    Light,
}

/// Guides that are shown; all others are hidden.
#[derive(Clone, Debug, PartialEq)]
pub struct GuidesArgument(Vec<Overlay>);

impl FromStr for FrameRateArgument {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let number = |text: &str| text.parse::<f64>().ok();
        let rate = match text.split_once('/') {
            Some((frames, seconds)) => {
                number(frames).zip(number(seconds)).map(|(frames, seconds)| frames / seconds)
            }
            None => number(text),
        };
        rate.filter(|rate| Timeline::is_frame_rate(*rate)).map(Self).ok_or(ArgumentError::FrameRate)
    }
}

impl FromStr for SizeArgument {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let side = |text: &str| {
            text.parse().ok().filter(|side| {
                (1..=ExportOptions::MAX_SIDE).contains(side) && !text.starts_with('+')
            })
        };
        text.split_once('x')
            .and_then(|(width, height)| Some(Self { width: side(width)?, height: side(height)? }))
            .ok_or(ArgumentError::Size)
    }
}

impl FromStr for NumberArgument {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let number = text.trim().parse().ok().filter(|number: &f32| number.is_finite());
        number.map(Self).ok_or(ArgumentError::Number)
    }
}

impl FromStr for TimeArgument {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let time = text.trim().parse().ok().filter(|time: &f64| time.is_finite());
        time.map(Self).ok_or(ArgumentError::Time)
    }
}

impl FromStr for LengthArgument {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let NumberArgument(length) = text.parse()?;
        TwoBone::new(length, length)
            .map(|bones| Self(bones.upper()))
            .map_err(|_| ArgumentError::Length(length))
    }
}

impl FromStr for PointArgument {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let numbers: Result<Vec<NumberArgument>, _> = text.split(',').map(str::parse).collect();
        match numbers.as_deref() {
            Ok([x, y, z]) => Ok(Self(Vec3::new(x.0, y.0, z.0))),
            _ => Err(ArgumentError::Point),
        }
    }
}

impl GuidesArgument {
    /// Returns `display` with these guides shown, the other guides hidden and all other overlays
    /// unchanged.
    pub fn shown_in(&self, display: Display) -> Display {
        let show = |display: Display, guide| display.with(guide, self.0.contains(&guide));
        Overlay::GUIDES.into_iter().fold(display, show)
    }
}

impl FromStr for GuidesArgument {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        if text == "none" {
            return Ok(Self(Vec::new()));
        }
        let guide = |name: &str| match name.trim() {
            "cursor" => Ok(Overlay::Cursor),
            "pointer" => Ok(Overlay::Pointer),
            "inner" => Ok(Overlay::InnerLimit),
            "outer" => Ok(Overlay::OuterLimit),
            "circle" => Ok(Overlay::ElbowCircle),
            _ => Err(ArgumentError::Guide(name.to_owned())),
        };
        text.split(',').map(guide).collect::<Result<_, _>>().map(Self)
    }
}

impl From<ThemeName> for Theme {
    fn from(name: ThemeName) -> Self {
        match name {
            ThemeName::Dark => Self::Dark,
            ThemeName::Light => Self::Light,
        }
    }
}
