//! From the bytes of a depth image to a cloud.

use std::path::Path;

use cloudtouch_geom::{Point3, PointCloud, Pose};

use super::image;
use crate::{
    depth_camera::DepthCamera,
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
};

/// Whether a file is taken for a depth image: its extension is `.png`.
pub fn is_depth_image(path: impl AsRef<Path>) -> bool {
    path.as_ref().extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
}

/// Reads an organised cloud from the bytes of a depth image, a 16-bit greyscale PNG.
///
/// Points are in the optical frame of the camera (x right, y down, z forward), m, with the camera at the
/// origin; as many as there are pixels, row by row from the upper left one. Numbers are steps of
/// [`DepthCamera::depth_scale`] along z, not along the ray. 0 and 65535 stand for no return and become NaN
/// rows. What the PNG says of gamma, colours and transparency is passed over.
///
/// # Errors
/// When the bytes are no PNG or another one than 16-bit greyscale, cut off or damaged; when there is only one
/// row or column, no pixel has a return, the camera cannot have taken an image of this size
/// ([`DepthCamera::validate_for`]), or there are more pixels than the default [`ReadLimits`] allow, before
/// their memory is taken.
pub fn parse(bytes: &[u8], camera: &DepthCamera) -> Result<PointCloud, FormatError> {
    parse_within(bytes, camera, &ReadLimits::default())
}

/// As [`parse`], with other limits than the default ones.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(
    bytes: &[u8],
    camera: &DepthCamera,
    limits: &ReadLimits,
) -> Result<PointCloud, FormatError> {
    let image = image::decode(bytes, limits)?;
    let (width, height) = (image.width, image.height);
    camera.validate_for(width, height).map_err(|cause| Place::Whole.error(Fault::Camera(cause)))?;
    let place = |(index, steps)| camera.point(index % width, index / width, steps);
    let points: Vec<Point3> = image.pixels().enumerate().map(place).collect();
    if points.iter().all(|point| point.z.is_nan()) {
        return Err(Place::Whole.error(Fault::NoReturns { pixels: points.len() }));
    }
    Ok(PointCloud {
        image_size: Some((width, height)),
        sensor_pose: Some(Pose::identity()),
        ..PointCloud::from_points(points)
    })
}
