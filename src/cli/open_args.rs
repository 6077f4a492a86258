//! The choice of one of a file's skeletons and animations, for all commands that open files.

use clap::Args;

use crate::io::OpenOptions;

#[derive(Args, Default)]
#[group(requires = "file")]
pub struct OpenArgs {
    /// Skeleton to open, if the file has several [default: the first]
    #[arg(long, value_name = "NAME")]
    skeleton: Option<String>,
    /// Animation to open, by its name or its number from 0 [default: the first that moves]
    #[arg(long, value_name = "NAME|N")]
    animation: Option<String>,
}

impl OpenArgs {
    pub fn options(&self) -> OpenOptions {
        OpenOptions { skeleton: self.skeleton.clone(), animation: self.animation.clone() }
    }
}
