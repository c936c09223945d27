//! Wavefront OBJ meshes: vertices and polygons; everything about looks is passed over.

use std::{
    borrow::Cow,
    io::{self, Write},
    path::Path,
};

use cloudtouch_geom::{Point3, TriangleMesh};

use crate::polygon::Polygons;
use crate::{
    atomic::write_atomically,
    error::WriteError,
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
    text::{Lines, excerpt, finite_triple, parse as parse_number, words},
};

/// Keywords that say nothing about the surface: texture, normals, groups, material, lines.
const PASSED_OVER: [&[u8]; 16] = [
    b"vt",
    b"vn",
    b"vp",
    b"g",
    b"o",
    b"s",
    b"mg",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"l",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
];

/// Keywords before numbers, whose lines a backslash continues; after names and in comments it is one of a path.
const CONTINUED: [&[u8]; 7] = [b"v", b"vt", b"vn", b"vp", b"f", b"l", b"p"];

/// Reads a mesh from the bytes of an OBJ file.
///
/// Faces are `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards from the last vertex
/// when negative; polygons become triangles within their outline. When the first line is nothing
/// but two whole numbers, as some exporters write, they are taken for the counts of vertices and
/// faces and must agree with what follows.
///
/// # Errors
/// When a line begins with a keyword that is not known (free-form surfaces are not read), a
/// coordinate is no finite number, a face has fewer than three corners or names a vertex that is
/// not there, there are no faces, the counts of the first line disagree, or there is more than the
/// default [`ReadLimits`] allow.
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
    let mut lines = Lines::new(bytes);
    let mut vertices: Vec<Point3> = Vec::new();
    let mut faces = Faces::default();
    let (mut counts, mut points) = (None, None);
    while let Some(first) = lines.next_filled() {
        let whole = continued(first, &mut lines);
        let line = whole.split(|&b| b == b'#').next().unwrap_or_default();
        let mut line_words = words(line);
        match line_words.next() {
            None => {}
            Some(b"v") => {
                limits.check_points(vertices.len() + 1, lines.place())?;
                vertices.push(finite_triple(line_words, lines.number)?.into());
            }
            Some(b"f") => {
                faces.push(line_words, vertices.len(), lines.number)?;
                limits.check_triangles(faces.triangles.len(), lines.place())?;
            }
            Some(b"p") => points = points.or_else(|| Some(lines.place())),
            Some(keyword) if PASSED_OVER.contains(&keyword) => {}
            Some(_) if lines.number == 1 && two_counts(line).is_some() => counts = two_counts(line),
            Some(_) => {
                return Err(lines.place().error(Fault::BadEntry {
                    entry: "the line",
                    found: excerpt(line),
                    expected: "v, f or another OBJ keyword of polygon meshes",
                }));
            }
        }
    }
    faces.check(vertices.len())?;
    if let Some(place) = points.filter(|_| !faces.triangles.is_empty() || faces.count > 0) {
        return Err(place.error(Fault::PointsBesideFaces));
    }
    if let Some([promised_vertices, promised_faces]) = counts {
        for (what, promised, found) in [
            ("vertices", promised_vertices, vertices.len()),
            ("faces", promised_faces, faces.count),
        ] {
            if promised != found {
                return Err(Place::Line(1).error(Fault::Count { what, promised, found }));
            }
        }
    }
    faces.polygons.cut(&vertices, &mut faces.triangles);
    TriangleMesh::new(vertices, faces.triangles)
        // Coordinates and indices were checked where they stand; no faces are all that is left.
        .map_err(|_| Place::Line(1).error(Fault::NoTriangles))
}

