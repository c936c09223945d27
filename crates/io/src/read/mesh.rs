//! Reads meshes.

use std::path::Path;

use cloudtouch_geom::TriangleMesh;

use super::file::{Parser, extension, read, unsupported};
use crate::{
    error::ReadError,
    fault::{Fault, FormatError, Place},
    geometry::Geometry,
    limits::ReadLimits,
    obj, ply, stl,
    unit::LengthUnit,
};

/// A mesh may have so many vertices that no face uses, ...
const FEW: usize = 3;
/// ... or one of so many: tools leave some behind.
const ONE_OF: usize = 100;

/// Reads a triangle mesh and converts it from `unit` to metres: `.stl`, `.obj` or `.ply`.
///
/// Polygons are cut along their outline, up to 1,000 corners, and larger ones into fans about their first, which cover
/// them and their notches. Vertices are left as the file has them: those of an STL are repeated in every triangle
/// until [`TriangleMesh::merged`].
///
/// # Errors
/// When the file cannot be opened, has another extension, is malformed, has no faces or a
/// coordinate that is not finite; and when more than a few vertices of a PLY (1 %, and more than 3) belong to no face, for they may be
/// points of a scan, which would be lost; see [`Fault`].
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
            Geometry::Mesh(mesh) => without_points(mesh),
            Geometry::Cloud(_) => Err(Place::Line(1).error(Fault::NoTriangles)),
        },
        _ => return Err(unsupported(path, ".stl, .obj, .ply (meshes)")),
    };
    Ok(read(path, parse, limits)?.scaled(unit.in_metres()))
}

/// Refuses a mesh of which more than a few vertices belong to no face: points would be lost without a word.
pub(super) fn without_points(mesh: TriangleMesh) -> Result<TriangleMesh, FormatError> {
    let vertices = mesh.vertices().len();
    let loose = vertices - mesh.used_vertices().count();
    if loose > FEW && ONE_OF * loose > vertices {
        return Err(Place::Line(1).error(Fault::LoosePoints { loose, vertices }));
    }
    Ok(mesh)
}
