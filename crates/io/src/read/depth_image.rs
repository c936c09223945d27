//! Reads depth images.

use std::path::Path;

use cloudtouch_geom::PointCloud;

use super::file::{read, unsupported};
use crate::{depth, depth_camera::DepthCamera, error::ReadError, limits::ReadLimits};

/// Reads a depth image, a 16-bit greyscale PNG (`.png`), as an organised cloud in metres in the optical
/// frame of its camera: see [`depth::parse`].
///
/// # Errors
/// When the file cannot be opened, has another extension, is no depth image, or is none of this camera.
pub fn read_depth_image(
    path: impl AsRef<Path>,
    camera: &DepthCamera,
) -> Result<PointCloud, ReadError> {
    read_depth_image_within(path, camera, &ReadLimits::default())
}

/// As [`read_depth_image`], with other limits than the default ones.
///
/// # Errors
/// As [`read_depth_image`].
pub fn read_depth_image_within(
    path: impl AsRef<Path>,
    camera: &DepthCamera,
    limits: &ReadLimits,
) -> Result<PointCloud, ReadError> {
    let path = path.as_ref();
    if !depth::is_depth_image(path) {
        return Err(unsupported(path, ".png (depth images)"));
    }
    read(path, |bytes, limits| depth::parse_within(bytes, camera, limits), limits)
}
