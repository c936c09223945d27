//! From the bytes of a PLY file to a cloud or a mesh.

use cloudtouch_geom::{PointCloud, TriangleMesh};

use super::{
    body::Body,
    header::{self, Element, Header, Kind},
};
use crate::polygon::Polygons;
use crate::{
    builder::{CloudBuilder, Row, find_columns},
    fault::{Fault, FormatError, Place},
    geometry::Geometry,
    limits::ReadLimits,
    scalar::Scalar,
    text::{Lines, is_padding},
};

/// Reads a mesh (when there are faces) or a point cloud from the bytes of a PLY file.
///
/// Of the vertices x, y, z are read, and of a cloud also cov_xx, cov_xy, cov_xz, cov_yy, cov_yz,
/// cov_zz (m², all six or none); other properties and elements are passed over. Polygons become
/// triangles within their outline. Points of a cloud may be NaN, vertices of a mesh may not.
///
/// # Errors
/// When the header is malformed, the file is shorter than it promises (found before memory is
/// taken) or goes on, a value is no number, a covariance is none, a vertex of a mesh is not
/// finite, a face names a vertex that is not there, or there is more than the default
/// [`ReadLimits`] allow.
pub fn parse(bytes: &[u8]) -> Result<Geometry, FormatError> {
    parse_within(bytes, &ReadLimits::default())
}

/// As [`parse`], with other limits than the default ones.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(bytes: &[u8], limits: &ReadLimits) -> Result<Geometry, FormatError> {
    let mut lines = Lines::new(bytes);
    let header = header::read(&mut lines)?;
    parse_body(&header, bytes, lines, limits)
}

/// What follows a header.
pub(super) fn parse_body(
    header: &Header,
    bytes: &[u8],
    lines: Lines<'_>,
    limits: &ReadLimits,
) -> Result<Geometry, FormatError> {
    let vertex_element = header
        .element("vertex")
        .ok_or_else(|| lines.place().error(Fault::MissingEntry { entry: "element vertex" }))?;
    if let Some(strips) = header.element("tristrips").filter(|strips| strips.count > 0) {
        return Err(strips.place.error(Fault::BadEntry {
            entry: "an element",
            found: strips.name.clone(),
            expected: "faces instead: export the mesh without triangle strips",
        }));
    }
    let vertices = vertex_element.count;
    let is_mesh = header.element("face").is_some_and(|faces| faces.count > 0);

    let mut body = Body::new(bytes, lines, header.byte_order);
    let mut cloud = PointCloud::default();
    let (mut triangles, mut polygons) = (Vec::new(), Polygons::default());
    // Rows without properties take no bytes: any number of them may be promised.
    let is_read = |e: &&Element| !e.properties.is_empty() || e.name == "vertex";
    for element in header.elements.iter().filter(is_read) {
        check_length(element, &body)?;
        match element.name.as_str() {
            "vertex" => cloud = read_vertices(element, &mut body, is_mesh, limits)?,
            "face" => {
                triangles = read_faces(element, &mut body, vertices, &mut polygons, limits)?;
            }
            _ => skip(element, &mut body)?,
        }
    }
    check_end(header, &body)?;
    if !is_mesh {
        return Ok(Geometry::Cloud(cloud));
    }
    polygons.cut(&cloud.points, &mut triangles);
    TriangleMesh::new(cloud.points, triangles)
        .map(Geometry::Mesh)
        // Coordinates and indices were checked where they stand; no faces are all that is left.
        .map_err(|_| Place::Line(1).error(Fault::NoTriangles))
}

/// Whether the bytes that follow can hold all rows of an element.
fn check_length(element: &Element, body: &Body<'_>) -> Result<(), FormatError> {
    let needed = element.count.saturating_mul(element.smallest_row(true));
    let available = body.unread().len();
    if body.is_binary() && needed > available {
        let promised = element.count;
        return Err(element.place.error(Fault::TooShort { promised, needed, available }));
    }
    Ok(())
}

/// Capacity for the rows of an element that the rest of the file can back.
fn capacity(element: &Element, body: &Body<'_>) -> usize {
    element.count.min(body.unread().len() / element.smallest_row(body.is_binary()).max(1) + 1)
}

