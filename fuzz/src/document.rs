use ik_arm::document::{Document, Timeline};
use ik_arm::io::{self, BvhUnit, OpenOptions, Progress};
use pollster::block_on;

use super::opened::{is_readable, opened};

/// A document or similar bytes: they are refused with a short message, or the document survives
/// saving and reading, and so do its exports.
pub fn document(data: &[u8]) {
    if let Some(opened) = opened(data, &OpenOptions::default()) {
        export(&short(opened.document));
    }
}

/// A few frames of it.
fn short(document: Document) -> Document {
    const FRAMES: f64 = 3.0;
    let Timeline { start, end, frame_rate } = document.timeline;
    let end = end.min(start + FRAMES / frame_rate);
    Document { timeline: Timeline { start, end, frame_rate }, ..document }
}

fn export(document: &Document) {
    let progress = &Progress::default();
    match block_on(io::glb(document, None, progress)) {
        Ok(bytes) => drop(opened(&bytes, &OpenOptions::default()).expect("glTF of ours is read")),
        Err(error) => is_readable(&error.to_string()),
    }
    for unit in [BvhUnit::Centimetres, BvhUnit::Scene] {
        match block_on(io::to_bvh(document, None, unit, progress)) {
            Ok(bvh) => {
                drop(opened(&bvh.bytes, &OpenOptions::default()).expect("BVH of ours is read"));
            }
            Err(error) => is_readable(&error.to_string()),
        }
    }
    match block_on(io::to_csv(document, None, progress)) {
        Ok(table) => assert!(!String::from_utf8(table.bytes).expect("text").contains("NaN")),
        Err(error) => is_readable(&error.to_string()),
    }
}
