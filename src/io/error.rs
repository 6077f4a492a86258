use std::fmt;
use std::io;

use thiserror::Error;

/// The reason why a file cannot be opened.
#[derive(Debug, Error)]
pub enum OpenError {
    /// The system cannot read the file.
    #[error("{file} cannot be read: {}", system_reason(source))]
    Read {
        /// Name of the file.
        file: String,
        /// The system's error.
        source: io::Error,
    },
    /// The file is larger than [`OpenError::MAX_BYTES`], or for glTF [`OpenError::MAX_GLTF_BYTES`].
    #[error("{file} must be at most {most_mb} MB large")]
    TooLarge {
        /// Name of the file.
        file: String,
        /// The limit in MB.
        most_mb: u64,
    },
    /// The file has a format of another program that cannot be read.
    #[error("{file} is {what}, and only {readable} can be read; {advice}")]
    Foreign {
        /// Name of the file.
        file: String,
        /// The format, like `an FBX file`.
        what: &'static str,
        /// Extensions of the formats that can be read.
        readable: String,
        /// Program that usually converts the file.
        advice: &'static str,
    },
    /// The content is invalid.
    #[error("{file}, {remark}")]
    Content {
        /// Name of the file.
        file: String,
        /// Position and reason of the error.
        remark: Remark,
    },
    /// The file has no skeleton of the requested name.
    #[error("{file} has no skeleton called {name:?}; {}", list(names))]
    NoSkeleton {
        /// Name of the file.
        file: String,
        /// The requested name.
        name: String,
        /// Names of the file's skeletons; empty for this program's own format, in which the one
        /// skeleton has no name.
        names: Vec<String>,
    },
    /// The file has no animation of the requested name or number.
    #[error("{file} has no animation {name:?}; {}", list_animations(names))]
    NoAnimation {
        /// Name of the file.
        file: String,
        /// The requested name or number.
        name: String,
        /// Names of the file's animations.
        names: Vec<String>,
    },
}

impl OpenError {
    /// Maximum size of a file that is read, in bytes, except for glTF.
    pub const MAX_BYTES: u64 = 64 << 20;
    /// Maximum size in bytes of a glTF file, and of its buffers together. Most of it is textures;
    /// the numbers of keys, vertices and pixels that are read have limits of their own.
    pub const MAX_GLTF_BYTES: u64 = 1 << 30;
}

/// A message about a position in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// Number of the line, from 1; 0 for a binary file.
    pub line: usize,
    /// Column in characters, from 1; 0 for a binary file.
    pub column: usize,
    /// Path of the field that the message is about, like `skeleton.joints[3].parent`, or in a BVH
    /// file the name of the joint. Empty if the message is about neither.
    pub field: String,
    /// The rule and the value that breaks it.
    pub reason: String,
}

impl Remark {
    /// A message about a whole file.
    pub(super) fn new(reason: String) -> Self {
        Self { line: 0, column: 0, field: String::new(), reason }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, column, field, reason } = self;
        if *line > 0 {
            write!(f, "line {line}, column {column}: ")?;
        }
        if !field.is_empty() {
            write!(f, "{field}: ")?;
        }
        f.write_str(reason)
    }
}

/// The reason why a document cannot be saved.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The document, with its packed mesh, is larger than [`OpenError::MAX_BYTES`].
    #[error(
        "the document cannot be written: it would have {got} MB, and at most {} MB can be opened again; \
         keep the mesh of its skin in a file of its own",
        OpenError::MAX_BYTES >> 20
    )]
    TooLarge {
        /// Size in MB.
        got: u64,
    },
    /// The document cannot be serialized as JSON.
    #[error("the document cannot be written: {0}")]
    Value(#[from] serde_json::Error),
}

/// The reason why a file cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The file's folder does not exist.
    #[error("{path} could not be written: there is no folder {folder}")]
    NoFolder {
        /// Path of the file.
        path: String,
        /// Path of the missing folder.
        folder: String,
    },
    /// The system cannot write the file.
    #[error("{path} could not be written: {}", system_reason(source))]
    Write {
        /// Path of the file.
        path: String,
        /// The system's error.
        source: io::Error,
    },
}

fn list(names: &[String]) -> String {
    match names {
        [] => "it has one skeleton, without a name".to_owned(),
        names => format!("it has {}", quoted(names)),
    }
}

fn list_animations(names: &[String]) -> String {
    let (first, more) = names.split_at(names.len().min(MOST_NAMES));
    match (first.len(), more.len()) {
        (0, _) => "it has none that can be chosen".to_owned(),
        (_, 0) => format!("it has {}", quoted(first)),
        (_, more) => format!("it has {} and {more} more", quoted(first)),
    }
}

/// Maximum number of names that a message lists.
pub const MOST_NAMES: usize = 20;

/// Names in quotes.
pub fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ")
}

/// The reason that the system gives for an error, without its number.
pub fn system_reason(error: &io::Error) -> String {
    let text = error.to_string();
    let number = error.raw_os_error().map(|number| format!(" (os error {number})"));
    number.and_then(|number| text.strip_suffix(&number)).unwrap_or(&text).to_owned()
}

/// The text of a parser's error without the position at its end.
pub fn without_position(error: &serde_json::Error) -> String {
    let position = format!(" at line {} column {}", error.line(), error.column());
    let text = error.to_string();
    text.strip_suffix(&position).unwrap_or(&text).to_owned()
}

/// Replaces the middle of a long message by `…`.
pub fn shortened(message: String) -> String {
    const MOST: usize = 560;
    shortened_to(message, MOST)
}

/// Replaces the middle of a text by `…` if it has more than `most` letters.
pub fn shortened_to(text: String, most: usize) -> String {
    let end = 2 * most / 7;
    let start = most - end;
    let count = text.chars().count();
    if count <= most {
        return text;
    }
    let (start, end) = (text.chars().take(start), text.chars().skip(count - end));
    start.chain("…".chars()).chain(end).collect()
}
