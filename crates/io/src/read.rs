//! Files by their extension: opens, parses, converts to metres.

use std::{fs, path::Path};

use cloudtouch_geom::{PointCloud, TriangleMesh};

use crate::{
    error::{Fault, FormatError, Place, ReadError},
    obj, pcd, ply, stl,
    unit::LengthUnit,
    xyz,
};

/// What a file holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// Points without faces.
    Cloud(PointCloud),
    /// Vertices and at least one face.
    Mesh(TriangleMesh),
}

/// Reads a point cloud in metres: `.pcd`, `.ply`, `.xyz`, `.txt` or `.csv`.
///
/// Rows without a return stay as NaN rows. Of a PLY with faces the vertices are taken.
///
/// # Errors
/// When the file cannot be opened, has another extension, or is malformed; see [`Fault`].
pub fn read_cloud(path: impl AsRef<Path>) -> Result<PointCloud, ReadError> {
    let path = path.as_ref();
    let parse: Parser<PointCloud> = match extension(path).as_str() {
        "pcd" => pcd::parse,
        "ply" => |bytes| {
            Ok(match ply::parse(bytes)? {
                Geometry::Cloud(cloud) => cloud,
                Geometry::Mesh(mesh) => PointCloud::from_points(mesh.vertices().to_vec()),
            })
        },
        "xyz" | "txt" | "csv" => xyz::parse,
        _ => return Err(unsupported(path, ".pcd, .ply, .xyz, .txt, .csv (point clouds)")),
    };
    read(path, parse)
}

/// Reads a triangle mesh and converts it from `unit` to metres: `.stl`, `.obj` or `.ply`.
///
/// Polygons become fans about their first corner. Vertices are left as the file has them:
/// those of an STL are repeated in every triangle until [`TriangleMesh::merged`].
///
/// # Errors
/// When the file cannot be opened, has another extension, is malformed, has no faces or a
/// coordinate that is not finite; see [`Fault`].
pub fn read_mesh(path: impl AsRef<Path>, unit: LengthUnit) -> Result<TriangleMesh, ReadError> {
    let path = path.as_ref();
    let parse: Parser<TriangleMesh> = match extension(path).as_str() {
        "stl" => stl::parse,
        "obj" => obj::parse,
        "ply" => |bytes| match ply::parse(bytes)? {
            Geometry::Mesh(mesh) => Ok(mesh),
            Geometry::Cloud(_) => Err(Place::Line(1).error(Fault::NoTriangles)),
        },
        _ => return Err(unsupported(path, ".stl, .obj, .ply (meshes)")),
    };
    Ok(read(path, parse)?.scaled(unit.in_metres()))
}

/// Reads a cloud or a mesh, whichever the file holds, and converts it from `unit` to metres.
///
/// A PLY is a mesh when it has faces. The unit counts for clouds too: positions, covariances and
/// the sensor origin are converted.
///
/// # Errors
/// As [`read_cloud`] and [`read_mesh`].
pub fn read_geometry(path: impl AsRef<Path>, unit: LengthUnit) -> Result<Geometry, ReadError> {
    let path = path.as_ref();
    let parse: Parser<Geometry> = match extension(path).as_str() {
        "pcd" => |bytes| pcd::parse(bytes).map(Geometry::Cloud),
        "xyz" | "txt" | "csv" => |bytes| xyz::parse(bytes).map(Geometry::Cloud),
        "stl" => |bytes| stl::parse(bytes).map(Geometry::Mesh),
        "obj" => |bytes| obj::parse(bytes).map(Geometry::Mesh),
        "ply" => ply::parse,
        _ => return Err(unsupported(path, ".pcd, .ply, .xyz, .txt, .csv, .stl, .obj")),
    };
    let factor = unit.in_metres();
    Ok(match read(path, parse)? {
        Geometry::Cloud(cloud) => Geometry::Cloud(scaled(cloud, factor)),
        Geometry::Mesh(mesh) => Geometry::Mesh(mesh.scaled(factor)),
    })
}

type Parser<T> = fn(&[u8]) -> Result<T, FormatError>;

fn read<T>(path: &Path, parse: Parser<T>) -> Result<T, ReadError> {
    let bytes = fs::read(path).map_err(|cause| ReadError::Io { path: path.to_owned(), cause })?;
    parse(&bytes)
        .map_err(|problem| ReadError::Format { path: path.to_owned(), problem: Box::new(problem) })
}

fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

fn unsupported(path: &Path, supported: &'static str) -> ReadError {
    ReadError::Extension { path: path.to_owned(), found: extension(path), supported }
}

fn scaled(mut cloud: PointCloud, factor: f64) -> PointCloud {
    cloud.points.iter_mut().for_each(|p| p.coords *= factor);
    cloud.sensor_origin.coords *= factor;
    for covariance in cloud.covariances.iter_mut().flatten() {
        *covariance = covariance.scaled(factor);
    }
    cloud
}
