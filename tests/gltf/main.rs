//! glTF: what is written is what the document shows, and reads back; what is wrong is refused.
#![cfg(feature = "document")]

#[path = "../common/mod.rs"]
mod common;

mod damage;
mod documents;
mod export;
mod glb;
mod import;
mod round_trip;
mod text;
