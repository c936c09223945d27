//! The header of a PLY file: which elements follow, and how they are stored.

use std::collections::BTreeSet;

use crate::{
    fault::{Fault, FormatError, Place},
    scalar::{ByteOrder, Scalar},
    text::{Lines, excerpt, parse, words},
};

/// What the header says.
#[derive(Debug)]
pub(super) struct Header {
    /// `None` when the numbers are written as text.
    pub(super) byte_order: Option<ByteOrder>,
    /// In the order in which they follow.
    pub(super) elements: Vec<Element>,
}

/// A kind of row, such as a vertex or a face.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    pub(super) place: Place,
}

/// A value of each row.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Single(Scalar),
    List { count: Scalar, item: Scalar },
}

impl Header {
    pub(super) fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|element| element.name == name)
    }
}

impl Property {
    pub(super) fn is_float(&self) -> bool {
        matches!(self.kind, Kind::Single(scalar) if scalar.is_float())
    }
}

impl Element {
    /// Bytes (binary) or characters (text, with separators) a row takes at least.
    pub(super) fn smallest_row(&self, binary: bool) -> usize {
        self.properties
            .iter()
            .map(|property| match property.kind {
                _ if !binary => 2,
                Kind::Single(scalar) | Kind::List { count: scalar, .. } => scalar.size(),
            })
            .sum()
    }
}

/// Reads up to and including `end_header`; `lines` then stands at the first row.
pub(super) fn read(lines: &mut Lines<'_>) -> Result<Header, FormatError> {
    check_magic(lines)?;
    let mut byte_order = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut names = BTreeSet::new();
    while let Some(line) = lines.next_filled() {
        let place = lines.place();
        let bad = |entry, expected| {
            place.error(Fault::BadEntry { entry, found: excerpt(line), expected })
        };
        let line_words: Vec<&[u8]> = words(line).take(6).collect();
        match line_words.as_slice() {
            [b"comment" | b"obj_info", ..] => {}
            [b"format", encoding, _version] => {
                let expected = "ascii, binary_little_endian or binary_big_endian";
                let known = encoded(encoding).ok_or_else(|| bad("the format", expected))?;
                byte_order = Some(known);
            }
            [b"element", name, count] => {
                if !names.insert(*name) {
                    let entry = format!("element {}", excerpt(name));
                    return Err(place.error(Fault::Repeated { entry }));
                }
                let count = parse(count)
                    .ok_or_else(|| bad("an element", "a name and a whole number from 0"))?;
                let name = String::from_utf8_lossy(name).into_owned();
                elements.push(Element { name, count, properties: Vec::new(), place });
            }
            [b"property", kind @ .., name] => {
                let kind = property_kind(kind).ok_or_else(|| {
                    bad("a property", "a type, or list with two types, and a name")
                })?;
                let name = String::from_utf8_lossy(name).into_owned();
                let element = elements.last_mut().ok_or_else(|| {
                    place.error(Fault::MissingEntry { entry: "element before it" })
                })?;
                element.properties.push(Property { name, kind });
            }
            [b"end_header"] => {
                let missing = place.error(Fault::MissingEntry { entry: "format line" });
                return Ok(Header { byte_order: byte_order.ok_or(missing)?, elements });
            }
            _ => {
                let expected = "format, comment, obj_info, element, property or end_header";
                return Err(bad("the header line", expected));
            }
        }
    }
    Err(lines.place().error(Fault::UnexpectedEnd { expected: "end_header" }))
}

fn check_magic(lines: &mut Lines<'_>) -> Result<(), FormatError> {
    match lines.next() {
        Some(b"ply") => Ok(()),
        Some(line) => {
            let (expected, found) = ("a first line of \"ply\"", excerpt(line));
            Err(lines.place().error(Fault::WrongMagic { expected, found }))
        }
        None => Err(Place::Whole.error(Fault::Empty)),
    }
}

/// The byte order of an encoding, which text has none of; `None` for an unknown one.
fn encoded(encoding: &[u8]) -> Option<Option<ByteOrder>> {
    match encoding {
        b"ascii" => Some(None),
        b"binary_little_endian" => Some(Some(ByteOrder::Little)),
        b"binary_big_endian" => Some(Some(ByteOrder::Big)),
        _ => None,
    }
}

fn property_kind(words: &[&[u8]]) -> Option<Kind> {
    match words {
        [single] => scalar(single).map(Kind::Single),
        [b"list", count, item] => {
            let count = scalar(count).filter(|count| !count.is_float())?;
            Some(Kind::List { count, item: scalar(item)? })
        }
        _ => None,
    }
}

fn scalar(name: &[u8]) -> Option<Scalar> {
    Some(match name {
        b"char" | b"int8" => Scalar::I8,
        b"uchar" | b"uint8" => Scalar::U8,
        b"short" | b"int16" => Scalar::I16,
        b"ushort" | b"uint16" => Scalar::U16,
        b"int" | b"int32" => Scalar::I32,
        b"uint" | b"uint32" => Scalar::U32,
        b"float" | b"float32" => Scalar::F32,
        b"double" | b"float64" => Scalar::F64,
        _ => return None,
    })
}
