//! Skeletons of files in which z points up.

use super::error::Remark;
use super::formats::FileFormat;
use super::opened::Opened;
use crate::document::RigKind;

/// The axis that points up in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Upwards {
    /// The y axis: nothing is turned.
    Y,
    /// The z axis: the skeleton is turned.
    Z,
    /// The one along which the figure stands: the skeleton is turned if that is z.
    Auto,
}

/// Turns the skeleton if z points up, or remarks that it seems to. In a document of this program, y points
/// up unless the caller knows better.
pub fn turn_up(opened: &mut Opened, format: FileFormat, up: Option<Upwards>) {
    let document = &mut opened.document;
    let is_own = format == FileFormat::Document;
    let is_told = matches!(up, Some(Upwards::Y | Upwards::Z));
    let seems_z = !is_told && !is_own && document.looks_z_up();
    let turns = up == Some(Upwards::Z) || up == Some(Upwards::Auto) && seems_z;
    if turns && document.rig == RigKind::Skeleton {
        document.turn_y_up();
        document.camera = document.framing_camera();
    }
    let reason = match (seems_z, turns) {
        (true, true) => "z points up: turned to y up",
        (true, false) => "z seems to point up: --up z, or Edit → Turn to y up, turns it",
        (false, _) => return,
    };
    let reason = reason.to_owned();
    opened.warnings.push(Remark { line: 0, column: 0, field: String::new(), reason });
}
