//! The colours of a PLY file: three properties of its vertices.

use super::header;
use super::parse::parse_body;
use crate::{fault::FormatError, geometry::Geometry, limits::ReadLimits, text::Lines};

/// Red, green and blue of every point; `None` for a mesh, or a file without them.
///
/// # Errors
/// As [`parse`](super::parse()).
pub fn colors_within(
    bytes: &[u8],
    limits: &ReadLimits,
) -> Result<Option<Vec<[u8; 3]>>, FormatError> {
    let mut lines = Lines::new(bytes);
    let mut header = header::read(&mut lines)?;
    let vertex = header.elements.iter_mut().find(|element| element.name == "vertex");
    let Some(vertex) = vertex else { return Ok(None) };
    let mut found = 0;
    // Read as if the colours were the coordinates.
    for property in &mut vertex.properties {
        property.name = match property.name.to_ascii_lowercase().as_str() {
            "red" => "x".to_owned(),
            "green" => "y".to_owned(),
            "blue" => "z".to_owned(),
            other => format!("not a colour: {other}"),
        };
        found += usize::from(property.name.len() == 1);
    }
    if found != 3 {
        return Ok(None);
    }
    let is_share = vertex.properties.iter().any(|p| p.name == "x" && p.is_float());
    let most = if is_share { 255.0 } else { 1.0 };
    Ok(match parse_body(&header, bytes, lines, limits)? {
        Geometry::Cloud(cloud) => {
            // Out of range saturates.
            let bytes = |p: &cloudtouch_geom::Point3| [p.x, p.y, p.z].map(|v| (most * v) as u8);
            Some(cloud.points.iter().map(bytes).collect())
        }
        Geometry::Mesh(_) => None,
    })
}
