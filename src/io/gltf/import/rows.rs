use super::buffers::GltfBuffers;
use super::file::{GltfAccessor, GltfBufferView, GltfFile, index_rule};
use crate::io::field_error::FieldError;
use crate::io::json_path::JsonPath;

/// The numbers of an accessor, row by row. All rows are within the buffer.
#[derive(Clone, Copy)]
pub struct AccessorRows<'a> {
    bytes: &'a [u8],
    /// Bytes from one row to the next.
    stride: usize,
    count: usize,
    component: Component,
    is_normalized: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn new(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

pub fn at_accessor(index: usize) -> JsonPath {
    JsonPath::root().key("accessors").index(index)
}

fn at_view(index: usize) -> JsonPath {
    JsonPath::root().key("bufferViews").index(index)
}

/// Returns the accessor `index`, its buffer view and the index of the view.
fn find_accessor(
    file: &GltfFile,
    index: usize,
) -> Result<(&GltfAccessor, &GltfBufferView, usize), FieldError> {
    let accessor = file.accessors.0.get(index);
    let accessor = accessor.ok_or_else(|| {
        let reason = index_rule("accessors", file.accessors.0.len(), index);
        FieldError::new(at_accessor(index), reason)
    })?;
    let at = at_accessor(index).key("bufferView");
    let Some(view) = accessor.view.filter(|_| accessor.sparse.is_none()) else {
        let reason = "must have a buffer view and must not be sparse";
        return Err(FieldError::new(at_accessor(index), reason));
    };
    let view_index = view.0 as usize;
    let view = file.views.0.get(view_index).ok_or_else(|| {
        FieldError::new(at, index_rule("buffer views", file.views.0.len(), view_index))
    })?;
    Ok((accessor, view, view_index))
}

/// Returns the index of the buffer that contains the accessor `index`.
pub fn buffer_of(file: &GltfFile, index: usize) -> Result<usize, FieldError> {
    let (_, GltfBufferView { buffer, .. }, view) = find_accessor(file, index)?;
    let buffer = buffer.0 as usize;
    if buffer >= file.buffers.0.len() {
        let reason = index_rule("buffers", file.buffers.0.len(), buffer);
        return Err(FieldError::new(at_view(view).key("buffer"), reason));
    }
    Ok(buffer)
}

impl<'a> AccessorRows<'a> {
    /// Returns the rows of the accessor `index`. Fails if its type is not `shape`, or if its buffer
    /// is too short.
    pub fn new(
        file: &GltfFile,
        buffers: &'a GltfBuffers<'_>,
        index: usize,
        shape: &str,
    ) -> Result<Self, FieldError> {
        let (accessor, view, view_index) = find_accessor(file, index)?;
        let at = || at_accessor(index);
        let component = Component::new(accessor.component.0).ok_or_else(|| {
            let code = accessor.component.0;
            let reason = format!("must be 5120 to 5123, 5125 or 5126, got {code}");
            FieldError::new(at().key("componentType"), reason)
        })?;
        if accessor.shape != shape {
            let reason = format!("must be {shape:?}, got {:?}", accessor.shape);
            return Err(FieldError::new(at().key("type"), reason));
        }
        let row = width(shape) * component.size();
        let view_bytes = view_bytes(buffers, view, view_index)?;
        let stride = stride(view, view_index, row)?;
        let offset = accessor.offset.map_or(0, |offset| offset.0 as usize);
        let count = accessor.count.0 as usize;
        let end = match count.checked_sub(1) {
            Some(last) => last.checked_mul(stride).and_then(|n| n.checked_add(row)),
            None => Some(0),
        };
        let bytes = end
            .and_then(|end| Some(offset..end.checked_add(offset)?))
            .and_then(|range| view_bytes.get(range));
        let bytes = bytes.ok_or_else(|| {
            let reason = format!(
                "must fit into the {} bytes of bufferViews[{view_index}], got {count} of {stride} \
                 bytes each from byte {offset} on",
                view_bytes.len()
            );
            FieldError::new(at().key("count"), reason)
        })?;
        let is_normalized = accessor.normalized.unwrap_or(false);
        Ok(Self { bytes, stride, count, component, is_normalized })
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether the numbers are floats, rather than integers.
    pub fn is_float(&self) -> bool {
        self.component == Component::F32
    }

    pub fn is_normalized(&self) -> bool {
        self.is_normalized && self.component != Component::U32
    }

    /// The first `N` numbers of a row. Numbers beyond the row's width are unspecified.
    pub fn row<const N: usize>(&self, index: usize) -> [f64; N] {
        let size = self.component.size();
        std::array::from_fn(|column| {
            let start = index * self.stride + column * size;
            self.bytes.get(start..start + size).map_or(0.0, |bytes| self.number(bytes))
        })
    }

    fn number(&self, bytes: &[u8]) -> f64 {
        let mut four = [0; 4];
        four.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
        let [a, b, ..] = four;
        let (value, largest) = match self.component {
            Component::I8 => (f64::from(i8::from_le_bytes([a])), 127.0),
            Component::U8 => (f64::from(a), 255.0),
            Component::I16 => (f64::from(i16::from_le_bytes([a, b])), 32767.0),
            Component::U16 => (f64::from(u16::from_le_bytes([a, b])), 65535.0),
            Component::U32 => (f64::from(u32::from_le_bytes(four)), 4_294_967_295.0),
            Component::F32 => return f64::from(f32::from_le_bytes(four)),
        };
        if self.is_normalized { (value / largest).max(-1.0) } else { value }
    }
}

fn width(shape: &str) -> usize {
    match shape {
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 1,
    }
}

/// The bytes of a view. Fails if its buffer is too short.
fn view_bytes<'a>(
    buffers: &'a GltfBuffers<'_>,
    view: &GltfBufferView,
    index: usize,
) -> Result<&'a [u8], FieldError> {
    let buffer = buffers.get(view.buffer.0 as usize).unwrap_or_default();
    let offset = view.offset.map_or(0, |offset| offset.0 as usize);
    let length = view.length.0 as usize;
    offset.checked_add(length).and_then(|end| buffer.get(offset..end)).ok_or_else(|| {
        let reason = format!(
            "must fit into the {} bytes of buffers[{}], got {length} from byte {offset} on",
            buffer.len(),
            view.buffer.0
        );
        FieldError::new(at_view(index).key("byteLength"), reason)
    })
}

fn stride(view: &GltfBufferView, index: usize, row: usize) -> Result<usize, FieldError> {
    let Some(stride) = view.stride else { return Ok(row) };
    let stride = stride.0 as usize;
    if !(4..=252).contains(&stride) || stride < row {
        let reason = format!("must be from 4 to 252 and at least {row}, got {stride}");
        return Err(FieldError::new(at_view(index).key("byteStride"), reason));
    }
    Ok(stride)
}
