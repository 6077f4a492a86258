//! The elements of an XML file without its text, since URDF keeps all data in attributes.

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use crate::io::error::OpenError;
use crate::io::source::Source;

/// An error at a byte of the file.
pub struct UrdfError {
    pub at: usize,
    /// Name of the joint or link that it is about, or empty.
    pub name: String,
    pub reason: String,
}

impl UrdfError {
    pub fn new(at: usize, name: &str, reason: impl Into<String>) -> Self {
        Self { at, name: name.to_owned(), reason: reason.into() }
    }

    pub fn of_file(self, source: &Source) -> OpenError {
        let remark = source.remark_about(self.at, &self.name, &self.reason);
        OpenError::Content { file: source.name().to_owned(), remark }
    }
}

/// The elements of a file, parents before children.
pub struct XmlTree {
    elements: Vec<Element>,
}

struct Element {
    name: String,
    attributes: Vec<(String, String)>,
    children: Vec<usize>,
    /// Byte of the file at which the element begins.
    at: usize,
}

/// An element of a file.
#[derive(Clone, Copy)]
pub struct XmlElement<'a> {
    tree: &'a XmlTree,
    index: usize,
}

impl XmlTree {
    /// Maximum number of elements.
    const MOST: usize = 1_000_000;

    /// Reads a file, with elements nested to any depth.
    pub fn parse(text: &str) -> Result<Self, UrdfError> {
        let mut reader = Reader::from_str(text);
        let mut tree = Self { elements: Vec::new() };
        let mut open: Vec<usize> = Vec::new();
        let not_xml = |at: u64, reason: String| {
            UrdfError::new((at as usize).min(text.len()), "", format!("not XML: {reason}"))
        };
        loop {
            let at = reader.buffer_position();
            let event = reader
                .read_event()
                .map_err(|error| not_xml(reader.error_position(), error.to_string()))?;
            match event {
                Event::Start(start) => {
                    let element = tree.add(&start, at, open.last().copied())?;
                    open.push(element);
                }
                Event::Empty(start) => drop(tree.add(&start, at, open.last().copied())?),
                Event::End(_) => drop(open.pop()),
                Event::Eof if open.is_empty() && !tree.elements.is_empty() => return Ok(tree),
                Event::Eof => {
                    let open = open.last().map(|open| tree.elements[*open].name.as_str());
                    let reason = match open {
                        Some(open) => format!("the file ends within {open}"),
                        None => "there is no element".to_owned(),
                    };
                    return Err(not_xml(at, reason));
                }
                _ => {}
            }
        }
    }

    /// Adds an element within another and returns its index.
    fn add(
        &mut self,
        start: &BytesStart<'_>,
        at: u64,
        parent: Option<usize>,
    ) -> Result<usize, UrdfError> {
        let (at, index) = (at as usize, self.elements.len());
        let name = String::from_utf8_lossy(start.name().as_ref()).into_owned();
        let error = |reason: String| UrdfError::new(at, &name, reason);
        if index == Self::MOST {
            return Err(error(format!("a file must have at most {} elements", Self::MOST)));
        }
        let mut attributes = Vec::new();
        for attribute in start.attributes() {
            let attribute = attribute.map_err(|found| error(format!("not XML: {found}")))?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|found| error(format!("not XML: {found}")))?.into_owned();
            attributes.push((String::from_utf8_lossy(attribute.key.as_ref()).into_owned(), value));
        }
        if let Some(parent) = parent {
            self.elements[parent].children.push(index);
        }
        self.elements.push(Element { name, attributes, children: Vec::new(), at });
        Ok(index)
    }

    /// The first element.
    pub fn root(&self) -> XmlElement<'_> {
        XmlElement { tree: self, index: 0 }
    }

    /// All elements in the order of the file.
    pub fn all(&self) -> impl Iterator<Item = XmlElement<'_>> {
        (0..self.elements.len()).map(|index| XmlElement { tree: self, index })
    }
}

impl<'a> XmlElement<'a> {
    fn element(self) -> &'a Element {
        &self.tree.elements[self.index]
    }

    pub fn name(self) -> &'a str {
        &self.element().name
    }

    /// Byte of the file at which the element begins.
    pub fn at(self) -> usize {
        self.element().at
    }

    pub fn attribute(self, name: &str) -> Option<&'a str> {
        let mut attributes = self.element().attributes.iter();
        attributes.find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    /// The elements directly within this one.
    pub fn elements(self) -> impl Iterator<Item = Self> {
        self.element().children.iter().map(move |index| Self { tree: self.tree, index: *index })
    }

    /// The elements of this name directly within this one.
    pub fn children(self, name: &'static str) -> impl Iterator<Item = Self> {
        self.elements().filter(move |child| child.name() == name)
    }

    /// The first of [`XmlElement::children`].
    pub fn child(self, name: &'static str) -> Option<Self> {
        self.children(name).next()
    }
}
