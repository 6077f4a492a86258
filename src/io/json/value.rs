//! Values in JSON files: objects, finite numbers, arrays of numbers. Errors say what was expected.
//! A number with a rule is checked while it is read, where the parser knows the path of its field.

use std::fmt;
use std::io::{self, Write};
use std::marker::PhantomData;

use glam::Vec3;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error as _, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::ser::{SerializeSeq as _, Serializer};
use serde::{Deserialize, Serialize};
use serde_json::ser::Formatter;

/// An object. Without this wrapper, serde's derived code would accept an array, too.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct JsonObject<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for JsonObject<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct JsonObjectVisitor<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for JsonObjectVisitor<T> {
            type Value = JsonObject<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object: {…}")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<JsonObject<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(JsonObject)
            }
        }

        deserializer.deserialize_map(JsonObjectVisitor(PhantomData))
    }
}

/// A finite f32. The parser refuses numbers that overflow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JsonNumber(pub f32);

impl<'de> Deserialize<'de> for JsonNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct JsonNumberVisitor;

        impl Visitor<'_> for JsonNumberVisitor {
            type Value = JsonNumber;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number")
            }

            fn visit_f64<E>(self, value: f64) -> Result<JsonNumber, E> {
                Ok(JsonNumber(value as f32))
            }

            fn visit_u64<E>(self, value: u64) -> Result<JsonNumber, E> {
                Ok(JsonNumber(value as f32))
            }

            fn visit_i64<E>(self, value: i64) -> Result<JsonNumber, E> {
                Ok(JsonNumber(value as f32))
            }
        }

        // Parses to f32 directly: by way of f64, a decimal would be rounded twice.
        deserializer.deserialize_f32(JsonNumberVisitor)
    }
}

impl Serialize for JsonNumber {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        check_finite(self.0.into())?;
        serializer.serialize_f32(self.0)
    }
}

fn check_finite<E: serde::ser::Error>(number: f64) -> Result<(), E> {
    if number.is_finite() {
        return Ok(());
    }
    Err(E::custom(format!("number must be finite, got {number}")))
}

/// A number with a rule: its type, the rule in words, and the rule.
macro_rules! number_with_rule {
    ($(#[$doc:meta])* $name:ident, $words:literal, $rule:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Serialize, Deserialize)]
        #[serde(try_from = "JsonNumber", into = "JsonNumber")]
        pub struct $name(f32);

        impl TryFrom<JsonNumber> for $name {
            type Error = String;

            fn try_from(JsonNumber(value): JsonNumber) -> Result<Self, String> {
                let holds: fn(f32) -> bool = $rule;
                let error = || format!(concat!("must be ", $words, ", got {}"), value);
                holds(value).then_some(Self(value)).ok_or_else(error)
            }
        }

        impl From<$name> for JsonNumber {
            fn from($name(value): $name) -> Self {
                Self(value)
            }
        }
    };
}

number_with_rule!(
    /// A number above 0.
    Above0,
    "above 0",
    |value| value > 0.0
);
number_with_rule!(
    /// A number of at least 0.
    AtLeast0,
    "0 or more",
    |value| value >= 0.0
);
number_with_rule!(
    /// A number from 0 to 1.
    Fraction,
    "from 0 to 1",
    |value| (0.0..=1.0).contains(&value)
);

/// A time in seconds: a finite f64, because f32 is too coarse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub struct JsonSeconds(pub f64);

impl Serialize for JsonSeconds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        check_finite(self.0)?;
        serializer.serialize_f64(self.0)
    }
}

/// A key: its time and its numbers, as one array.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyRow {
    pub time: JsonSeconds,
    pub values: Vec<JsonNumber>,
}

impl<'de> Deserialize<'de> for KeyRow {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeyRowVisitor;

        impl<'de> Visitor<'de> for KeyRowVisitor {
            type Value = KeyRow;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a time and the value at it: [seconds, x, …]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut row: A) -> Result<KeyRow, A::Error> {
                let time = row.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
                let mut values = Vec::with_capacity(3);
                while let Some(number) = row.next_element()? {
                    values.push(number);
                }
                Ok(KeyRow { time, values })
            }
        }

        deserializer.deserialize_seq(KeyRowVisitor)
    }
}