fn read_vertices(
    element: &Element,
    body: &mut Body<'_>,
    must_be_finite: bool,
    limits: &ReadLimits,
) -> Result<PointCloud, FormatError> {
    let mut columns = find_columns(element.properties.iter().map(|p| p.name.as_str()))
        .map_err(|fault| element.place.error(fault))?;
    if must_be_finite {
        // A mesh is exact: it has no covariances to check.
        columns.truncate(3);
    }
    let slots: Vec<Option<usize>> = (0..element.properties.len())
        .map(|property| columns.iter().position(|&column| column == property))
        .collect();
    if body.is_binary() {
        limits.check_points(element.count, element.place)?;
    }
    let mut cloud = CloudBuilder::new(&columns, capacity(element, body), limits);
    let mut values: Row = Default::default();
    for row in 0..element.count {
        body.begin_row(row, element.count)?;
        for (property, slot) in element.properties.iter().zip(&slots) {
            match (property.kind, slot) {
                (Kind::Single(scalar), &Some(slot)) => {
                    let value = body.value(scalar)?;
                    if must_be_finite && !value.is_finite() {
                        return Err(body.value_place().error(Fault::NotFinite { value }));
                    }
                    values[slot] = value;
                }
                (Kind::List { .. }, Some(_)) => {
                    return Err(element.place.error(Fault::BadEntry {
                        entry: "a property",
                        found: property.name.clone(),
                        expected: "a single number, not a list",
                    }));
                }
                (kind, None) => skip_property(kind, body)?,
            }
        }
        body.end_row()?;
        cloud.push(&values, body.place())?;
    }
    Ok(cloud.finish())
}

fn read_faces(
    element: &Element,
    body: &mut Body<'_>,
    vertices: usize,
    polygons: &mut Polygons,
    limits: &ReadLimits,
) -> Result<Vec<[u32; 3]>, FormatError> {
    if element.count == 0 {
        return Ok(Vec::new());
    }
    if vertices > u32::MAX as usize {
        return Err(element.place.error(Fault::TooManyVertices { found: vertices }));
    }
    let is_corners = |name: &str| name == "vertex_indices" || name == "vertex_index";
    if !element.properties.iter().any(|p| is_corners(&p.name)) {
        return Err(element
            .place
            .error(Fault::MissingEntry { entry: "list property vertex_indices among the faces" }));
    }
    let mut triangles = Vec::with_capacity(capacity(element, body).min(limits.triangles));
    for row in 0..element.count {
        body.begin_row(row, element.count)?;
        for property in &element.properties {
            match property.kind {
                Kind::List { count, item } if is_corners(&property.name) => {
                    let corners = list_length(count, body)?;
                    if corners < 3 {
                        let expected = "at least 3";
                        let fault = Fault::Corners { found: corners, expected };
                        return Err(body.place().error(fault));
                    }
                    let mut corner = || {
                        let missing = |found| Fault::MissingVertex { found, vertices };
                        body.whole(item, vertices, missing).map(|index| index as u32)
                    };
                    let (first, mut last) = (corner()?, corner()?);
                    for _ in 2..corners {
                        let next = corner()?;
                        triangles.push([first, last, next]);
                        last = next;
                    }
                    polygons.push(triangles.len() - (corners - 2), corners - 2);
                    limits.check_triangles(triangles.len(), body.place())?;
                }
                kind => skip_property(kind, body)?,
            }
        }
        body.end_row()?;
    }
    Ok(triangles)
}

fn skip(element: &Element, body: &mut Body<'_>) -> Result<(), FormatError> {
    for row in 0..element.count {
        body.begin_row(row, element.count)?;
        for property in &element.properties {
            skip_property(property.kind, body)?;
        }
        body.end_row()?;
    }
    Ok(())
}

fn skip_property(kind: Kind, body: &mut Body<'_>) -> Result<(), FormatError> {
    match kind {
        Kind::Single(scalar) => {
            body.value(scalar)?;
        }
        Kind::List { count, item } => {
            for _ in 0..list_length(count, body)? {
                body.value(item)?;
            }
        }
    }
    Ok(())
}

fn list_length(count: Scalar, body: &mut Body<'_>) -> Result<usize, FormatError> {
    let limit = u32::MAX as usize;
    body.whole(count, limit, |found| Fault::BadEntry {
        entry: "the length of a list",
        found,
        expected: "a whole number from 0",
    })
}

/// Whether nothing more follows the last row.
fn check_end(header: &Header, body: &Body<'_>) -> Result<(), FormatError> {
    match (body.unread(), header.elements.last()) {
        (rest, Some(last)) if !is_padding(rest) => {
            Err(body.end_place().error(Fault::Leftover { promised: last.count }))
        }
        _ => Ok(()),
    }
}
