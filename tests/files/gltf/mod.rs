//! glTF: exports match the document and round trip; invalid files are refused.

mod damage;
mod documents;
mod draco;
mod export;
mod glb;
mod import;
mod interpolation;
mod morphs;
#[cfg(feature = "app")]
mod posed;
mod round_trip;
mod skin;
mod stretch;
mod text;
