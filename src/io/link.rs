//! Links that carry a scene, such as `#example=walk&time=0.6`, `#tour=4` or `#document=…`.
//!
//! What stands after the `#` never leaves the browser. A document is JSON, compressed by zlib, in the
//! letters of base64 for addresses.

use std::io::{Read as _, Write as _};

use base64::Engine as _;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use thiserror::Error;

use super::error::OpenError;
use super::examples::Example;
use super::open::parse;
use super::opened::OpenOptions;
use super::to_json;
use crate::document::{Document, Timeline};

/// What a link opens.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Link {
    /// The scene; `None` for the arm.
    pub scene: Option<LinkScene>,
    /// Time of the playhead in seconds.
    pub time: Option<f64>,
    /// Step of the tour, counted from 1.
    pub tour: Option<u16>,
}

/// The scene of a link.
#[derive(Clone, Debug, PartialEq)]
pub enum LinkScene {
    /// A built-in example.
    Example(Example),
    /// The document that the link itself carries.
    Document(Box<Document>),
}

/// Reasons why a link cannot be opened or made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LinkError {
    /// A part of the link has no such value.
    #[error("the link's `{part}` must be {rule}, got {got:?}")]
    Part {
        /// Name of the part.
        part: &'static str,
        /// What would be right.
        rule: String,
        /// The value of the link.
        got: String,
    },
    /// The link has a part that no link has.
    #[error("a link must have the parts example, document, time and tour, got {0:?}")]
    Unknown(String),
    /// The link's document is invalid.
    #[error("the link's document cannot be opened: {0}")]
    Document(#[from] OpenError),
    /// The document is too large for a link.
    #[error(
        "a link holds {} kB, and this document needs {needed} kB; save it as a file instead",
        Link::MAX_BYTES >> 10
    )]
    TooLarge {
        /// Size of the link in kB.
        needed: usize,
    },
    /// The document cannot be written.
    #[error(transparent)]
    Save(#[from] serde_json::Error),
}

impl Link {
    /// Maximum length of a link after the `#`, in bytes.
    pub const MAX_BYTES: usize = 8 << 10;
    /// Maximum size of a link's document as JSON, in bytes.
    const MAX_JSON: u64 = 1 << 20;

    /// Parses a link: a whole address, or what stands after its `#`. An address without `#` opens
    /// the arm.
    ///
    /// # Errors
    ///
    /// If the link is longer than [`Self::MAX_BYTES`], or a part of it is unknown or invalid.
    pub fn parse(text: &str) -> Result<Self, LinkError> {
        let parts = match text.split_once('#') {
            Some((_, parts)) => parts,
            None if text.contains("://") => "",
            None => text,
        };
        if parts.len() > Self::MAX_BYTES {
            return Err(LinkError::TooLarge { needed: parts.len().div_ceil(1 << 10) });
        }
        let mut link = Self::default();
        for part in parts.split('&').filter(|part| !part.is_empty()) {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            match name {
                "example" => link.scene = Some(LinkScene::Example(example(value)?)),
                "document" => {
                    link.scene = Some(LinkScene::Document(Box::new(document(value)?)));
                }
                "time" => link.time = Some(time(value)?),
                "tour" => link.tour = Some(tour(value)?),
                other => return Err(LinkError::Unknown(shortened(other))),
            }
        }
        Ok(link)
    }

    /// The parts of a link that carries a document, to stand after the `#` of an address.
    ///
    /// # Errors
    ///
    /// If the document needs more than [`Self::MAX_BYTES`].
    pub fn to(document: &Document) -> Result<String, LinkError> {
        let json = to_json(document)?;
        // Written to memory, which does not fail.
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
        let compressed = encoder.write_all(json.as_bytes()).and_then(|()| encoder.finish());
        let bytes = compressed.unwrap_or_default();
        let link = format!("document={}", BASE64_URL_SAFE_NO_PAD.encode(bytes));
        if link.len() > Self::MAX_BYTES {
            return Err(LinkError::TooLarge { needed: link.len().div_ceil(1 << 10) });
        }
        Ok(link)
    }
}