impl Serialize for KeyRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut row = serializer.serialize_seq(Some(1 + self.values.len()))?;
        row.serialize_element(&self.time)?;
        self.values.iter().try_for_each(|number| row.serialize_element(number))?;
        row.end()
    }
}

/// An array of `N` numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JsonNumbers<const N: usize>(pub [f32; N]);

impl<'de, const N: usize> Deserialize<'de> for JsonNumbers<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct JsonNumbersVisitor<const N: usize>;

        impl<'de, const N: usize> Visitor<'de> for JsonNumbersVisitor<N> {
            type Value = JsonNumbers<N>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match N {
                    2 => f.write_str("two numbers: [a, b]"),
                    3 => f.write_str("three numbers: [x, y, z]"),
                    4 => f.write_str("four numbers: [x, y, z, w]"),
                    _ => write!(f, "{N} numbers: […]"),
                }
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut row: A) -> Result<JsonNumbers<N>, A::Error> {
                let mut numbers = [0.0; N];
                let mut found = 0;
                while let Some(JsonNumber(number)) = row.next_element()? {
                    if let Some(slot) = numbers.get_mut(found) {
                        *slot = number;
                    }
                    found += 1;
                }
                if found != N {
                    let s = if found == 1 { "" } else { "s" };
                    let expected: &dyn serde::de::Expected = &self;
                    let expected = expected.to_string().replace(" numbers:", ":");
                    let error = format!("found {found} number{s}, expected {expected}");
                    return Err(A::Error::custom(error));
                }
                Ok(JsonNumbers(numbers))
            }
        }

        deserializer.deserialize_seq(JsonNumbersVisitor)
    }
}

impl<const N: usize> Serialize for JsonNumbers<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.map(JsonNumber))
    }
}

/// An array of three numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JsonPoint(pub Vec3);

impl<'de> Deserialize<'de> for JsonPoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        JsonNumbers::deserialize(deserializer)
            .map(|JsonNumbers(point)| Self(Vec3::from_array(point)))
    }
}

impl Serialize for JsonPoint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        JsonNumbers(self.0.to_array()).serialize(serializer)
    }
}

/// A whole number from 0 to 4294967295.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Whole(pub u32);

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WholeVisitor;

        impl Visitor<'_> for WholeVisitor {
            type Value = Whole;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a whole number from 0 to 4294967295")
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Whole, E> {
                let whole = u32::try_from(value).map(Whole);
                whole.map_err(|_| E::invalid_value(Unexpected::Unsigned(value), &self))
            }
        }

        deserializer.deserialize_u32(WholeVisitor)
    }
}

/// Conversions between values and the types that stand for them in files.
macro_rules! stands_for {
    ($($file:ident: $value:ty),*) => {$(
        impl From<$value> for $file {
            fn from(value: $value) -> Self {
                Self(value)
            }
        }

        impl From<$file> for $value {
            fn from($file(value): $file) -> Self {
                value
            }
        }
    )*};
}

stands_for!(JsonNumber: f32, Above0: f32, AtLeast0: f32, Fraction: f32, JsonPoint: Vec3, JsonSeconds: f64, Whole: u32);

/// The value in a file, or `default` if the file has none.
pub fn value_or<T>(file: Option<impl Into<T>>, default: T) -> T {
    file.map_or(default, Into::into)
}

/// Serializes a value as JSON that is easy to read: each field on its own line, each array of
/// numbers on one line.
pub fn to_styled_json(value: &impl Serialize) -> Result<String, serde_json::Error> {
    let mut bytes = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, JsonStyle::default());
    value.serialize(&mut serializer)?;
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(|error| serde::ser::Error::custom(error.to_string()))
}

#[derive(Default)]
struct JsonStyle {
    depth: usize,
}

impl JsonStyle {
    fn line<W: ?Sized + Write>(&self, writer: &mut W) -> io::Result<()> {
        write!(writer, "\n{:1$}", "", 2 * self.depth)
    }
}

impl Formatter for JsonStyle {
    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { out.write_all(b", ") }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth += 1;
        out.write_all(b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth -= 1;
        self.line(out)?;
        out.write_all(b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        if !first {
            out.write_all(b",")?;
        }
        self.line(out)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }
}
