//! Values of JSON files, their paths, and errors that name a path.

mod field_error;
mod path;
mod value;

pub use field_error::{FieldError, FieldWarnings};
pub use path::{JsonPath, byte_at, line_and_column};
pub use value::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, KeyRow, Seconds, Whole};
