//! Base64 (RFC 4648). Text is read with or without its padding.

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

const ENGINE: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Decodes a text. The error is the reason why that is impossible.
pub fn decode(text: &str) -> Result<Vec<u8>, String> {
    ENGINE.decode(text).map_err(|error| format!("data must be base64: {error}"))
}

/// Encodes bytes, with padding.
pub fn encode(bytes: &[u8]) -> String {
    ENGINE.encode(bytes)
}
