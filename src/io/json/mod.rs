//! Values of JSON files, their paths, and errors that name a path.

mod path;
mod style;
mod value;

pub use path::{FieldError, FieldWarnings, JsonPath, byte_at, line_and_column};
pub use style::to_styled_json;
pub use value::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, KeyRow, Seconds, Whole};
