//! Bytes in files: base64 (RFC 4648), read with or without its padding, lists of little-endian
//! numbers of four bytes, and the container of a `.glb` file. Bytes after the last whole number of
//! a list are left out.

use core::ops::Range;

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

const ENGINE: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Decodes a text. The error is the reason why that is impossible.
pub fn decode_base64(text: &str) -> Result<Vec<u8>, String> {
    ENGINE.decode(text).map_err(|error| format!("data must be base64: {error}"))
}

/// Encodes bytes, with padding.
pub fn encode_base64(bytes: &[u8]) -> String {
    ENGINE.encode(bytes)
}

pub fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
}

pub fn wholes(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()
}

/// The chunks of a `.glb` file: after a header of 12 bytes, each has a length, a type and its
/// bytes. The first chunk is JSON, the second binary.
pub struct GlbChunks {
    pub json: String,
    /// Content of the binary chunk; empty if the file has none.
    pub binary: Vec<u8>,
}

impl GlbChunks {
    /// The first bytes of a `.glb` file.
    pub const MAGIC: &[u8] = b"glTF";

    /// Splits a file into its chunks. The error is the reason why the file is invalid.
    pub fn split(mut bytes: Vec<u8>) -> Result<Self, String> {
        let (json, binary) = chunk_ranges(&bytes)?;
        let json = String::from_utf8(bytes[json].to_vec())
            .map_err(|error| format!("JSON chunk must be UTF-8: {}", error.utf8_error()))?;
        // The binary chunk can be large: it stays in its memory.
        bytes.truncate(binary.end);
        bytes.drain(..binary.start);
        Ok(Self { json, binary: bytes })
    }
}

/// Length in bytes of the file's header, and of a chunk's.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// The contents of the JSON chunk and of the binary chunk; the second is empty if there is none.
fn chunk_ranges(bytes: &[u8]) -> Result<(Range<usize>, Range<usize>), String> {
    let short_header = || format!("header must have 12 bytes, got {}", bytes.len());
    let version = number(bytes, 4).ok_or_else(short_header)?;
    let length = number(bytes, 8).ok_or_else(short_header)? as usize;
    if version != 2 {
        return Err(format!("glTF version must be 2, got {version}"));
    }
    let Some(bytes) = bytes.get(..length) else {
        let size = bytes.len();
        return Err(format!("file must have {length} bytes, as its header says, got {size}"));
    };
    let (json, rest) = chunk(bytes.get(HEADER..).unwrap_or_default(), "JSON", *b"JSON")?;
    let json = HEADER + CHUNK_HEADER..HEADER + CHUNK_HEADER + json.len();
    let is_binary = rest.get(4..8) == Some(b"BIN\0");
    let length = if is_binary { chunk(rest, "binary", *b"BIN\0")?.0.len() } else { 0 };
    let start = if is_binary { json.end + CHUNK_HEADER } else { json.end };
    Ok((json, start..start + length))
}

/// Returns the content of the first chunk and the bytes after this chunk. Fails if the chunk is not
/// of the type `kind`. `name` is the type's name in errors.
fn chunk<'a>(bytes: &'a [u8], name: &str, kind: [u8; 4]) -> Result<(&'a [u8], &'a [u8]), String> {
    let Some(length) = number(bytes, 0) else {
        return Err(format!("file must have a {name} chunk, got none"));
    };
    if bytes.get(4..8) != Some(&kind) {
        return Err(format!("first chunk must be of the type {name}"));
    }
    let content = bytes.get(8..).unwrap_or_default();
    content.split_at_checked(length as usize).ok_or_else(|| {
        let size = content.len();
        format!("{name} chunk must have {length} bytes, as its header says, got {size}")
    })
}

/// The little-endian number of 4 bytes that begins at byte `at`; `None` if the bytes end earlier.
fn number(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}
