use core::fmt::Write as _;

use thiserror::Error;

use crate::document::Document;
use crate::io::exported::Exported;
use crate::kinematics::skeleton::is_within_numbers;
use crate::kinematics::skin::{Skinning, TriangleMesh};
use crate::rig::SkinMeshError;

/// The reason why no mesh is exported.
#[derive(Debug, Error, PartialEq)]
pub enum ObjError {
    /// The skeleton has no skin.
    #[error("an .obj holds the skin of a skeleton, and there is none: ik-arm skin makes one")]
    NoSkin,
    /// The skin has no mesh.
    #[error(transparent)]
    Mesh(#[from] SkinMeshError),
    /// A position overflows.
    #[error("vertex {0} must be within ±3.4028235e38")]
    TooFar(usize),
    /// The time is not finite.
    #[error("time must be a finite number of seconds, got {0}")]
    Time(f64),
}

/// The posed mesh of the shown skeleton at a time in seconds as Wavefront OBJ: positions, normals
/// and triangles in world space and in units of the scene, with y up. `None` takes the document's
/// way of blending joints.
///
/// # Errors
///
/// [`ObjError`] if there is no skin or a position overflows.
pub fn to_obj(
    document: &Document,
    time: f64,
    skinning: Option<Skinning>,
) -> Result<Exported, ObjError> {
    if !time.is_finite() {
        return Err(ObjError::Time(time));
    }
    let skin = document.rig.skin.as_ref().ok_or(ObjError::NoSkin)?;
    let skinning = skinning.unwrap_or(skin.skinning);
    let mesh = &skin.mesh()?.mesh;
    let posed = mesh.posed(&mesh.pose(document.at(time).skeleton()), skinning);
    if let Some(vertex) = posed.positions.iter().position(|at| !is_within_numbers(*at)) {
        return Err(ObjError::TooFar(vertex));
    }
    let version = env!("CARGO_PKG_VERSION");
    let header = format!("# ik-arm {version}, {time} s, {skinning}\no skin\n");
    Ok(Exported { bytes: text(header, &posed).into_bytes(), notes: Vec::new() })
}

fn text(mut text: String, mesh: &TriangleMesh) -> String {
    // Writing to a string never fails. Adding 0 turns −0 into 0.
    for at in &mesh.positions {
        let _ = writeln!(text, "v {} {} {}", at.x + 0.0, at.y + 0.0, at.z + 0.0);
    }
    for normal in &mesh.normals {
        let _ = writeln!(text, "vn {} {} {}", normal.x + 0.0, normal.y + 0.0, normal.z + 0.0);
    }
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| corner + 1);
        let _ = writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}");
    }
    text
}
