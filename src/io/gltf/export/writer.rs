use ::gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use ::gltf::json::buffer::{Target, View};
use ::gltf::json::validation::Checked::Valid;
use ::gltf::json::{Accessor, Extras, Index, Root, Value};

/// What there is of a file so far: its JSON, and the bytes that this tells of.
#[derive(Default)]
pub struct Writer {
    pub root: Root,
    pub bytes: Vec<u8>,
}

/// What an accessor's numbers are.
#[derive(Clone, Copy)]
pub struct Kind {
    pub component: ComponentType,
    pub shape: Type,
}

impl Kind {
    pub const NUMBER: Self = Self { component: ComponentType::F32, shape: Type::Scalar };
    pub const POINT: Self = Self { component: ComponentType::F32, shape: Type::Vec3 };
    pub const QUATERNION: Self = Self { component: ComponentType::F32, shape: Type::Vec4 };
    pub const MATRIX: Self = Self { component: ComponentType::F32, shape: Type::Mat4 };
    pub const JOINTS: Self = Self { component: ComponentType::U16, shape: Type::Vec4 };
    /// From 0 to 255, which is 1.
    pub const WEIGHTS: Self = Self { component: ComponentType::U8, shape: Type::Vec4 };
    pub const INDEX: Self = Self { component: ComponentType::U32, shape: Type::Scalar };
}

impl Writer {
    /// A view of the bytes that were written since `start`.
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

    /// An accessor of `count` values that begin so many bytes into a view.
    pub fn accessor(
        &mut self,
        view: Index<View>,
        offset: usize,
        count: usize,
        kind: Kind,
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

    /// A view of `bytes`, whose number is a multiple of 4, as all are, and an accessor of it.
    pub fn array(
        &mut self,
        bytes: impl Iterator<Item = u8>,
        target: Option<Target>,
        count: usize,
        kind: Kind,
    ) -> Index<Accessor> {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let view = self.view(start, target);
        self.accessor(view, 0, count, kind)
    }

    /// As [`Self::array`], of rows of floats; the accessor tells between which each of a row is.
    pub fn bounded<const N: usize>(
        &mut self,
        rows: &[[f32; N]],
        target: Option<Target>,
        kind: Kind,
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

/// As a file has them.
pub fn floats<const N: usize>(rows: &[[f32; N]]) -> impl Iterator<Item = u8> + '_ {
    rows.iter().flatten().flat_map(|number| number.to_le_bytes())
}
