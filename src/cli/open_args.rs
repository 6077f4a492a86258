//! The choice of one of a file's skeletons and animations, for all commands that open files.

use clap::{Args, ValueEnum};

use crate::io::{OpenOptions, Upwards};

#[derive(Args, Default)]
#[group(requires = "file")]
pub struct OpenArgs {
    /// Skeleton to open, if the file has several [default: the first]
    #[arg(long, value_name = "NAME")]
    skeleton: Option<String>,
    /// Animation to open, by its name or its number from 0 [default: the first that moves]
    #[arg(long, value_name = "NAME|N")]
    animation: Option<String>,
    /// Axis that points up in the file; z turns the skeleton, auto if its bind pose stands along z
    /// [default: y, with a remark if it seems to be z]
    #[arg(long, value_enum)]
    up: Option<UpName>,
}

#[derive(Clone, Copy, ValueEnum)]
enum UpName {
    Y,
    Z,
    Auto,
}

impl From<UpName> for Upwards {
    fn from(name: UpName) -> Self {
        match name {
            UpName::Y => Self::Y,
            UpName::Z => Self::Z,
            UpName::Auto => Self::Auto,
        }
    }
}

impl OpenArgs {
    pub fn options(&self) -> OpenOptions {
        OpenOptions {
            skeleton: self.skeleton.clone(),
            animation: self.animation.clone(),
            up: self.up.map(UpName::into),
            without_camera: false,
        }
    }
}
