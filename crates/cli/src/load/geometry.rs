//! From a file to a cloud or a mesh in metres.

use std::path::Path;

use anyhow::{Result, ensure};
use cloudtouch_cli::intrinsics::DepthImages;
use cloudtouch_io::{
    DepthCamera, Geometry, LengthUnit, ReadError, ReadLimits, check_extension, is_depth_image,
    read_depth_image_within, read_geometry_within, read_scan_within,
    recording::{ScanName, file_of},
    scaled_cloud,
};

use super::frames::Taken;
use crate::args::{BodyOptions, CommonArguments};

/// What the coordinates of files are in, and what takes depth images.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units<'a> {
    pub meshes: LengthUnit,
    pub clouds: LengthUnit,
    pub images: &'a DepthImages,
}

/// What a file was taken for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Mesh(LengthUnit),
    Cloud(LengthUnit),
    DepthImage(DepthCamera),
}

impl<'a> Units<'a> {
    pub(super) fn of(options: &'a BodyOptions<'_>) -> Self {
        let CommonArguments { unit, cloud_unit, .. } = options.common;
        Self {
            meshes: unit.unwrap_or_default(),
            clouds: cloud_unit.unwrap_or_default(),
            images: &options.depth,
        }
    }
}

impl Kind {
    pub(crate) fn is_mesh(self) -> bool {
        matches!(self, Self::Mesh(_))
    }

    pub(crate) fn is_depth_image(self) -> bool {
        matches!(self, Self::DepthImage(_))
    }

    /// What the numbers of the file were taken to be in; of a depth image, its steps.
    pub(crate) fn unit(self) -> String {
        match self {
            Self::Mesh(unit) | Self::Cloud(unit) => unit.to_string(),
            Self::DepthImage(camera) => format!("{} m", camera.depth_scale),
        }
    }
}

/// Whether a file is there and has an extension that is read: asked of all files before any is read.
pub(crate) fn check(path: &Path) -> Result<()> {
    // Said before the extension is looked at: `cloudtouch query folder …` is not about extensions.
    let found =
        std::fs::metadata(file_of(path)).map_err(|cause| ReadError::of_opening(path, cause))?;
    ensure!(!found.is_dir(), "{}: is a folder: give a cloud or mesh file", path.display());
    ensure!(
        found.is_file() || path.extension().is_some(),
        "{}: is no file, and its name does not tell the format: save it to one, such as scan.pcd",
        path.display()
    );
    Ok(check_extension(path)?)
}

/// What a file holds.
pub(crate) struct Read {
    pub geometry: Geometry,
    pub kind: Kind,
    /// Of a scan of a recording where and when it was taken.
    pub taken: Option<Taken>,
}

/// Reads a cloud or a mesh in its own unit: scans mostly know theirs and exported meshes do not, so
/// that the two are often mixed.
pub(crate) fn geometry(path: &Path, units: Units<'_>, limits: &ReadLimits) -> Result<Read> {
    check(path)?;
    if is_depth_image(path) {
        let camera = units.images.camera(path, limits.bytes)?;
        let cloud = read_depth_image_within(path, &camera, limits)?;
        let doubt = cloud.image_size.and_then(|(width, height)| camera.doubt_for(width, height));
        if let Some(doubt) = doubt {
            tracing::warn!("{}: {doubt}", path.display());
        }
        let (geometry, kind) = (Geometry::Cloud(cloud), Kind::DepthImage(camera));
        return Ok(Read { geometry, kind, taken: None });
    }
    let (geometry, taken) = match ScanName::of(path) {
        Some(_) => {
            let found = read_scan_within(path, limits)?;
            let taken = Taken::of(path, &found);
            (Geometry::Cloud(found.scan.cloud), Some(taken))
        }
        None => (read_geometry_within(path, LengthUnit::Metres, limits)?, None),
    };
    let (geometry, kind) = match geometry {
        Geometry::Mesh(mesh) => {
            let mesh = mesh.scaled(units.meshes.in_metres());
            (Geometry::Mesh(mesh), Kind::Mesh(units.meshes))
        }
        Geometry::Cloud(cloud) => {
            let cloud = scaled_cloud(cloud, units.clouds.in_metres());
            (Geometry::Cloud(cloud), Kind::Cloud(units.clouds))
        }
    };
    Ok(Read { geometry, kind, taken })
}
