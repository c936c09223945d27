//! Range limits: returns too near or too far to be trusted.

use cloudtouch_geom::PointCloud;

use super::FilterSettings;

pub(super) fn keep_in_range(cloud: &PointCloud, kept: &mut Vec<usize>, settings: &FilterSettings) {
    kept.retain(|&i| {
        let range = (cloud.points[i] - cloud.sensor_origin()).norm();
        range >= settings.min_range && range <= settings.max_range
    });
}
