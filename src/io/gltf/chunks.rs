//! The container of a `.glb` file: a header of 12 bytes, then chunks, each with a length, a type
//! and its bytes. The first chunk is JSON, the second binary.

/// The first bytes of a binary glTF file.
pub const MAGIC: &[u8] = b"glTF";

/// The chunks of a `.glb` file.
pub struct Chunks {
    pub json: String,
    /// Empty without a binary chunk.
    pub binary: Vec<u8>,
}

/// Splits a file into its chunks. The error is a reason.
pub fn split(bytes: &[u8]) -> Result<Chunks, String> {
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
    let (json, rest) = chunk(bytes.get(12..).unwrap_or_default(), "JSON", *b"JSON")?;
    let json = String::from_utf8(json.to_vec())
        .map_err(|error| format!("JSON chunk must be UTF-8: {}", error.utf8_error()))?;
    let is_binary = rest.get(4..8) == Some(b"BIN\0");
    let binary = if is_binary { chunk(rest, "binary", *b"BIN\0")?.0.to_vec() } else { Vec::new() };
    Ok(Chunks { json, binary })
}

/// The bytes of the first chunk, and the rest.
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

/// The little-endian number at a byte.
fn number(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}
