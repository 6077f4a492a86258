use std::borrow::Cow;

use super::buffers::GltfBuffers;
use crate::io::error::OpenError;
use crate::io::formats::gltf::file::{
    Component, GltfAccessor, GltfBufferView, GltfFile, GltfSparse, index_rule,
};
use crate::io::json::{FieldError, JsonObject, JsonPath, Whole};

/// The numbers of an accessor, row by row. All rows are within the bytes.
pub struct AccessorRows<'a> {
    bytes: Cow<'a, [u8]>,
    /// Bytes from one row to the next.
    stride: usize,
    count: usize,
    component: Component,
    is_normalized: bool,
}

pub fn at_accessor(index: usize) -> JsonPath {
    JsonPath::root().key("accessors").index(index)
}

fn at_view(index: usize) -> JsonPath {
    JsonPath::root().key("bufferViews").index(index)
}

/// Finds the accessor `index`. Without a buffer view, its numbers are 0.
pub fn find_accessor<'a>(
    file: &'a GltfFile<'_>,
    index: usize,
) -> Result<&'a GltfAccessor, FieldError> {
    file.accessors.0.get(index).ok_or_else(|| {
        let reason = index_rule("accessors", file.accessors.0.len(), index);
        FieldError::new(at_accessor(index), reason)
    })
}

/// Returns the indices of the buffers that contain the accessor `index`.
pub fn buffers_of(file: &GltfFile<'_>, index: usize) -> Result<Vec<usize>, FieldError> {
    let GltfAccessor { view, sparse, .. } = find_accessor(file, index)?;
    let at = at_accessor(index);
    let mut views: Vec<(usize, JsonPath)> = Vec::new();
    views.extend(view.map(|view| (view.0 as usize, at.clone().key("bufferView"))));
    if let Some(JsonObject(GltfSparse { indices, values, .. })) = sparse {
        let at = at.key("sparse");
        let at_indices = at.clone().key("indices").key("bufferView");
        views.push((indices.0.view.0 as usize, at_indices));
        views.push((values.0.view.0 as usize, at.key("values").key("bufferView")));
    }
    views.into_iter().map(|(view, at)| buffer_of_view(file, view, at)).collect()
}

/// Returns the index of the buffer that contains a view. `at` is the path of the view's index.
pub fn buffer_of_view(file: &GltfFile<'_>, view: usize, at: JsonPath) -> Result<usize, FieldError> {
    let found =
        file.views.0.get(view).ok_or_else(|| {
            FieldError::new(at, index_rule("buffer views", file.views.0.len(), view))
        })?;
    let buffer = found.buffer.0 as usize;
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
        file: &GltfFile<'_>,
        buffers: &'a GltfBuffers<'_>,
        index: usize,
        shape: &str,
    ) -> Result<Self, FieldError> {
        let accessor = find_accessor(file, index)?;
        let at = || at_accessor(index);
        let component = Component::new(accessor.component).ok_or_else(|| {
            let code = accessor.component.0;
            let reason = format!("must be 5120 to 5123, 5125 or 5126, got {code}");
            FieldError::new(at().key("componentType"), reason)
        })?;
        if accessor.shape != shape {
            let reason = format!("must be {shape:?}, got {:?}", accessor.shape);
            return Err(FieldError::new(at().key("type"), reason));
        }
        let row = width(shape) * component.size();
        let count = accessor.count.0 as usize;
        let (mut bytes, mut stride) = match accessor.view {
            Some(view) => {
                let offset = accessor.offset.map_or(0, |offset| offset.0 as usize);
                let view = view.0 as usize;
                let RowBlock { bytes, stride } =
                    RowBlock::new(file, buffers, view, offset, (count, row), &at())?;
                (Cow::Borrowed(bytes), stride)
            }
            None if count.saturating_mul(row) as u64 > OpenError::MAX_BYTES => {
                let max = OpenError::MAX_BYTES as usize / row;
                let reason = format!("must be at most {max} without a buffer view, got {count}");
                return Err(FieldError::new(at().key("count"), reason));
            }
            None => (Cow::Owned(vec![0; count * row]), row),
        };
        if let Some(JsonObject(sparse)) = &accessor.sparse {
            let mut dense = tight(&bytes, stride, (count, row));
            overwrite(&mut dense, file, buffers, sparse, (count, row), &at().key("sparse"))?;
            (bytes, stride) = (Cow::Owned(dense), row);
        }
        let is_normalized = accessor.normalized.unwrap_or(false);
        Ok(Self { bytes, stride, count, component, is_normalized })
    }

    /// Rows of `width` numbers each.
    pub fn of_floats(numbers: &[f32], width: usize) -> AccessorRows<'static> {
        let component = Component::F32;
        AccessorRows {
            bytes: numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            stride: width * component.size(),
            count: numbers.len() / width,
            component,
            is_normalized: false,
        }
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns whether the numbers are floats, rather than integers.
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
        let value = self.component.number(bytes);
        match self.component.largest() {
            Some(largest) if self.is_normalized => (value / largest).max(-1.0),
            _ => value,
        }
    }
}

