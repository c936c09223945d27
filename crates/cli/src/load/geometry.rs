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
        warn_of_doubtful(path, &camera, &cloud.image_size);
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

/// Pixels of cameras are about as wide as they are high.
const UNLIKE: f64 = 1.5;

/// Warns of intrinsics that may be those of another image, or in another order: of a crop they are right.
fn warn_of_doubtful(path: &Path, camera: &DepthCamera, size: &Option<(usize, usize)>) {
    let Some((width, height)) = *size else { return };
    let DepthCamera { fx, fy, cx, cy, .. } = *camera;
    let is_aside = |middle: f64, pixels: usize| {
        let share = middle / pixels as f64;
        !(0.25..=0.75).contains(&share)
    };
    let words = if is_aside(cx, width) || is_aside(cy, height) {
        format!(
            "the principal point ({cx}, {cy}) is far from the middle of {width} x {height} pixels"
        )
    } else if fx / fy > UNLIKE || fy / fx > UNLIKE {
        format!("the focal lengths are {fx} and {fy} pixels")
    } else {
        return;
    };
    tracing::warn!(
        "{}: {words}: give fx, fy, cx and cy in this order, of this image and not of another size; of a \
         crop they may be right",
        path.display()
    );
}
