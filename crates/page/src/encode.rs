//! Numbers as text: little endian bytes in base64, as the typed arrays of a browser hold them.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use cloudtouch::geom::{Point3, bounding_box};

/// The middle of the box of some points, m: about it single precision holds map coordinates too.
pub(crate) fn middle<'a>(points: impl IntoIterator<Item = &'a Point3>) -> Point3 {
    bounding_box(points).map_or(Point3::origin(), |(low, high)| low + 0.5 * (high - low))
}

/// Points about a middle, three numbers of single precision each.
pub(crate) fn positions<'a>(
    points: impl IntoIterator<Item = &'a Point3>,
    middle: &Point3,
) -> String {
    let about_middle = |point: &Point3| -> [f64; 3] { (point - middle).into() };
    let coordinates = points.into_iter().flat_map(about_middle);
    bytes(coordinates.flat_map(|x| (x as f32).to_le_bytes()))
}

/// Indices, 32 bits each.
pub(crate) fn indices(indices: impl IntoIterator<Item = u32>) -> String {
    bytes(indices.into_iter().flat_map(u32::to_le_bytes))
}

/// Bytes as they are.
pub(crate) fn bytes(bytes: impl IntoIterator<Item = u8>) -> String {
    STANDARD.encode(bytes.into_iter().collect::<Vec<u8>>())
}