/// Count of numbers in a row of this type.
pub fn width(shape: &str) -> usize {
    match shape {
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => 1,
    }
}

/// Rows within a buffer view.
struct RowBlock<'a> {
    /// From the first row to the end of the last one.
    bytes: &'a [u8],
    /// Bytes from one row to the next.
    stride: usize,
}

impl<'a> RowBlock<'a> {
    /// Finds `count` rows of `row` bytes that begin at byte `offset` of the view `index`. `at` is
    /// the path of what has these rows.
    fn new(
        file: &GltfFile<'_>,
        buffers: &'a GltfBuffers<'_>,
        index: usize,
        offset: usize,
        (count, row): (usize, usize),
        at: &JsonPath,
    ) -> Result<Self, FieldError> {
        let bytes = view_bytes(file, buffers, index, at)?;
        let stride = file.views.0.get(index).map_or(Ok(row), |view| stride(view, index, row))?;
        let end = match count.checked_sub(1) {
            Some(last) => last.checked_mul(stride).and_then(|n| n.checked_add(row)),
            None => Some(0),
        };
        let rows = end
            .and_then(|end| Some(offset..end.checked_add(offset)?))
            .and_then(|range| bytes.get(range));
        let rows = rows.ok_or_else(|| {
            let reason = format!(
                "must fit into the {} bytes of bufferViews[{index}], got {count} of {stride} bytes \
                 each from byte {offset} on",
                bytes.len()
            );
            FieldError::new(at.clone().key("count"), reason)
        })?;
        Ok(Self { bytes: rows, stride })
    }
}

/// Copies `count` rows of `row` bytes so that they follow each other without gaps.
fn tight(bytes: &[u8], stride: usize, (count, row): (usize, usize)) -> Vec<u8> {
    let at = |index: usize| bytes.get(index * stride..index * stride + row).unwrap_or_default();
    (0..count).flat_map(at).copied().collect()
}

/// Overwrites those of `count` rows of `row` bytes that a sparse accessor lists.
fn overwrite(
    dense: &mut [u8],
    file: &GltfFile<'_>,
    buffers: &GltfBuffers<'_>,
    sparse: &GltfSparse,
    (count, row): (usize, usize),
    at: &JsonPath,
) -> Result<(), FieldError> {
    let JsonObject(indices) = &sparse.indices;
    let JsonObject(values) = &sparse.values;
    let listed = sparse.count.0 as usize;
    let at_indices = at.clone().key("indices");
    let component = Component::new(indices.component)
        .filter(|component| matches!(component, Component::U8 | Component::U16 | Component::U32))
        .ok_or_else(|| {
            let reason = format!("must be 5121, 5123 or 5125, got {}", indices.component.0);
            FieldError::new(at_indices.clone().key("componentType"), reason)
        })?;
    let offset = |offset: Option<Whole>| offset.map_or(0, |offset| offset.0 as usize);
    let (view, from) = (indices.view.0 as usize, offset(indices.offset));
    let places = RowBlock::new(file, buffers, view, from, (listed, component.size()), at)?;
    let (view, from) = (values.view.0 as usize, offset(values.offset));
    let rows = RowBlock::new(file, buffers, view, from, (listed, row), at)?;
    for entry in 0..listed {
        let place = &places.bytes[entry * places.stride..][..component.size()];
        let place = component.number(place) as usize;
        if place >= count {
            let reason = format!("must be below {count}, the number of rows, got {place}");
            return Err(FieldError::new(at_indices, reason));
        }
        dense[place * row..][..row].copy_from_slice(&rows.bytes[entry * rows.stride..][..row]);
    }
    Ok(())
}

/// The bytes of a view. Fails if its buffer is too short. `at` is the path of what has the view.
pub fn view_bytes<'a>(
    file: &GltfFile<'_>,
    buffers: &'a GltfBuffers<'_>,
    index: usize,
    at: &JsonPath,
) -> Result<&'a [u8], FieldError> {
    let buffer = buffer_of_view(file, index, at.clone().key("bufferView"))?;
    let bytes = buffers.get(buffer).unwrap_or_default();
    let (offset, length) = file.views.0.get(index).map_or((0, 0), |view| {
        (view.offset.map_or(0, |offset| offset.0 as usize), view.length.0 as usize)
    });
    offset.checked_add(length).and_then(|end| bytes.get(offset..end)).ok_or_else(|| {
        let reason = format!(
            "must fit into the {} bytes of buffers[{buffer}], got {length} from byte {offset} on",
            bytes.len()
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
