//! The container of a `.glb` file: a header of 12 bytes, then chunks, each with a length, a type and
//! its bytes. The first chunk is JSON, the second binary.

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
    let cut = || "the file ends within its first 12 bytes, the header of a .glb file".to_owned();
    let version = number(bytes, 4).ok_or_else(cut)?;
    let length = number(bytes, 8).ok_or_else(cut)? as usize;
    if version != 2 {
        return Err(format!("the glTF version must be 2, got {version}"));
    }
    let Some(bytes) = bytes.get(..length) else {
        let there = bytes.len();
        return Err(format!(
            "its header says that the file has {length} bytes, but it has {there}; it is cut"
        ));
    };
    let (json, rest) = chunk(bytes.get(12..).unwrap_or_default(), "JSON", *b"JSON")?;
    let json = String::from_utf8(json.to_vec())
        .map_err(|error| format!("its JSON is not UTF-8: {}", error.utf8_error()))?;
    let is_binary = rest.get(4..8) == Some(b"BIN\0");
    let binary = if is_binary { chunk(rest, "binary", *b"BIN\0")?.0.to_vec() } else { Vec::new() };
    Ok(Chunks { json, binary })
}

/// The bytes of the first chunk, and the rest.
fn chunk<'a>(bytes: &'a [u8], name: &str, kind: [u8; 4]) -> Result<(&'a [u8], &'a [u8]), String> {
    let Some(length) = number(bytes, 0) else {
        return Err(format!("the file ends where its {name} chunk should be"));
    };
    if bytes.get(4..8) != Some(&kind) {
        return Err(format!("its first chunk is not of the type {name}"));
    }
    let content = bytes.get(8..).unwrap_or_default();
    content.split_at_checked(length as usize).ok_or_else(|| {
        let there = content.len();
        format!("its {name} chunk should have {length} bytes, but only {there} are there")
    })
}

/// A little-endian number.
fn number(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}
