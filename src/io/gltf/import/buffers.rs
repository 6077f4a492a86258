use std::borrow::Cow;
use std::fs;
use std::io::Read;
use std::path::{Component, Path};

use super::base64;
use super::file::{GltfBuffer, GltfFile};
use crate::io::error::OpenError;
use crate::io::field_error::FieldError;
use crate::io::json_path::JsonPath;
use crate::io::source::Source;

/// The bytes of the buffers that are needed.
pub struct GltfBuffers<'a>(Vec<Option<Cow<'a, [u8]>>>);

impl<'a> GltfBuffers<'a> {
    /// Reads buffers from the binary chunk, data URIs or files beside the file. Fails if they are larger
    /// together than the largest file.
    pub fn read(source: &'a Source, file: &GltfFile, needed: &[usize]) -> Result<Self, FieldError> {
        let mut buffers = Self(vec![None; file.buffers.0.len()]);
        let mut left = OpenError::MAX_BYTES;
        for &index in needed {
            let at = JsonPath::root().key("buffers").index(index);
            let (Some(buffer), Some(place)) = (file.buffers.0.get(index), buffers.0.get_mut(index))
            else {
                return Err(FieldError::new(at, "there is no such buffer"));
            };
            let length = u64::from(buffer.length.0);
            if length > left {
                let most = OpenError::MAX_BYTES >> 20;
                let reason = format!("makes more than {most} MB with those before it");
                return Err(FieldError::new(at.key("byteLength"), reason));
            }
            left -= length;
            *place = Some(bytes(source, index, buffer, &at)?);
        }
        Ok(buffers)
    }

    pub fn get(&self, index: usize) -> Option<&[u8]> {
        self.0.get(index)?.as_deref()
    }
}

fn bytes<'a>(
    source: &'a Source,
    index: usize,
    buffer: &GltfBuffer,
    at: &JsonPath,
) -> Result<Cow<'a, [u8]>, FieldError> {
    let length = buffer.length.0 as usize;
    let at_uri = at.clone().key("uri");
    let mut bytes = match (&buffer.uri, source.binary()) {
        (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
        (None, _) => {
            let reason = "is not there; only the first buffer of a .glb file can be without one";
            return Err(FieldError::new(at_uri, reason));
        }
        (Some(uri), _) => Cow::Owned(match uri.strip_prefix("data:") {
            Some(data) => inline(data).map_err(|reason| FieldError::new(at_uri, reason))?,
            None => {
                beside(source, uri, length).map_err(|reason| FieldError::new(at_uri, reason))?
            }
        }),
    };
    if bytes.len() < length {
        let there = bytes.len();
        let reason = format!("is {length}, but the buffer has {there} bytes");
        return Err(FieldError::new(at.clone().key("byteLength"), reason));
    }
    match &mut bytes {
        Cow::Borrowed(bytes) => *bytes = &bytes[..length],
        Cow::Owned(bytes) => bytes.truncate(length),
    }
    Ok(bytes)
}

fn inline(data: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = data.split_once(',') else {
        return Err("has no comma, after which its data would be".to_owned());
    };
    if !kind.ends_with(";base64") {
        return Err("is data that is not in base64; it must be data:…;base64,…".to_owned());
    }
    base64::decode(data)
}

/// The bytes of a file beside the one that is read.
fn beside(source: &Source, uri: &str, length: usize) -> Result<Vec<u8>, String> {
    let Some(folder) = source.folder() else {
        return Err(format!(
            "{uri:?} is another file, and it is not known where; open the file by its name, or use \
             a .glb file"
        ));
    };
    let name = unescaped(uri).ok_or_else(|| format!("{uri:?} is not the name of a file"))?;
    let is_plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if name.contains([':', '\\', '\0']) || !Path::new(&name).components().all(is_plain) {
        return Err(format!("{uri:?} is not allowed; a buffer must be in the file's own folder"));
    }
    let path = folder.join(name);
    let failed = |error| format!("{} cannot be read: {error}", path.display());
    if !fs::metadata(&path).map_err(failed)?.is_file() {
        return Err(format!("{} is not a file", path.display()));
    }
    let mut bytes = Vec::new();
    let file = fs::File::open(&path).map_err(failed)?;
    file.take(length as u64).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

/// A URI with escapes like `%20` decoded.
fn unescaped(uri: &str) -> Option<String> {
    let mut parts = uri.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        bytes.push(u8::from_str_radix(part.get(..2)?, 16).ok()?);
        bytes.extend_from_slice(part.get(2..)?.as_bytes());
    }
    String::from_utf8(bytes).ok()
}
