//! What arguments stand for.

use std::str::FromStr;

use clap::ValueEnum;
use glam::Vec3;
use thiserror::Error;

use crate::document::{Display, Overlay, Theme};
use crate::kinematics::two_bone::{LengthError, TwoBone};

/// Why an argument is not what it stands for.
#[derive(Debug, Error, PartialEq)]
pub enum ArgumentError {
    #[error("{0:?} is not a size; it must be like 1280x800, each side 1 to {max}", max = Size::MAX)]
    Size(String),
    #[error("{0:?} is not a point; it must be three numbers like 250,120,60")]
    Point(String),
    #[error("{0:?} is not a number that a 32-bit float can hold")]
    Number(String),
    #[error("{0:?} is not a finite number of seconds")]
    Time(String),
    #[error(transparent)]
    Length(#[from] LengthError),
    #[error("{0:?} is not a guide; they are cursor, pointer, inner, outer, or none alone")]
    Guide(String),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    pub width: u32,
    pub height: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f32);

/// Seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time(pub f64);

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length(pub f32);

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point(pub Vec3);

#[derive(Clone, Copy, ValueEnum)]
pub enum ThemeName {
    Dark,
    Light,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Guides(Vec<Overlay>);

impl Size {
    const MAX: u32 = 8192;
}

impl FromStr for Size {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let side = |text: &str| {
            text.parse()
                .ok()
                .filter(|side| (1..=Self::MAX).contains(side) && !text.starts_with('+'))
        };
        text.split_once('x')
            .and_then(|(width, height)| Some(Self { width: side(width)?, height: side(height)? }))
            .ok_or_else(|| ArgumentError::Size(text.to_owned()))
    }
}

impl FromStr for Number {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let number = text.trim().parse().ok().filter(|number: &f32| number.is_finite());
        number.map(Self).ok_or_else(|| ArgumentError::Number(text.to_owned()))
    }
}

impl FromStr for Time {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let time = text.trim().parse().ok().filter(|time: &f64| time.is_finite());
        time.map(Self).ok_or_else(|| ArgumentError::Time(text.to_owned()))
    }
}

impl FromStr for Length {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let Number(length) = text.parse()?;
        TwoBone::new(length, length)
            .map(|bones| Self(bones.upper()))
            .map_err(|_| ArgumentError::Length(LengthError { bone: "limb", value: length }))
    }
}

impl FromStr for Point {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let numbers: Result<Vec<Number>, _> = text.split(',').map(str::parse).collect();
        match numbers.as_deref() {
            Ok([x, y, z]) => Ok(Self(Vec3::new(x.0, y.0, z.0))),
            _ => Err(ArgumentError::Point(text.to_owned())),
        }
    }
}

impl Guides {
    pub fn shown_in(&self, display: Display) -> Display {
        let show = |display: Display, guide| display.with(guide, self.0.contains(&guide));
        Overlay::GUIDES.into_iter().fold(display, show)
    }
}

impl FromStr for Guides {
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
