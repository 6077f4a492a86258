use ::gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use ::gltf::json::buffer::{Target, View};
use ::gltf::json::validation::Checked::Valid;
use ::gltf::json::{Accessor, Extras, Index, Root, Value};

/// A file in progress: its JSON, and the bytes of its buffer.
#[derive(Default)]
pub struct GltfWriter {
    pub root: Root,
    pub bytes: Vec<u8>,
}

/// Component type and shape of an accessor.
#[derive(Clone, Copy)]
pub struct AccessorKind {
    pub component: ComponentType,
    pub shape: Type,
}

impl AccessorKind {
    pub const NUMBER: Self = Self { component: ComponentType::F32, shape: Type::Scalar };
    pub const POINT: Self = Self { component: ComponentType::F32, shape: Type::Vec3 };
    pub const COORDINATES: Self = Self { component: ComponentType::F32, shape: Type::Vec2 };
    pub const QUATERNION: Self = Self { component: ComponentType::F32, shape: Type::Vec4 };
    pub const MATRIX: Self = Self { component: ComponentType::F32, shape: Type::Mat4 };
    pub const JOINTS: Self = Self { component: ComponentType::U16, shape: Type::Vec4 };
    pub const WEIGHTS: Self = Self { component: ComponentType::F32, shape: Type::Vec4 };
    pub const INDEX: Self = Self { component: ComponentType::U32, shape: Type::Scalar };
}

impl GltfWriter {
    /// Adds a view of the bytes from `start` to the end of the buffer.
    pub fn view(&mut self, start: usize, target: Option<Target>) -> Index<View> {
        let view = View {
            buffer: Index::new(0),
            byte_length: (self.bytes.len() - start).into(),
            byte_offset: Some(start.into()),
            byte_stride: None,
            name: None,
            target: target.map(Valid),
            extensions: None,
            extras: Extras::default(),
        };
        self.root.push(view)
    }

    /// Adds an accessor of `count` values, the first of which is at byte `offset` of a view.
    pub fn accessor(
        &mut self,
        view: Index<View>,
        offset: usize,
        count: usize,
        kind: AccessorKind,
    ) -> Index<Accessor> {
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: Some(offset.into()),
            count: count.into(),
            component_type: Valid(GenericComponentType(kind.component)),
            type_: Valid(kind.shape),
            min: None,
            max: None,
            name: None,
            normalized: kind.component == ComponentType::U8,
            sparse: None,
            extensions: None,
            extras: Extras::default(),
        })
    }

    /// Appends `bytes` to the buffer, and adds a view and an accessor for them. The number of bytes
    /// must be a multiple of 4.
    pub fn array(
        &mut self,
        bytes: impl Iterator<Item = u8>,
        target: Option<Target>,
        count: usize,
        kind: AccessorKind,
    ) -> Index<Accessor> {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let view = self.view(start, target);
        self.accessor(view, 0, count, kind)
    }

    /// Like [`Self::array`] for rows of floats, with their minimum and maximum in the accessor.
    pub fn bounded<const N: usize>(
        &mut self,
        rows: &[[f32; N]],
        target: Option<Target>,
        kind: AccessorKind,
    ) -> Index<Accessor> {
        let accessor = self.array(floats(rows), target, rows.len(), kind);
        let bound = |of: fn(f32, f32) -> f32, from: f32| -> Value {
            let bounds = rows.iter().fold([from; N], |bounds, row| {
                std::array::from_fn(|number| of(bounds[number], row[number]))
            });
            bounds.into_iter().collect()
        };
        if let Some(accessor) = self.root.accessors.get_mut(accessor.value()) {
            accessor.min = Some(bound(f32::min, f32::INFINITY));
            accessor.max = Some(bound(f32::max, f32::NEG_INFINITY));
        }
        accessor
    }
}

/// Little-endian bytes of floats.
pub fn floats<const N: usize>(rows: &[[f32; N]]) -> impl Iterator<Item = u8> + '_ {
    rows.iter().flatten().flat_map(|number| number.to_le_bytes())
}
