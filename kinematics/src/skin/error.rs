use crate::skeleton::JointId;

/// A skinned mesh whose parts contradict each other.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkinError {
    /// The lists of vertices have different lengths.
    #[error("{list} must have one entry for each of the {vertices} vertices, got {got}")]
    Count {
        /// The list with a different length.
        list: &'static str,
        /// Number of positions.
        vertices: usize,
        /// Length of the list.
        got: usize,
    },
    /// There are too many vertices or triangles.
    #[error("a skin must have at most {most} {list}, got {got}")]
    TooMany {
        /// What there are too many of.
        list: &'static str,
        /// The greatest number.
        most: usize,
        /// The number.
        got: usize,
    },
    /// A triangle has a vertex that does not exist.
    #[error("triangle {triangle} must have vertices below {vertices}, got {got}")]
    Triangle {
        /// Index of the triangle.
        triangle: usize,
        /// Number of vertices.
        vertices: usize,
        /// The vertex that does not exist.
        got: u32,
    },
    /// A vertex follows a joint without an inverse bind transform.
    #[error("vertex {vertex} must follow joints below {joints}, got {}", got.index())]
    Joint {
        /// Index of the vertex.
        vertex: usize,
        /// Number of inverse bind transforms.
        joints: usize,
        /// The joint that does not exist.
        got: JointId,
    },
    /// A position, a normal or a texture coordinate is not finite.
    #[error(
        "positions, normals and texture coordinates must be finite, got {got} at vertex {vertex}"
    )]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
        /// The value.
        got: glam::Vec3,
    },
    /// An inverse bind transform is not finite.
    #[error("the inverse bind transform of joint {} must be finite", joint.index())]
    Bind {
        /// The joint.
        joint: JointId,
    },
}