fn example(name: &str) -> Result<Example, LinkError> {
    Example::find(name).ok_or_else(|| LinkError::Part {
        part: "example",
        rule: "the name of an example".to_owned(),
        got: shortened(name),
    })
}

fn document(value: &str) -> Result<Document, LinkError> {
    let invalid = |rule: &str| LinkError::Part {
        part: "document",
        rule: rule.to_owned(),
        got: shortened(value),
    };
    let bytes = BASE64_URL_SAFE_NO_PAD
        .decode(value)
        .map_err(|_| invalid("base64 with the letters of addresses"))?;
    let mut json = String::new();
    let mut decoder = ZlibDecoder::new(&bytes[..]).take(Link::MAX_JSON + 1);
    decoder.read_to_string(&mut json).map_err(|_| invalid("a text compressed by zlib"))?;
    if json.len() as u64 > Link::MAX_JSON {
        return Err(invalid("at most 1 MB when it is unpacked"));
    }
    Ok(parse("the link", &json, &OpenOptions::default())?.document)
}

fn time(value: &str) -> Result<f64, LinkError> {
    let time = value.parse().ok().filter(|time: &f64| time.abs() <= Timeline::MAX_TIME);
    time.ok_or_else(|| LinkError::Part {
        part: "time",
        rule: "a time in seconds".to_owned(),
        got: shortened(value),
    })
}

fn tour(value: &str) -> Result<u16, LinkError> {
    value.parse().ok().filter(|step| *step > 0).ok_or_else(|| LinkError::Part {
        part: "tour",
        rule: "the number of a step, from 1".to_owned(),
        got: shortened(value),
    })
}

/// The start of a value, for sentences.
fn shortened(value: &str) -> String {
    const MOST: usize = 40;
    match value.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_names_an_example_a_time_and_a_step_of_the_tour() {
        let link = Link::parse("https://somewhere.org/arm/#example=walk&time=0.6").expect("valid");
        assert_eq!(link.scene, Example::find("walk").map(LinkScene::Example));
        assert_eq!((link.time, link.tour), (Some(0.6), None));
        assert_eq!(Link::parse("#tour=4").expect("valid").tour, Some(4));
        assert_eq!(Link::parse("https://somewhere.org/").expect("valid"), Link::default());
    }

    #[test]
    fn every_example_that_fits_comes_back_from_its_link() {
        let mut fitting = 0;
        for example in Example::ALL {
            let document = example.open().expect("valid").document;
            let Ok(link) = Link::to(&document) else { continue };
            fitting += 1;
            assert!(link.len() <= Link::MAX_BYTES && link.is_ascii());
            let again = Link::parse(&format!("ik-arm:#{link}")).expect("its own link");
            assert_eq!(
                again.scene,
                Some(LinkScene::Document(Box::new(document))),
                "{}",
                example.name
            );
        }
        assert!(fitting > 20, "{fitting}");
    }

    #[test]
    fn an_invalid_link_is_refused_with_its_part() {
        let error = |text: &str| Link::parse(text).expect_err("invalid").to_string();
        assert_eq!(
            error("#example=wolk"),
            "the link's `example` must be the name of an example, got \"wolk\""
        );
        assert_eq!(
            error("#time=soon"),
            "the link's `time` must be a time in seconds, got \"soon\""
        );
        assert_eq!(
            error("#tour=0"),
            "the link's `tour` must be the number of a step, from 1, got \"0\""
        );
        assert_eq!(
            error("#size=3"),
            "a link must have the parts example, document, time and tour, got \"size\""
        );
        assert!(error("#document=%%").contains("base64"));
        assert!(error("#document=AAAA").contains("compressed by zlib"));
        assert!(error(&format!("#document={}", "A".repeat(9000))).starts_with("a link holds 8 kB"));
    }

    #[test]
    fn a_document_that_unpacks_to_more_than_a_megabyte_is_refused() {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
        for _ in 0..2000 {
            encoder.write_all(&[b' '; 1000]).expect("memory");
        }
        let bytes = encoder.finish().expect("memory");
        let link = format!("#document={}", BASE64_URL_SAFE_NO_PAD.encode(bytes));
        let error = Link::parse(&link).expect_err("too large").to_string();
        assert!(error.contains("at most 1 MB"), "{error}");
    }
}
