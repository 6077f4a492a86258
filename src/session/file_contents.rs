use std::path::PathBuf;

use crate::io::{FileAnimation, OpenOptions, Opened};

/// The skeletons and animations of a file, of which one each is open.
#[derive(Clone, Debug, PartialEq)]
pub struct FileContents {
    /// The file.
    pub path: PathBuf,
    /// What was chosen when the file was opened.
    pub options: OpenOptions,
    /// Names of the skeletons.
    pub skeletons: Vec<String>,
    /// The animations.
    pub animations: Vec<FileAnimation>,
    /// Index of the open animation; `None` without animations.
    pub animation: Option<usize>,
}

impl FileContents {
    /// The contents of a file that was opened with `options`.
    pub fn new(path: PathBuf, options: OpenOptions, opened: &Opened) -> Self {
        Self {
            path,
            options,
            skeletons: opened.skeletons.clone(),
            animations: opened.animations.clone(),
            animation: opened.animation,
        }
    }

    /// Whether the user is asked what to open: there is a choice, and none was made.
    pub fn asks(&self) -> bool {
        self.options == OpenOptions::default() && self.has_choice()
    }

    /// Whether the file has several skeletons or animations to choose from.
    pub fn has_choice(&self) -> bool {
        self.skeletons.len() > 1 || self.animations.len() > 1
    }
}
