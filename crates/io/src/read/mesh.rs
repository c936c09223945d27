//! Reads meshes.

use std::path::Path;

use cloudtouch_geom::TriangleMesh;

use super::file::{Parser, extension, read, unsupported};
use crate::{
    error::ReadError,
    fault::{Fault, Place},
    geometry::Geometry,
    limits::ReadLimits,
    obj, ply, stl,
    unit::LengthUnit,
};

/// Reads a triangle mesh and converts it from `unit` to metres: `.stl`, `.obj` or `.ply`.
///
/// Polygons become fans about their first corner. Vertices are left as the file has them:
/// those of an STL are repeated in every triangle until [`TriangleMesh::merged`].
///
/// # Errors
/// When the file cannot be opened, has another extension, is malformed, has no faces or a
/// coordinate that is not finite; see [`Fault`].
pub fn read_mesh(path: impl AsRef<Path>, unit: LengthUnit) -> Result<TriangleMesh, ReadError> {
    read_mesh_within(path, unit, &ReadLimits::default())
}

/// As [`read_mesh`], with other limits than the default ones.
///
/// # Errors
/// As [`read_mesh`].
pub fn read_mesh_within(
    path: impl AsRef<Path>,
    unit: LengthUnit,
    limits: &ReadLimits,
) -> Result<TriangleMesh, ReadError> {
    let path = path.as_ref();
    let parse: Parser<TriangleMesh> = match extension(path).as_str() {
        "stl" => stl::parse_within,
        "obj" => obj::parse_within,
        "ply" => |bytes, limits| match ply::parse_within(bytes, limits)? {
            Geometry::Mesh(mesh) => Ok(mesh),
            Geometry::Cloud(_) => Err(Place::Line(1).error(Fault::NoTriangles)),
        },
        _ => return Err(unsupported(path, ".stl, .obj, .ply (meshes)")),
    };
    Ok(read(path, parse, limits)?.scaled(unit.in_metres()))
}
