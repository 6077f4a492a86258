//! The content of a file that is opened.

use std::io::{self, Read, Seek};
use std::path::{Component, Path, PathBuf};

use serde::Deserialize;

use super::disk;
use super::error::{OpenError, Remark, shortened, shortened_to, system_reason, without_position};
use super::foreign::ForeignFormat;
use super::json::{FieldError, FieldWarnings, JsonPath, byte_at, line_and_column};
use super::packed::GlbChunks;

/// The text of a file, and the file's name for errors.
pub struct Source {
    name: String,
    text: String,
    /// The format of a file that cannot be read, which has no text then.
    foreign: Option<ForeignFormat>,
    /// The binary chunk of a GLB file.
    binary: Option<Vec<u8>>,
    /// The absolute path of the file; `None` if it was not opened by its path.
    path: Option<PathBuf>,
    /// CRC-32 of the bytes of the file.
    checksum: crc32fast::Hasher,
}

impl Source {
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        let name = path.display().to_string();
        let opened = disk::open_regular(path).and_then(|file| {
            let length = file.limit();
            let mut file = file.into_inner();
            Ok((exceeded_limit(&mut file, length)?, file.take(length)))
        });
        match opened {
            Ok((Some(most), _)) => Err(too_large(&name, most)),
            Ok((None, file)) => {
                let path = disk::absolute(path);
                Ok(Self { path, ..Self::read(&name, file)? })
            }
            Err(source) => Err(OpenError::Read { file: name, source }),
        }
    }

    pub fn read(name: &str, input: impl Read) -> Result<Self, OpenError> {
        let file = name.to_owned();
        let bytes = read_limited(name, input)?;
        if let Some(foreign) = ForeignFormat::of(&bytes) {
            return Ok(Self { foreign: Some(foreign), ..Self::of_text(name, String::new()) });
        }
        let mut checksum = crc32fast::Hasher::new();
        checksum.update(&bytes);
        if bytes.starts_with(GlbChunks::MAGIC) {
            let GlbChunks { json, binary } =
                GlbChunks::split(bytes).map_err(|reason| invalid_chunks(file, reason))?;
            return Ok(Self { binary: Some(binary), checksum, ..Self::of_text(name, json) });
        }
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self { checksum, ..Self::of_text(name, text) }),
            Err(error) => Err(not_utf8(file, error.as_bytes())),
        }
    }

    pub fn new(name: &str, text: &str) -> Self {
        Self::of_text(name, text.to_owned())
    }

    /// Takes the text, which may be large, without a copy.
    fn of_text(name: &str, mut text: String) -> Self {
        const BYTE_ORDER_MARK: char = '\u{feff}';
        if text.starts_with(BYTE_ORDER_MARK) {
            text.drain(..BYTE_ORDER_MARK.len_utf8());
        }
        Self {
            name: name.to_owned(),
            text,
            foreign: None,
            binary: None,
            path: None,
            checksum: crc32fast::Hasher::new(),
        }
    }

    /// The error for a file that is larger than files other than glTF may be.
    pub fn too_large(&self) -> OpenError {
        too_large(&self.name, OpenError::MAX_BYTES)
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    /// The format of a file that cannot be read; `None` for other files.
    pub fn foreign(&self) -> Option<ForeignFormat> {
        self.foreign
    }

    /// The binary chunk of a GLB file; `None` for other files.
    pub fn binary(&self) -> Option<&[u8]> {
        self.binary.as_deref()
    }

    /// The absolute path of the file; `None` if it was not opened by its path.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The folder of the file, in which other files that it names are looked up; `None` if the file
    /// was not opened by its path.
    pub fn folder(&self) -> Option<&Path> {
        self.path()?.parent()
    }

    /// Reads at most `most` bytes of another file in the folder of this one, or below it. The error is
    /// the reason why that is impossible.
    pub fn neighbour(&self, name: &str, most: usize) -> Result<Vec<u8>, String> {
        let Some(folder) = self.folder() else {
            return Err(format!(
                "must not be another file if the folder is unknown, got {name:?}; open the file by \
                 its path, or one that contains all"
            ));
        };
        let is_plain =
            |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if name.contains([':', '\\', '\0']) || !Path::new(name).components().all(is_plain) {
            return Err(format!("must be in the file's own folder, got {name:?}"));
        }
        let path = folder.join(name);
        let failed =
            |error| format!("{} cannot be read: {}", path.display(), system_reason(&error));
        let target = disk::end_of_links(&path).map_err(failed)?;
        if !target.starts_with(disk::end_of_links(folder).map_err(failed)?) {
            let (link, target) = (path.display(), target.display());
            return Err(format!(
                "must be in the file's own folder, got {link}, a link to {target}"
            ));
        }
        let file = disk::open_regular(&path).map_err(failed)?;
        let mut bytes = Vec::new();
        file.take(most as u64).read_to_end(&mut bytes).map_err(failed)?;
        Ok(bytes)
    }

    /// CRC-32 of the file, to be updated with the files that it names.
    pub fn checksum(&self) -> crc32fast::Hasher {
        self.checksum.clone()
    }

    /// Parses the whole text, and calls `ignored` with each unknown field.
    pub fn parse<'a, T: Deserialize<'a>>(
        &'a self,
        mut ignored: impl FnMut(JsonPath),
    ) -> Result<T, OpenError> {
        let mut json = serde_json::Deserializer::from_str(&self.text);
        let mut track = serde_path_to_error::Track::new();
        let tracked = serde_path_to_error::Deserializer::new(&mut json, &mut track);
        let parsed = serde_ignored::deserialize(tracked, |path| ignored(JsonPath::from(&path)));
        let value =
            parsed.map_err(|error| self.parse_error(&JsonPath::from(&track.path()), &error))?;
        json.end().map_err(|error| self.parse_error(&JsonPath::root(), &error))?;
        Ok(value)
    }

    pub fn error(&self, error: &FieldError) -> OpenError {
        OpenError::Content { file: self.name.clone(), remark: self.remark(error) }
    }

    pub fn warnings(&self, warnings: &FieldWarnings) -> Vec<Remark> {
        let mut remarks: Vec<_> = warnings.first.iter().map(|error| self.remark(error)).collect();
        if let Some(last) = remarks.last().filter(|_| warnings.more > 0).cloned() {
            let reason = format!("and {} more like this", warnings.more);
            remarks.push(Remark { field: String::new(), reason, ..last });
        }
        remarks
    }

    /// Converts an error of the JSON parser. The result is at the position of the invalid value,
    /// or, for a text that is not JSON, where the parser stopped.
    pub fn parse_error(&self, field: &JsonPath, error: &serde_json::Error) -> OpenError {
        /// Message of serde_json for a number that overflows. Only this text identifies the error.
        const OUT_OF_RANGE: &str = "number out of range";
        let text = without_position(error);
        if self.text.trim_ascii().is_empty() {
            return self.error(&FieldError::new(JsonPath::root(), "the file is empty"));
        }
        let is_about_value =
            error.is_data() && !text.starts_with("duplicate") || text == OUT_OF_RANGE;
        let reason = match text.as_str() {
            OUT_OF_RANGE => "must be within ±3.4028235e38".to_owned(),
            _ if error.is_data() => text,
            _ => format!("not JSON: {text}"),
        };
        if is_about_value {
            return self.error(&FieldError::new(field.clone(), reason));
        }
        let byte = byte_at(&self.text, error.line(), error.column());
        let remark = self.remark_at(byte, field, &reason);
        OpenError::Content { file: self.name.clone(), remark }
    }

    /// Returns a remark at a byte of the text. `joint` is the name of the joint that the remark is
    /// about, or empty.
    pub fn remark_about(&self, byte: usize, joint: &str, reason: &str) -> Remark {
        let field = if joint.is_empty() { JsonPath::root() } else { JsonPath::root().key(joint) };
        self.remark_at(byte, &field, reason)
    }

    fn remark(&self, FieldError { field, reason }: &FieldError) -> Remark {
        self.remark_at(field.find(&self.text), field, reason)
    }

    fn remark_at(&self, byte: usize, field: &JsonPath, reason: &str) -> Remark {
        let (line, column) = match self.binary {
            Some(_) => (0, 0),
            None => line_and_column(&self.text, byte),
        };
        /// Most letters of the field, which fits a window together with the reason.
        const MOST: usize = 300;
        let field = shortened_to(field.to_string(), MOST);
        let reason = shortened(reason.to_owned());
        Remark { line, column, field, reason }
    }
}

