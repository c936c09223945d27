//! Reads a cloud or a mesh, whichever a file holds.

use std::path::Path;

use cloudtouch_geom::{PointCloud, Pose};

use super::cloud::read_scan_within;
use super::file::{EVERYTHING, Parser, extension, read, unsupported};
use super::mesh::without_points;
use crate::{
    error::ReadError, fault::FormatError, geometry::Geometry, limits::ReadLimits, obj, pcd, ply,
    stl, unit::LengthUnit, xyz,
};

/// Reads a cloud or a mesh, whichever the file holds, and converts it from `unit` to metres.
///
/// A PLY is a mesh when it has faces. The unit counts for clouds too: positions, covariances and
/// the sensor origin are converted.
///
/// # Errors
/// As [`read_cloud`](super::read_cloud) and [`read_mesh`](super::read_mesh).
pub fn read_geometry(path: impl AsRef<Path>, unit: LengthUnit) -> Result<Geometry, ReadError> {
    read_geometry_within(path, unit, &ReadLimits::default())
}

/// As [`read_geometry`], with other limits than the default ones.
///
/// # Errors
/// As [`read_geometry`].
pub fn read_geometry_within(
    path: impl AsRef<Path>,
    unit: LengthUnit,
    limits: &ReadLimits,
) -> Result<Geometry, ReadError> {
    let path = path.as_ref();
    let factor = unit.in_metres();
    let parse: Parser<Geometry> = match extension(path).as_str() {
        "pcd" => |bytes, limits| pcd::parse_within(bytes, limits).map(Geometry::Cloud),
        "xyz" | "txt" | "csv" => {
            |bytes, limits| xyz::parse_within(bytes, limits).map(Geometry::Cloud)
        }
        "stl" => |bytes, limits| stl::parse_within(bytes, limits).map(Geometry::Mesh),
        "obj" => |bytes, limits| obj::parse_within(bytes, limits).map(Geometry::Mesh),
        "ply" => |bytes, limits| ply::parse_within(bytes, limits).and_then(cloud_or_mesh),
        "mcap" => {
            let cloud = read_scan_within(path, limits)?.scan.cloud;
            return Ok(Geometry::Cloud(scaled_cloud(cloud, factor)));
        }
        _ => return Err(unsupported(path, EVERYTHING)),
    };
    Ok(match read(path, parse, limits)? {
        Geometry::Cloud(cloud) => Geometry::Cloud(scaled_cloud(cloud, factor)),
        Geometry::Mesh(mesh) => Geometry::Mesh(mesh.scaled(factor)),
    })
}

/// A mesh only where it is nothing else as well.
fn cloud_or_mesh(geometry: Geometry) -> Result<Geometry, FormatError> {
    match geometry {
        Geometry::Mesh(mesh) => without_points(mesh).map(Geometry::Mesh),
        cloud @ Geometry::Cloud(_) => Ok(cloud),
    }
}

/// A cloud in another unit: positions, covariances and the place of the sensor times `factor`.
pub fn scaled_cloud(mut cloud: PointCloud, factor: f64) -> PointCloud {
    cloud.points.iter_mut().for_each(|p| p.coords *= factor);
    cloud.sensor_pose = cloud
        .sensor_pose
        .map(|pose| Pose::from_translation_rotation(pose.translation() * factor, *pose.rotation()));
    for covariance in cloud.covariances.iter_mut().flatten() {
        *covariance = covariance.scaled(factor);
    }
    cloud
}
