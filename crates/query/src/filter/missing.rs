//! Rows without a return.

use cloudtouch_geom::{Point3, PointCloud};

/// So many rows that repeat the place of the sensor, or the origin of the file, stand for no return.
const PLACEHOLDERS: usize = 3;
/// A row that is no farther from it is at a place, m.
const AT_IT: f64 = 1e-6;

/// Drops what is no return, or is written for none: some drivers write zeros, or the place of the sensor.
pub(super) fn drop_missing(cloud: &PointCloud, kept: &mut Vec<usize>) {
    kept.retain(|&index| PointCloud::is_return(&cloud.points[index]));
    for place in [Point3::origin(), cloud.sensor_origin()] {
        let is_at_it = |&index: &usize| (cloud.points[index] - place).norm_squared() <= AT_IT * AT_IT;
        if kept.iter().filter(|index| is_at_it(index)).count() >= PLACEHOLDERS {
            kept.retain(|index| !is_at_it(index));
        }
    }
}
