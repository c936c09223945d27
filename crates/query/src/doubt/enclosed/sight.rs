//! Whether a sensor looked at a place past no surface.

use cloudtouch_geom::Point3;

use crate::cloud::Prepared;

/// A way that keeps so many spacings of the cloud from every point passes no surface: of samples at random
/// four in a million ways through a surface do, and as many again from each further sensor.
const SURFACE_SPACINGS: f64 = 2.0;
/// Where the samples about a point are farther apart than those of the cloud, so many of theirs count ...
const LOCAL_SPACINGS: f64 = 1.5;
/// ... up to this many times as far: those of a floor far off are as a room is.
const MOST_SPARSE: f64 = 3.0;

/// Whether no point of the cloud is near the way from a sensor to a place, both in the cloud's local frame.
pub(super) fn sees(cloud: &Prepared, sensor: &Point3, place: &Point3) -> bool {
    let way = place - sensor;
    let length = way.norm();
    let spacing = cloud.makeup().spacing;
    cloud.points().iter().all(|point| {
        let offset = point - sensor;
        let along = offset.dot(&way) / length.max(f64::MIN_POSITIVE);
        let aside = (offset.norm_squared() - along * along).max(0.0).sqrt();
        let is_between = along > 0.0 && along < length;
        let is_off_where_sparse = || {
            aside > LOCAL_SPACINGS * MOST_SPARSE * spacing
                || aside > LOCAL_SPACINGS * cloud.spacing_about(point)
        };
        !is_between || aside > SURFACE_SPACINGS * spacing && is_off_where_sparse()
    })
}
