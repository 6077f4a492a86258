//! Meshes that `KHR_draco_mesh_compression` has compressed.
//!
//! A buffer view has all triangles and vertices of a primitive. The accessors of its attributes tell
//! the types of their numbers, and have no bytes of their own.

use draco_core::{DecodeLimits, DecoderBuffer, FaceIndex, Mesh, MeshDecoder};

use super::buffers::GltfBuffers;
use super::rows::{AccessorRows, view_bytes};
use crate::io::formats::gltf::file::{DRACO, DracoFields, GltfAccessor, GltfFile, GltfPrimitive};
use crate::io::json::{FieldError, JsonPath};
use crate::kinematics::skin::SkinnedMesh;

/// The decoded mesh of a primitive.
pub struct DracoMesh<'a> {
    mesh: Mesh,
    fields: &'a DracoFields,
}

impl<'a> DracoMesh<'a> {
    /// Decodes the mesh of a primitive, which is at `at`; `None` for one that is not compressed.
    pub fn new(
        file: &GltfFile<'_>,
        buffers: &GltfBuffers<'_>,
        primitive: &'a GltfPrimitive,
        at: &JsonPath,
    ) -> Result<Option<Self>, FieldError> {
        const MOST_BYTES: u64 = 1 << 30;
        let Some(fields) = primitive.draco() else { return Ok(None) };
        let at = at.clone().key("extensions").key(DRACO);
        let bytes = view_bytes(file, buffers, fields.view.0 as usize, &at)?;
        let limits = DecodeLimits::default()
            .with_max_points(SkinnedMesh::MOST_VERTICES as u64)
            .with_max_faces(SkinnedMesh::MOST_TRIANGLES as u64)
            .with_max_decoded_bytes(MOST_BYTES);
        let mut mesh = Mesh::new();
        let mut bytes = DecoderBuffer::new(bytes).with_limits(limits);
        let decoded = MeshDecoder::new().decode(&mut bytes, &mut mesh);
        decoded
            .map_err(|error| FieldError::new(at.clone(), format!("cannot be decoded: {error}")))?;
        for (name, id) in &fields.attributes {
            if mesh.attribute_by_unique_id(id.0).is_none() {
                let reason = format!("must be the id of an attribute of the mesh, got {}", id.0);
                return Err(FieldError::new(at.key("attributes").key(name), reason));
            }
        }
        Ok(Some(Self { mesh, fields }))
    }

    /// The rows of an attribute with `width` numbers each; `None` if it is not compressed.
    pub fn rows(
        &self,
        name: &str,
        accessor: &GltfAccessor,
        width: usize,
    ) -> Option<AccessorRows<'static>> {
        let id = self.fields.attributes.get(name)?.0;
        let attribute = self.mesh.attribute_by_unique_id(id)?;
        let mut numbers = attribute.read_f32s(self.mesh.num_points(), width);
        if let Some(largest) = accessor.largest() {
            numbers.iter_mut().for_each(|number| *number = (*number / largest as f32).max(-1.0));
        }
        Some(AccessorRows::of_floats(&numbers, width))
    }

    /// The corners of all triangles.
    pub fn corners(&self) -> Vec<u32> {
        let faces = (0..self.mesh.num_faces()).map(|face| self.mesh.face(FaceIndex(face as u32)));
        faces.flatten().map(|point| point.0).collect()
    }
}