/// The limit that a file exceeds, judged by its length and its first bytes; `None` if it is to be
/// read.
fn exceeded_limit(file: &mut (impl Read + Seek), length: u64) -> io::Result<Option<u64>> {
    if length <= OpenError::MAX_BYTES {
        return Ok(None);
    }
    let mut head = [0; 64];
    let read = file.read(&mut head)?;
    file.rewind()?;
    let most = most_bytes(&head[..read]);
    Ok((length > most).then_some(most))
}

/// Maximum size of a file that begins with these bytes. A file that can be glTF, binary or text,
/// may be larger than others.
fn most_bytes(head: &[u8]) -> u64 {
    let can_be_gltf =
        head.starts_with(GlbChunks::MAGIC) || head.trim_ascii_start().starts_with(b"{");
    if can_be_gltf { OpenError::MAX_GLTF_BYTES } else { OpenError::MAX_BYTES }
}

fn too_large(name: &str, most: u64) -> OpenError {
    OpenError::TooLarge { file: name.to_owned(), most_mb: most >> 20 }
}

/// Reads all bytes of a file, if there are not too many.
fn read_limited(name: &str, input: impl Read) -> Result<Vec<u8>, OpenError> {
    let read_error = |source| OpenError::Read { file: name.to_owned(), source };
    let mut bytes = Vec::new();
    let mut input = input.take(OpenError::MAX_BYTES + 1);
    input.read_to_end(&mut bytes).map_err(read_error)?;
    if bytes.len() as u64 <= OpenError::MAX_BYTES {
        return Ok(bytes);
    }
    let most = most_bytes(&bytes);
    input.set_limit(most - OpenError::MAX_BYTES);
    input.read_to_end(&mut bytes).map_err(read_error)?;
    if bytes.len() as u64 > most { Err(too_large(name, most)) } else { Ok(bytes) }
}

/// The error of a binary file, without line, column and field.
fn invalid_chunks(file: String, reason: String) -> OpenError {
    OpenError::Content { file, remark: Remark::new(reason) }
}

fn not_utf8(file: String, bytes: &[u8]) -> OpenError {
    let valid = bytes.utf8_chunks().next().map_or("", |chunk| chunk.valid());
    let (line, column) = line_and_column(valid, valid.len());
    let byte = bytes.get(valid.len()).copied().unwrap_or_default();
    let reason = format!("text must be UTF-8, got byte {byte:#04x}");
    OpenError::Content { file, remark: Remark { line, column, field: String::new(), reason } }
}

/// Reads the text of a regular file.
///
/// # Errors
///
/// As for [`open_regular`](disk::open_regular), and if the text is not UTF-8.
#[cfg(all(feature = "app", not(target_arch = "wasm32")))]
pub fn read_text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    disk::open_regular(path)?.read_to_string(&mut text)?;
    Ok(text)
}
