//! The header of a PCD file: lines of a keyword and its values, up to DATA.

use std::str::FromStr;

use cloudtouch_geom::{Pose, Vector3};

use crate::{
    fault::{Fault, FormatError, Place},
    scalar::Scalar,
    text::{Lines, excerpt, finite_number, finite_triple, parse, words},
};

/// What the header says.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) fields: Vec<Field>,
    /// Where the FIELDS are, for errors about them.
    pub(super) fields_place: Place,
    pub(super) points: usize,
    /// Where their number is, for errors about it.
    pub(super) points_place: Place,
    pub(super) image_size: Option<(usize, usize)>,
    pub(super) sensor_pose: Option<Pose>,
    pub(super) data: Data,
}

/// One entry of FIELDS with its SIZE, TYPE and COUNT.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    pub(super) count: usize,
}

/// How the points are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Data {
    Ascii,
    Binary,
    BinaryCompressed,
}

/// The entries there can be; COLUMNS is the old name of FIELDS.
const ENTRIES: [&str; 10] = [
    "VERSION",
    "FIELDS",
    "SIZE",
    "TYPE",
    "COUNT",
    "WIDTH",
    "HEIGHT",
    "VIEWPOINT",
    "POINTS",
    "DATA",
];

/// The values of one entry and where it is.
struct Entry<'a> {
    name: &'static str,
    line: usize,
    text: &'a [u8],
}

impl Entry<'_> {
    fn place(&self) -> Place {
        Place::Line(self.line)
    }

    fn bad(&self, found: &[u8], expected: &'static str) -> FormatError {
        Place::Line(self.line).error(Fault::BadEntry {
            entry: self.name,
            found: excerpt(found),
            expected,
        })
    }

    /// Its only value.
    fn single<T: FromStr>(&self, expected: &'static str) -> Result<T, FormatError> {
        parse(self.text).ok_or_else(|| self.bad(self.text, expected))
    }

    /// One value for each field.
    fn per_field<T>(
        &self,
        fields: usize,
        expected: &'static str,
        read: impl Fn(&[u8]) -> Option<T>,
    ) -> Result<Vec<T>, FormatError> {
        let values: Vec<T> = words(self.text)
            .map(|word| read(word).ok_or_else(|| self.bad(word, expected)))
            .collect::<Result<_, _>>()?;
        if values.len() == fields {
            Ok(values)
        } else {
            Err(self.bad(self.text, "one value for each of FIELDS"))
        }
    }
}

struct Entries<'a> {
    found: Vec<Entry<'a>>,
    end: Place,
}

impl<'a> Entries<'a> {
    fn get(&self, name: &str) -> Option<&Entry<'a>> {
        self.found.iter().find(|entry| entry.name == name)
    }

    fn require(&self, name: &'static str) -> Result<&Entry<'a>, FormatError> {
        self.get(name).ok_or_else(|| self.end.error(Fault::MissingEntry { entry: name }))
    }
}

/// Reads up to and including DATA; `lines` then stands at the first byte of the points.
pub(super) fn read(lines: &mut Lines<'_>) -> Result<Header, FormatError> {
    let entries = collect(lines)?;

    let names = entries.require("FIELDS")?;
    let fields = words(names.text).count();
    let positive = "a whole number from 1";
    let size = |word: &[u8]| parse(word).filter(|size| [1, 2, 4, 8].contains(size));
    let sizes = entries.require("SIZE")?.per_field(fields, "1, 2, 4 or 8", size)?;
    let types = entries.require("TYPE")?;
    let letters = types.per_field(fields, "I, U or F", |w| (w.len() == 1).then(|| w[0]))?;
    let counts = match entries.get("COUNT") {
        Some(entry) => {
            entry.per_field(fields, positive, |w| parse::<usize>(w).filter(|&c| c > 0))?
        }
        None => vec![1; fields],
    };
    let fields = words(names.text)
        .zip(letters.into_iter().zip(sizes).zip(counts))
        .map(|(name, ((letter, size), count))| {
            let scalar = scalar(letter, size).ok_or_else(|| {
                types.bad(types.text, "I or U with SIZE 1, 2, 4 or 8, or F with 4 or 8")
            })?;
            Ok(Field { name: String::from_utf8_lossy(name).into_owned(), scalar, count })
        })
        .collect::<Result<_, _>>()?;

    let (points, image_size) = sizes_of_cloud(&entries)?;
    let data = entries.require("DATA")?;
    Ok(Header {
        fields,
        fields_place: Place::Line(names.line),
        points,
        points_place: entries
            .get("POINTS")
            .or(entries.get("WIDTH"))
            .map_or(entries.end, Entry::place),
        image_size,
        sensor_pose: entries.get("VIEWPOINT").map(sensor_pose).transpose()?.filter(is_said),
        data: match data.text {
            b"ascii" => Data::Ascii,
            b"binary" => Data::Binary,
            b"binary_compressed" => Data::BinaryCompressed,
            other => return Err(data.bad(other, "ascii, binary or binary_compressed")),
        },
    })
}

