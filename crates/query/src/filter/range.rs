//! Range limits: returns too near or too far to be trusted.

use cloudtouch_geom::PointCloud;

use super::FilterSettings;

/// No camera and no laser scanner sees nearer, m.
const NEAREST: f64 = 0.1;
/// Returns that are nearer than this to the place of a sensor are at it, m.
const AT_IT: f64 = 1e-6;

pub(super) fn keep_in_range(cloud: &PointCloud, kept: &mut Vec<usize>, settings: &FilterSettings) {
    let place = cloud.sensor_origin();
    let is_known = cloud.is_image() || cloud.sensor_pose.is_some();
    let min = settings.min_range.unwrap_or(if is_known { NEAREST } else { AT_IT });
    kept.retain(|&i| {
        let range = (cloud.points[i] - place).norm();
        range >= min && range <= settings.max_range
    });
}
