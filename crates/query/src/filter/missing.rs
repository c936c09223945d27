//! Rows without a return.

use cloudtouch_geom::{Point3, PointCloud};

use super::range::AT_IT;

/// So many rows that repeat the place of the sensor, or the origin of the file, stand for no return; of an image, whose rows
/// without one are there, a single one does.
const PLACEHOLDERS: usize = 3;

/// Drops what is no return, or is written for none: some drivers write zeros, or the place of the sensor.
pub(super) fn drop_missing(cloud: &PointCloud, kept: &mut Vec<usize>) {
    kept.retain(|&index| PointCloud::is_return(&cloud.points[index]));
    let least = if cloud.is_image() { 1 } else { PLACEHOLDERS };
    let is_zero = |index: &usize| cloud.points[*index] == Point3::origin();
    drop_repeated(kept, least, is_zero);
    if cloud.sensor_pose.is_some() {
        let place = cloud.sensor_origin();
        let is_at_it = |index: &usize| (cloud.points[*index] - place).norm() <= AT_IT;
        drop_repeated(kept, least, is_at_it);
    }
}

fn drop_repeated(kept: &mut Vec<usize>, least: usize, is_placeholder: impl Fn(&usize) -> bool) {
    let count = kept.iter().filter(|index| is_placeholder(index)).count();
    if count >= least && count < kept.len() {
        kept.retain(|index| !is_placeholder(index));
    }
}
