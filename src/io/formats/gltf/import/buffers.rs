use std::borrow::Cow;
use std::collections::BTreeSet;

use crate::io::error::OpenError;
use crate::io::formats::gltf::file::{GltfBuffer, GltfFile, index_rule};
use crate::io::formats::gltf::material::Uri;
use crate::io::json::{FieldError, JsonPath};
use crate::io::packed;
use crate::io::source::Source;

/// The bytes of the buffers that the import reads; `None` for all other buffers.
pub struct GltfBuffers<'a>(Vec<Option<Cow<'a, [u8]>>>);

impl<'a> GltfBuffers<'a> {
    /// Reads the buffers with the indices `needed` from the binary chunk, from data URIs or from
    /// files in the folder of the glTF file. Fails if these buffers have more than
    /// [`OpenError::MAX_GLTF_BYTES`] together.
    pub fn read(
        source: &'a Source,
        file: &GltfFile<'_>,
        needed: &BTreeSet<usize>,
    ) -> Result<Self, FieldError> {
        let mut buffers = Self(vec![None; file.buffers.0.len()]);
        let mut remaining = OpenError::MAX_GLTF_BYTES;
        for &index in needed {
            let at = JsonPath::root().key("buffers").index(index);
            let (Some(buffer), Some(slot)) = (file.buffers.0.get(index), buffers.0.get_mut(index))
            else {
                return Err(FieldError::new(
                    at,
                    index_rule("buffers", file.buffers.0.len(), index),
                ));
            };
            let length = u64::from(buffer.length.0);
            if length > remaining {
                let max = OpenError::MAX_GLTF_BYTES >> 20;
                let reason = format!("must add up to at most {max} MB with those before it");
                return Err(FieldError::new(at.key("byteLength"), reason));
            }
            remaining -= length;
            *slot = Some(bytes(source, index, buffer, &at).map_err(|error| file.blamed(error))?);
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
    buffer: &GltfBuffer<'_>,
    at: &JsonPath,
) -> Result<Cow<'a, [u8]>, FieldError> {
    let length = buffer.length.0 as usize;
    let at_uri = at.clone().key("uri");
    let mut bytes = match (&buffer.uri, source.binary()) {
        (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
        (None, _) => {
            let reason = "must be given, except for the first buffer of a .glb file";
            return Err(FieldError::new(at_uri, reason));
        }
        (Some(Uri(uri)), _) => Cow::Owned(
            read_uri(source, uri, length).map_err(|reason| FieldError::new(at_uri, reason))?,
        ),
    };
    if bytes.len() < length {
        let size = bytes.len();
        let reason = format!("must be at most {size}, the size of the buffer, got {length}");
        return Err(FieldError::new(at.clone().key("byteLength"), reason));
    }
    match &mut bytes {
        Cow::Borrowed(bytes) => *bytes = &bytes[..length],
        Cow::Owned(bytes) => bytes.truncate(length),
    }
    Ok(bytes)
}

/// Returns whether a URI names a file, rather than containing data.
pub fn is_file(uri: &str) -> bool {
    !uri.starts_with("data:")
}

/// Reads a data URI, or at most `most` bytes of a file in the folder of the glTF file. The error is
/// the reason why that is impossible.
pub fn read_uri(source: &Source, uri: &str, most: usize) -> Result<Vec<u8>, String> {
    match uri.strip_prefix("data:") {
        Some(data) => decode_data_uri(data),
        None => read_file(source, uri, most),
    }
}

fn decode_data_uri(data: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = data.split_once(',') else {
        return Err("must have a comma before its data".to_owned());
    };
    if !kind.ends_with(";base64") {
        return Err(format!("must be data:…;base64,…, got data:{kind},…"));
    }
    packed::decode_base64(data)
}

/// Reads the first `length` bytes of a file in the folder of the glTF file.
fn read_file(source: &Source, uri: &str, length: usize) -> Result<Vec<u8>, String> {
    let name = unescaped(uri).ok_or_else(|| format!("must be the name of a file, got {uri:?}"))?;
    source.neighbour(&name, length)
}

/// Decodes the escapes in a URI, like `%20`. Returns `None` if an escape or the result is invalid.
fn unescaped(uri: &str) -> Option<String> {
    let mut parts = uri.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        bytes.push(u8::from_str_radix(part.get(..2)?, 16).ok()?);
        bytes.extend_from_slice(part.get(2..)?.as_bytes());
    }
    String::from_utf8(bytes).ok()
}
