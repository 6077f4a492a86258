//! The container of a `.glb` file: a header of 12 bytes, then chunks, each with a length, a type and
//! its bytes. The first chunk is JSON, the second binary.

/// What a binary glTF begins with.
pub const MAGIC: &[u8] = b"glTF";

/// What a `.glb` file has.
pub struct Chunks {
    pub json: String,
    /// Empty where there is none.
    pub binary: Vec<u8>,
}

/// Takes a file apart, or says what is wrong with it.
pub fn split(bytes: &[u8]) -> Result<Chunks, String> {
    let cut = || "the file ends within its first 12 bytes, the header of a .glb file".to_owned();
    let version = number(bytes, 4).ok_or_else(cut)?;
    let length = number(bytes, 8).ok_or_else(cut)? as usize;
    if version != 2 {
        return Err(format!("the file is of glTF {version}; only glTF 2 is known"));
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

/// The bytes of the chunk that stands first, and what comes after it.
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

/// The number of four bytes, the least significant one first.
fn number(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}
