//! Range limits: returns too near or too far to be trusted.

use cloudtouch_geom::{Point3, PointCloud};

use cloudtouch_noise::SensorModel;

use super::FilterSettings;

/// No camera and no laser scanner sees nearer, m.
const NEAREST: f64 = 0.1;
/// Returns that are nearer than this to the place of a sensor are at it, m.
pub(super) const AT_IT: f64 = 1e-6;

/// Whether a row of an image is a return that the sensor there saw: some drivers write zeros for none, or the place of the
/// sensor, which may be rounded.
pub(crate) fn is_return_to(place: &Point3, p: &Point3) -> bool {
    const ROUNDED: f64 = 1e-3;
    PointCloud::is_return(p)
        && *p != Point3::origin()
        && (p - place).norm_squared() > ROUNDED * ROUNDED
}

impl FilterSettings {
    /// How near to the sensor returns are left out though no [`Self::min_range`] is stated, m; `None` where one
    /// is, or where the sensor stood is not known: only the rows and columns of an image tell that it was there. A
    /// place that is merely stated may be in the middle of what was measured.
    pub fn unstated_min_range(&self, cloud: &PointCloud) -> Option<f64> {
        (self.min_range.is_none() && cloud.is_image()).then_some(NEAREST)
    }
}

/// The settings that drop what is too far for a disparity to tell how far; `None` where nothing is, or more than a tenth:
/// that is from elsewhere, or in another unit.
pub(crate) fn measured(
    cloud: &PointCloud,
    settings: &FilterSettings,
    sensor: &SensorModel,
) -> Option<FilterSettings> {
    const MOST: usize = 10;
    let max_range = sensor.farthest();
    let place = cloud.sensor_origin();
    let is_beyond = |p: &&Point3| PointCloud::is_return(p) && (*p - place).norm() > max_range;
    if max_range >= settings.max_range {
        return None;
    }
    let beyond = cloud.points.iter().filter(is_beyond).count();
    let are_few = beyond > 0 && MOST * beyond <= cloud.len();
    are_few.then(|| FilterSettings { max_range, ..settings.clone() })
}

pub(super) fn keep_in_range(cloud: &PointCloud, kept: &mut Vec<usize>, settings: &FilterSettings) {
    let place = cloud.sensor_origin();
    let unstated = settings.unstated_min_range(cloud).unwrap_or(AT_IT);
    let min = settings.min_range.unwrap_or(unstated);
    kept.retain(|&i| {
        let range = (cloud.points[i] - place).norm();
        range >= min && range <= settings.max_range
    });
}
