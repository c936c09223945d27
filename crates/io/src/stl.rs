//! STL meshes, ascii and binary.

use cloudtouch_geom::{Point3, TriangleMesh};

use crate::{
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
    scalar::{ByteOrder, Scalar},
    text::{Lines, excerpt, finite_triple, is_padding, words},
};

/// Bytes before the first triangle of a binary file: a free text, then the count.
const HEADER: usize = 84;
/// Bytes of a triangle: normal, three corners, two spare bytes.
const RECORD: usize = 50;

/// How it begins.
const BEGINNING: &str = "\"solid\" or a binary header";
/// How files begin that are of other formats for certain: nearly any bytes are a binary header.
const OTHERS: [&[u8]; 6] = [b"ply\n", b"ply\r", b"# .PCD", b"glTF", b"PK\x03\x04", b"\x89PNG"];

/// Reads a mesh from the bytes of an STL file.
///
/// A file is ascii when its first kilobyte is plain text: binary files may begin with `solid` too,
/// but the count after their 80 bytes of header has a zero byte. So is one with a stray control
/// character that has the keywords of one and not the length of a binary file. Every triangle brings its own
/// three vertices; normals are passed over, as the order of the corners says the same.
///
/// # Errors
/// When the file is cut off or goes on after the triangles it counts, has no triangles, a facet
/// without three corners, a coordinate that is no finite number, or more triangles than the default
/// [`ReadLimits`] allow.
pub fn parse(bytes: &[u8]) -> Result<TriangleMesh, FormatError> {
    parse_within(bytes, &ReadLimits::default())
}

/// As [`parse`], with other limits than the default ones.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(bytes: &[u8], limits: &ReadLimits) -> Result<TriangleMesh, FormatError> {
    if bytes.is_empty() {
        return Err(Place::Whole.error(Fault::Empty));
    }
    if let Some(other) = OTHERS.iter().find(|other| bytes.starts_with(other)) {
        let found = String::from_utf8_lossy(other.trim_ascii_end()).into_owned();
        return Err(Place::Line(1).error(Fault::WrongMagic { expected: BEGINNING, found }));
    }
    let corners = if is_binary(bytes) {
        binary_corners(bytes, limits)?
    } else {
        ascii_corners(bytes, limits)?
    };
    let Ok(count) = u32::try_from(corners.len()) else {
        return Err(Place::Whole.error(Fault::TooManyVertices { found: corners.len() }));
    };
    let triangles = (0..count / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    TriangleMesh::new(corners, triangles)
        // Coordinates were checked where they stand; no triangles are all that is left.
        .map_err(|_| Place::Whole.error(Fault::NoTriangles))
}

/// A binary file has control characters in its first kilobyte, if only a zero byte of its count. So
/// may an ascii file in its name; it has keywords, and not the length that a binary one says it has.
fn is_binary(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1024)];
    let has_control = start.iter().any(|&b| b.is_ascii_control() && !b.is_ascii_whitespace());
    let has_keywords = start.trim_ascii_start().starts_with(b"solid")
        && start.windows(6).any(|word| word == b"vertex");
    let as_counted = || {
        let count = bytes.get(HEADER - 4..HEADER)?;
        let promised = Scalar::U32.read(count, ByteOrder::Little) as usize;
        Some(HEADER + promised.saturating_mul(RECORD) <= bytes.len())
    };
    has_control && !(has_keywords && as_counted() != Some(true))
}

fn binary_corners(bytes: &[u8], limits: &ReadLimits) -> Result<Vec<Point3>, FormatError> {
    let Some((header, body)) = bytes.split_at_checked(HEADER) else {
        let end = Fault::UnexpectedEnd { expected: "the rest of the binary header" };
        return Err(Place::Byte(bytes.len()).error(end));
    };
    let promised = Scalar::U32.read(&header[HEADER - 4..], ByteOrder::Little) as usize;
    let (needed, available) = (promised.saturating_mul(RECORD), body.len());
    if needed > available {
        return Err(Place::Byte(HEADER - 4).error(Fault::TooShort { promised, needed, available }));
    }
    if !is_padding(&body[needed..]) {
        return Err(Place::Byte(HEADER + needed).error(Fault::Leftover { promised }));
    }
    limits.check_triangles(promised, Place::Byte(HEADER - 4))?;
    let mut corners = Vec::with_capacity(3 * promised);
    for (triangle, record) in body[..needed].chunks_exact(RECORD).enumerate() {
        for corner in 1..4 {
            let mut point = Point3::origin();
            for axis in 0..3 {
                let at = 12 * corner + 4 * axis;
                let value = Scalar::F32.read(&record[at..], ByteOrder::Little);
                if !value.is_finite() {
                    let place = Place::Byte(HEADER + triangle * RECORD + at);
                    return Err(place.error(Fault::NotFinite { value }));
                }
                point[axis] = value;
            }
            corners.push(point);
        }
    }
    Ok(corners)
}

fn ascii_corners(bytes: &[u8], limits: &ReadLimits) -> Result<Vec<Point3>, FormatError> {
    let mut lines = Lines::new(bytes);
    let mut corners = Vec::new();
    // How many corners the current facet has so far, and whether a solid is open.
    let (mut facet, mut solid): (Option<usize>, bool) = (None, false);
    while let Some(line) = lines.next_filled() {
        let place = lines.place();
        let mut line_words = words(line);
        let keyword = line_words.next().unwrap_or_default().to_ascii_lowercase();
        match (keyword.as_slice(), facet) {
            (b"solid", None) if !solid => solid = true,
            (_, None) if !solid => {
                let expected = BEGINNING;
                let found = excerpt(line);
                return Err(place.error(Fault::WrongMagic { expected, found }));
            }
            (b"endsolid", None) => solid = false,
            (b"facet", None) => facet = Some(0),
            (b"vertex", Some(count)) => {
                limits.check_triangles(corners.len() / 3 + 1, place)?;
                corners.push(finite_triple(line_words, lines.number)?.into());
                facet = Some(count + 1);
            }
            (b"outer" | b"endloop", Some(_)) => {}
            (b"endfacet", Some(3)) => facet = None,
            (b"endfacet", Some(found)) => {
                return Err(place.error(Fault::Corners { found, expected: "3" }));
            }
            _ => {
                return Err(place.error(Fault::BadEntry {
                    entry: "the line",
                    found: excerpt(line),
                    expected: match facet {
                        Some(_) => "outer loop, vertex, endloop or endfacet",
                        None => "facet or endsolid",
                    },
                }));
            }
        }
    }
    if facet.is_some() || solid {
        return Err(lines.place().error(Fault::UnexpectedEnd { expected: "endsolid" }));
    }
    Ok(corners)
}
