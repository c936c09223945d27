//! How far the returns of a scan were kept: beyond, nothing is known, whatever was there.

use cloudtouch_geom::Point3;

use super::raster::Sight;

/// Up to where a scan without image layout tells, in the frame of its file: a depth image tells itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    /// Where the sensor stood, m.
    pub sensor_origin: Point3,
    /// m; infinite where all returns were kept.
    pub most: f64,
}

impl Range {
    fn holds(&self, place: &Point3) -> bool {
        (place - self.sensor_origin).norm() <= self.most
    }
}

/// What scans know of a place in the frame of their file.
pub(in crate::cloud) fn sight(scans: &[Range], place: &Point3) -> Sight {
    if scans.iter().any(|scan| scan.holds(place)) { Sight::Seen } else { Sight::OutOfRange }
}

/// Adds one, unless another says the same.
pub(in crate::cloud) fn add(scans: &mut Vec<Range>, other: Range) {
    if !scans.contains(&other) {
        scans.push(other);
    }
}
