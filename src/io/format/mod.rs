//! The program's own format: JSON, `"format": "ik-arm"`, `"version": 1`.
//!
//! ```text
//! {
//!   "format": "ik-arm", "version": 1,
//!   "rig": "arm" | "skeleton",                        which one is shown
//!   "arm": {
//!     "cursor" or "pin", "elbow_spin", "root", "upper", "lower",
//!     "facing": { "direction", "heading" },
//!     "swivel": { "reference": "limb" | "pole" | "stereographic" | "transport", "pole",
//!                 "carried": { "direction", "outward" } },
//!     "softening": { "softness", "max_stretch", "min_elbow_angle" },
//!     "weight", "fk": { "shoulder", "bend", "stretch" },
//!     "wrist": { "space": "lower" | "world", "angles", "roll" }
//!   },
//!   "skeleton": {
//!     "joints": [{ "name", "parent", "offset", "axis", "rotation", "frame", "limits": { "x", "y", "z" },
//!                  "locked", "radius" }],
//!     "transform": [12 numbers]
//!   },
//!   "targets": [{ "joint", "home", "weight", "enabled", "motion": { "path", "radius", "period" } }],
//!   "solver": { "method", "iterations", "tolerance", "damping", "step", "root", "iterations_per_frame" },
//!   "slither": { "radius", "amplitude", "waves", "period" },
//!   "keys": [{ "channel", "joint" or "layer", "knots": [[seconds, x, y, z], …] }],
//!   "timeline": { "start", "end", "frame_rate" },
//!   "metres_per_unit": number,
//!   "camera": { "target", "yaw", "pitch", "distance", "orthographic" },
//!   "other_camera": as "camera",                      of the rig that is not shown
//!   "display": ["cursor", "pointer", "inner_limit", "outer_limit", "grid_xy", "grid_xz", "grid_yz",
//!               "ground", "axes", "labels", "shadow", "trail", "onion_skins", "hand", "globe",
//!               "references"]
//! }
//! ```
//!
//! Angles are radians, points `[x, y, z]`. `parent` and `joint` count joints from 0; a parent stands
//! before its children, and a root has none (`null`). A `transform` is a 3×4 matrix, column after
//! column: where the skeleton's x, y and z axes point in the world, then its origin; a `frame` a 3×3
//! matrix likewise. A limit is `[from, to]`.
//!
//! An arm's `cursor` and `pole` are relative to its root; a `pin` is in the world, and the hand stays
//! there when the root moves, and what counts where both are given. `weight` is 1 where the hand leads and 0 where the angles of `fk` do.
//! `elbow_spin` is measured from the `reference`; keys of it likewise, but with `transport` from
//! `stereographic`.
//!
//! Keys are of the channels `hand`, `pin`, `elbow_spin`, `pole`, `root`, `upper`, `lower`, `weight`,
//! `shoulder`, `bend`, `stretch`, `wrist`, `translation`, of a joint's `rotation`, `offset`, `target` and `enabled`, and of a `layer` that is shown or not. A knot has a
//! time in seconds and the value at it: one number or three, as the channel has; switches are 0 or 1.
//! Between knots values are as [`spline`](crate::kinematics::spline) has it. `metres_per_unit` is how
//! long a unit is for other programs; absent, a millimetre for the arm and a metre for a skeleton.
//!
//! Only `format`, `version` and `rig` must be there, a joint's `name`, and a target's `joint` and
//! `home`. What is absent is as at first; an absent `offset` puts a joint on its parent's tip, an
//! absent `camera` shows the whole skeleton. Fields that are not known are remarked on and ignored.

mod arm;
mod check;
mod file;
mod keys;

use std::path::Path;

use serde::Deserialize;

use super::error::{OpenError, SaveError};
use super::json_path::JsonPath;
use super::json_style::laid_out;
use super::open::Opened;
use super::source::{Odd, Source, Wrong};
use super::value::{Object, Whole};
use crate::document::Document;
use file::File;

const NAME: &str = "ik-arm";
const VERSION: u32 = 1;

/// What tells whether the rest can be read.
#[derive(Deserialize)]
struct Header {
    format: String,
    version: Whole,
}

/// Reads a document whose text is there.
pub fn read(source: &Source) -> Result<Opened, OpenError> {
    // Where there is no header, reading all of it says why, and more exactly.
    if let Ok(Object(header)) = source.parse::<Object<Header>>(|_| {}) {
        check_header(&header).map_err(|wrong| source.wrong(&wrong))?;
    }
    let mut odd = Odd::default();
    let Object(file) = source.parse::<Object<File>>(|field| {
        odd.push(field, "no such field is known; it is ignored");
    })?;
    let document = check::document(file, &mut odd).map_err(|wrong| source.wrong(&wrong))?;
    Ok(Opened {
        order: (0..document.skeleton().joints().len()).collect(),
        document,
        warnings: source.remarks(&odd),
        skeletons: Vec::new(),
    })
}

fn check_header(Header { format, version }: &Header) -> Result<(), Wrong> {
    if format != NAME {
        let reason = format!("{format:?} is not a format that is known; it must be {NAME:?}");
        return Err(Wrong::new(JsonPath::root().key("format"), reason));
    }
    let version = version.0;
    if version != VERSION {
        let reason = if version > VERSION {
            format!("version {version} needs a newer ik-arm; this one reads version {VERSION}")
        } else {
            format!("there is no version {version}; it must be {VERSION}")
        };
        return Err(Wrong::new(JsonPath::root().key("version"), reason));
    }
    Ok(())
}

/// The document as a file has it: reading it again gives the same, bit for bit.
///
/// # Errors
///
/// If a number is not finite.
pub fn to_json(document: &Document) -> Result<String, serde_json::Error> {
    laid_out(&File::new(document))
}

/// Writes a document, whole or not at all.
///
/// # Errors
///
/// If the folder or the file cannot be written, or a number is not finite.
pub fn save(document: &Document, path: &Path) -> Result<(), SaveError> {
    Ok(super::write(path, to_json(document)?.as_bytes())?)
}