/// A line together with those that a backslash at its end joins to it; behind a `#` it is one of the comment.
fn continued<'a>(first: &'a [u8], lines: &mut Lines<'a>) -> Cow<'a, [u8]> {
    let goes_on = |line: &'a [u8]| line.strip_suffix(b"\\").filter(|start| !start.contains(&b'#'));
    let is_continued = words(first).next().is_some_and(|keyword| CONTINUED.contains(&keyword));
    let Some(start) = goes_on(first).filter(|_| is_continued) else { return first.into() };
    let mut whole = start.to_vec();
    for line in lines {
        whole.push(b' ');
        whole.extend_from_slice(goes_on(line).unwrap_or(line));
        if goes_on(line).is_none() {
            break;
        }
    }
    whole.into()
}

fn two_counts(line: &[u8]) -> Option<[usize; 2]> {
    let mut counts = words(line).map(parse_number::<usize>);
    match (counts.next(), counts.next(), counts.next()) {
        (Some(Some(vertices)), Some(Some(faces)), None) => Some([vertices, faces]),
        _ => None,
    }
}

#[derive(Default)]
struct Faces {
    triangles: Vec<[u32; 3]>,
    /// Polygons, before they became triangles.
    count: usize,
    polygons: Polygons,
    /// The highest vertex named, from 1, and where: it may be defined further down.
    highest: Option<(u32, Place)>,
}

impl Faces {
    fn push<'a>(
        &mut self,
        corners: impl Iterator<Item = &'a [u8]>,
        vertices: usize,
        line: usize,
    ) -> Result<(), FormatError> {
        let (mut first, mut last) = (0, 0);
        let mut found = 0;
        for word in corners {
            found += 1;
            let place = Place::Column { line, column: found };
            let number = vertex_number(word, vertices, place)?;
            if self.highest.is_none_or(|(highest, _)| number > highest) {
                self.highest = Some((number, place));
            }
            match found {
                1 => first = number - 1,
                2 => {}
                _ => self.triangles.push([first, last, number - 1]),
            }
            last = number - 1;
        }
        if found < 3 {
            let fault = Fault::Corners { found, expected: "at least 3" };
            return Err(Place::Line(line).error(fault));
        }
        self.count += 1;
        self.polygons.push(self.triangles.len() - (found - 2), found - 2);
        Ok(())
    }

    fn check(&self, vertices: usize) -> Result<(), FormatError> {
        match self.highest {
            Some((number, place)) if number as usize > vertices => {
                Err(place.error(Fault::MissingVertex { found: number.to_string(), vertices }))
            }
            _ => Ok(()),
        }
    }
}

/// The vertex a corner names, from 1.
fn vertex_number(word: &[u8], vertices: usize, place: Place) -> Result<u32, FormatError> {
    let index = word.split(|&b| b == b'/').next().unwrap_or_default();
    let missing = || place.error(Fault::MissingVertex { found: excerpt(index), vertices });
    let number: i64 = parse_number(index)
        .ok_or_else(|| place.error(Fault::NotANumber { found: excerpt(word) }))?;
    let from_start = match number {
        1.. => number,
        0 => return Err(missing()),
        _ => i64::try_from(vertices)
            .ok()
            .and_then(|v| v.checked_add(number)?.checked_add(1))
            .unwrap_or(0),
    };
    u32::try_from(from_start).ok().filter(|&n| n > 0).ok_or_else(missing)
}

/// Writes a mesh as an OBJ file in metres, whole or not at all.
///
/// Coordinates are written with as many digits as bring back the same bits, and vertices stay
/// shared, neither of which an STL can do; the same mesh gives the same bytes everywhere.
///
/// # Errors
/// When the file cannot be written.
pub fn write_mesh_obj(path: impl AsRef<Path>, mesh: &TriangleMesh) -> Result<(), WriteError> {
    write_atomically(path, |writer| encode(mesh, writer))
}

fn encode(mesh: &TriangleMesh, writer: &mut dyn Write) -> io::Result<()> {
    for p in mesh.vertices() {
        writeln!(writer, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|i| u64::from(i) + 1)) {
        writeln!(writer, "f {a} {b} {c}")?;
    }
    Ok(())
}
