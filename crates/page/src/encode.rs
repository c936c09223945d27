//! Numbers as text: little endian bytes in base64, as the typed arrays of a browser hold them.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use cloudtouch::geom::Point3;

/// In the middle of most points, m: about it single precision holds map coordinates too, also where a stray
/// point at the origin puts the middle of the box halfway there. The median along each axis.
pub(crate) fn middle(points: &[Point3]) -> Point3 {
    let median = |axis: usize| {
        let mut along: Vec<f64> = points.iter().map(|point| point[axis]).collect();
        let half = along.len() / 2;
        match along.is_empty() {
            true => 0.0,
            false => *along.select_nth_unstable_by(half, f64::total_cmp).1,
        }
    };
    Point3::from([0, 1, 2].map(median))
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
