//! Reads clouds, of files of their own and of recordings.

use std::path::Path;

use cloudtouch_geom::PointCloud;

use super::file::{Parser, extension, read, unsupported};
#[cfg(feature = "mcap")]
use crate::recording::Recording;
use crate::{
    error::ReadError,
    fault::{Fault, Place},
    geometry::Geometry,
    limits::ReadLimits,
    pcd, ply,
    recording::{RecordedScan, ScanName},
    xyz,
};

/// Reads a point cloud in metres: `.pcd`, `.ply`, `.xyz`, `.txt` or `.csv`; with the feature `mcap`
/// also a scan of a recording, see [`read_scan_within`].
///
/// Rows without a return stay as NaN rows. A PLY with faces is a mesh: what is between its vertices would be lost.
///
/// # Errors
/// When the file cannot be opened, has another extension, or is malformed; see [`Fault`].
pub fn read_cloud(path: impl AsRef<Path>) -> Result<PointCloud, ReadError> {
    read_cloud_within(path, &ReadLimits::default())
}

/// As [`read_cloud`], with other limits than the default ones.
///
/// # Errors
/// As [`read_cloud`].
pub fn read_cloud_within(
    path: impl AsRef<Path>,
    limits: &ReadLimits,
) -> Result<PointCloud, ReadError> {
    let path = path.as_ref();
    let parse: Parser<PointCloud> = match extension(path).as_str() {
        "pcd" => pcd::parse_within,
        "ply" => |bytes, limits| match ply::parse_within(bytes, limits)? {
            Geometry::Cloud(cloud) => Ok(cloud),
            Geometry::Mesh(mesh) => {
                let found = mesh.triangles().len();
                Err(Place::Line(1).error(Fault::FacesOfCloud { found }))
            }
        },
        "xyz" | "txt" | "csv" => xyz::parse_within,
        "mcap" => return Ok(read_scan_within(path, limits)?.scan.cloud),
        _ => return Err(unsupported(path, ".pcd, .ply, .xyz, .txt, .csv (point clouds)")),
    };
    read(path, parse, limits)
}

/// Reads a scan of a recording, `run.mcap#/topic@SECONDS`, as [`ScanName`] explains it.
///
/// The cloud is in the frame of the message: transforms of the recording are not applied.
///
/// # Errors
/// When the path names no recording or no time, the recording cannot be read or has no such scan,
/// or the message is malformed. Always in a build without the feature `mcap`.
pub fn read_scan_within(
    path: impl AsRef<Path>,
    limits: &ReadLimits,
) -> Result<RecordedScan, ReadError> {
    let path = path.as_ref();
    let name =
        ScanName::of(path).unwrap_or_else(|| Err(unsupported(path, ".mcap (recordings)")))?;
    recorded(&name, limits)
}

#[cfg(feature = "mcap")]
fn recorded(name: &ScanName, limits: &ReadLimits) -> Result<RecordedScan, ReadError> {
    Recording::open(&name.file, limits)?.scan(name.topic.as_deref(), name.at)
}

#[cfg(not(feature = "mcap"))]
fn recorded(name: &ScanName, _: &ReadLimits) -> Result<RecordedScan, ReadError> {
    Err(ReadError::NoRecordings { path: name.file.clone() })
}
