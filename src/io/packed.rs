//! Numbers as bytes in files: base64 (RFC 4648), read with or without its padding, and lists of
//! little-endian numbers of four bytes. Bytes after the last whole number are left out.

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