/// The position of the sensor and, as a rule, its rotation as a quaternion w x y z.
fn sensor_pose(viewpoint: &Entry<'_>) -> Result<Pose, FormatError> {
    let origin = Vector3::from(finite_triple(words(viewpoint.text), viewpoint.line)?);
    let turn: Vec<f64> = (4..)
        .zip(words(viewpoint.text).skip(3))
        .map(|(column, word)| finite_number(word, viewpoint.line, column))
        .collect::<Result<_, _>>()?;
    let expected = "a position and a quaternion w x y z of length one";
    match turn[..] {
        [] => Ok(Pose::from_translation(origin)),
        [w, x, y, z] => Pose::try_from_quaternion(origin, [w, x, y, z])
            .map_err(|_| viewpoint.bad(viewpoint.text, expected)),
        _ => {
            let fault = Fault::RowLength { expected: 7, found: 3 + turn.len() };
            Err(viewpoint.place().error(fault))
        }
    }
}

/// The identity is what writers put that do not know.
fn is_said(pose: &Pose) -> bool {
    *pose != Pose::identity()
}

fn collect<'a>(lines: &mut Lines<'a>) -> Result<Entries<'a>, FormatError> {
    let mut found: Vec<Entry<'a>> = Vec::new();
    while let Some(line) = lines.next_filled() {
        let line = line.split(|&b| b == b'#').next().unwrap_or_default();
        let Some(keyword) = words(line).next() else { continue };
        let keyword = if keyword == b"COLUMNS" { b"FIELDS" } else { keyword };
        let Some(&name) = ENTRIES.iter().find(|name| name.as_bytes() == keyword) else {
            if found.is_empty() {
                let expected = "a PCD header (VERSION, FIELDS, ...)";
                let found = excerpt(line);
                return Err(lines.place().error(Fault::WrongMagic { expected, found }));
            }
            // The Point Cloud Library passes over entries it does not know; so do we.
            continue;
        };
        if found.iter().any(|entry| entry.name == name) {
            return Err(lines.place().error(Fault::Repeated { entry: name.to_owned() }));
        }
        let start = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
        found.push(Entry { name, line: lines.number, text: line[start..].trim_ascii() });
        if name == "DATA" {
            return Ok(Entries { found, end: lines.place() });
        }
    }
    if lines.number == 0 {
        return Err(Place::Whole.error(Fault::Empty));
    }
    Err(lines
        .place()
        .error(Fault::UnexpectedEnd { expected: "the rest of the header, up to DATA" }))
}

/// POINTS, and WIDTH and HEIGHT when they make an image of at least two rows and columns.
fn sizes_of_cloud(entries: &Entries<'_>) -> Result<(usize, Option<(usize, usize)>), FormatError> {
    let count = |name| {
        entries.get(name).map(|entry| entry.single::<usize>("a whole number from 0")).transpose()
    };
    let (width, height) = (count("WIDTH")?, count("HEIGHT")?);
    let pixels = width.and_then(|w| w.checked_mul(height.unwrap_or(1)));
    let points = match (count("POINTS")?, pixels) {
        (Some(points), None) if width.is_none() => points,
        (None, Some(pixels)) => pixels,
        (Some(points), Some(pixels)) if points == pixels => points,
        (None, None) => entries.require("POINTS")?.single("a whole number from 0")?,
        (Some(points), _) => {
            let (width, height) = (width.unwrap_or_default(), height.unwrap_or(1));
            let place = entries.require("POINTS")?.place();
            return Err(place.error(Fault::PointCount { points, width, height }));
        }
    };
    let image_size = width.zip(height).filter(|&(w, h)| w > 1 && h > 1);
    Ok((points, image_size))
}

fn scalar(letter: u8, size: usize) -> Option<Scalar> {
    Some(match (letter, size) {
        (b'I', 1) => Scalar::I8,
        (b'I', 2) => Scalar::I16,
        (b'I', 4) => Scalar::I32,
        (b'I', 8) => Scalar::I64,
        (b'U', 1) => Scalar::U8,
        (b'U', 2) => Scalar::U16,
        (b'U', 4) => Scalar::U32,
        (b'U', 8) => Scalar::U64,
        (b'F', 4) => Scalar::F32,
        (b'F', 8) => Scalar::F64,
        _ => return None,
    })
}
