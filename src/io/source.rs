use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::error::{OpenError, Remark, shortened};
use super::gltf::chunks::{self, Chunks};
use super::json_path::{JsonPath, byte_at, line_and_column};

/// A file's text, and what the file is called.
pub struct Source {
    name: String,
    text: String,
    /// What a binary file has beside its text.
    binary: Option<Vec<u8>>,
    /// Where other files that it tells of are.
    folder: Option<PathBuf>,
}

/// What is wrong or odd with a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong {
    pub field: JsonPath,
    pub reason: String,
}

impl Wrong {
    pub fn new(field: JsonPath, reason: impl Into<String>) -> Self {
        Self { field, reason: reason.into() }
    }
}

/// What is odd and no error. Only the first few are kept: to look up where each is takes a way
/// through the text.
#[derive(Debug, Default)]
pub struct Odd {
    first: Vec<Wrong>,
    more: usize,
}

impl Odd {
    pub fn push(&mut self, field: JsonPath, reason: impl Into<String>) {
        const MOST: usize = 20;
        if self.first.len() < MOST {
            self.first.push(Wrong::new(field, reason));
        } else {
            self.more += 1;
        }
    }
}

impl Source {
    /// In bytes.
    pub const LONGEST: u64 = 64 << 20;

    pub fn open(path: &Path) -> Result<Self, OpenError> {
        let name = path.display().to_string();
        let opened = File::open(path).and_then(|file| Ok((file.metadata()?.len(), file)));
        match opened {
            Ok((length, _)) if length > Self::LONGEST => Err(OpenError::TooLarge { file: name }),
            Ok((_, file)) => {
                let folder = path.parent().map(Path::to_owned);
                Ok(Self { folder, ..Self::read(&name, file)? })
            }
            Err(source) => Err(OpenError::Read { file: name, source }),
        }
    }

    pub fn read(name: &str, input: impl Read) -> Result<Self, OpenError> {
        let file = name.to_owned();
        let mut bytes = Vec::new();
        let read = input.take(Self::LONGEST + 1).read_to_end(&mut bytes);
        if let Err(source) = read {
            return Err(OpenError::Read { file, source });
        }
        if bytes.len() as u64 > Self::LONGEST {
            return Err(OpenError::TooLarge { file });
        }
        if bytes.starts_with(chunks::MAGIC) {
            let Chunks { json, binary } =
                chunks::split(&bytes).map_err(|reason| not_whole(file, reason))?;
            return Ok(Self { binary: Some(binary), ..Self::new(name, &json) });
        }
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self::new(name, &text)),
            Err(error) => Err(not_utf8(file, error.as_bytes())),
        }
    }

    pub fn new(name: &str, text: &str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        Self { name: name.to_owned(), text: text.to_owned(), binary: None, folder: None }
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    /// What a binary file has beside its text; none for other files.
    pub fn binary(&self) -> Option<&[u8]> {
        self.binary.as_deref()
    }

    /// Where other files that it tells of are, if that is known.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Reads the whole text; unknown fields are named to `ignored`.
    pub fn parse<T: DeserializeOwned>(
        &self,
        mut ignored: impl FnMut(JsonPath),
    ) -> Result<T, OpenError> {
        let mut json = serde_json::Deserializer::from_str(&self.text);
        let mut track = serde_path_to_error::Track::new();
        let tracked = serde_path_to_error::Deserializer::new(&mut json, &mut track);
        let parsed = serde_ignored::deserialize(tracked, |path| ignored(JsonPath::from(&path)));
        let value =
            parsed.map_err(|error| self.not_read(&JsonPath::from(&track.path()), &error))?;
        json.end().map_err(|error| self.not_read(&JsonPath::root(), &error))?;
        Ok(value)
    }

    pub fn wrong(&self, wrong: &Wrong) -> OpenError {
        OpenError::Content { file: self.name.clone(), remark: self.remark(wrong) }
    }

    pub fn remarks(&self, odd: &Odd) -> Vec<Remark> {
        let mut remarks: Vec<_> = odd.first.iter().map(|wrong| self.remark(wrong)).collect();
        if let Some(last) = remarks.last().filter(|_| odd.more > 0).cloned() {
            let reason = format!("and {} more like this", odd.more);
            remarks.push(Remark { field: String::new(), reason, ..last });
        }
        remarks
    }

    /// What the parser says, at the place of the value that it is about.
    pub fn not_read(&self, field: &JsonPath, error: &serde_json::Error) -> OpenError {
        let reason = without_position(error);
        if self.text.trim_ascii().is_empty() {
            return self.wrong(&Wrong::new(JsonPath::root(), "the file is empty"));
        }
        let is_about_value =
            error.is_data() && !reason.starts_with("duplicate") || reason == OUT_OF_RANGE;
        let reason = match reason.as_str() {
            OUT_OF_RANGE => format!("{OUT_OF_RANGE}; it must be between ±3.4028235e38"),
            _ if error.is_data() => reason,
            _ => format!("not JSON: {reason}"),
        };
        if is_about_value {
            return self.wrong(&Wrong::new(field.clone(), reason));
        }
        let byte = byte_at(&self.text, error.line(), error.column());
        let remark = self.remark_at(byte, field, &reason);
        OpenError::Content { file: self.name.clone(), remark }
    }

    /// What there is to say about a byte, and about which of the things there; empty for none.
    pub fn remark_about(&self, byte: usize, thing: &str, reason: &str) -> Remark {
        let field = if thing.is_empty() { JsonPath::root() } else { JsonPath::root().key(thing) };
        self.remark_at(byte, &field, reason)
    }

    fn remark(&self, Wrong { field, reason }: &Wrong) -> Remark {
        self.remark_at(field.find(&self.text), field, reason)
    }

    fn remark_at(&self, byte: usize, field: &JsonPath, reason: &str) -> Remark {
        let has_lines = self.binary.is_none();
        let (line, column) = if has_lines { line_and_column(&self.text, byte) } else { (0, 0) };
        let (field, reason) = (shortened(field.to_string()), shortened(reason.to_owned()));
        Remark { line, column, field, reason }
    }
}

/// serde_json has no other way to tell this error from the rest.
const OUT_OF_RANGE: &str = "number out of range";

/// A binary file of which nothing can be read.
fn not_whole(file: String, reason: String) -> OpenError {
    OpenError::Content { file, remark: Remark { line: 0, column: 0, field: String::new(), reason } }
}

fn not_utf8(file: String, bytes: &[u8]) -> OpenError {
    let valid = bytes.utf8_chunks().next().map_or("", |chunk| chunk.valid());
    let (line, column) = line_and_column(valid, valid.len());
    let byte = bytes.get(valid.len()).copied().unwrap_or_default();
    let reason = format!("byte {byte:#04x} is not UTF-8 there; JSON is written in UTF-8");
    OpenError::Content { file, remark: Remark { line, column, field: String::new(), reason } }
}

fn without_position(error: &serde_json::Error) -> String {
    let position = format!(" at line {} column {}", error.line(), error.column());
    let text = error.to_string();
    text.strip_suffix(&position).unwrap_or(&text).to_owned()
}
