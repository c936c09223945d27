//! Whether the options of a scan suit it.

use anyhow::{Result, bail};
use cloudtouch::FilterSettings;
use cloudtouch::geom::{Covariance, PointCloud};
use cloudtouch::noise::SensorModel;

use crate::args::BodyOptions;
use crate::usage::WrongUsage;

/// Says so where the cells of a collision map are smaller than the noise stated for the points in them, in the
/// median: it counts no more.
pub(super) fn warn_of_small_cells(
    name: &str,
    scan: &PointCloud,
    (sensor, cell): (&SensorModel, f64),
    options: &BodyOptions<'_>,
) {
    if options.common.sensor.is_none() {
        return;
    }
    let returns: Vec<usize> =
        (0..scan.len()).filter(|&row| PointCloud::is_return(&scan.points[row])).collect();
    // What is wrong with the sensor is told when the cloud is prepared.
    let Ok(noise) = sensor.covariances(&scan.select(&returns)) else { return };
    let mut stds: Vec<f64> = noise.iter().map(Covariance::max_std).collect();
    stds.sort_unstable_by(f64::total_cmp);
    if stds.get(stds.len() / 2).is_some_and(|std| cell < *std) {
        tracing::warn!(
            "{name}: the cells of --collision-map {cell} are smaller than the noise of --sensor {sensor}, which \
             counts no more: choose cells of several times the noise, or leave --collision-map out"
        );
    }
}

/// Refuses a `--max-range` within the range that is left out without an option.
pub(super) fn check_max_range(
    name: &str,
    scan: &PointCloud,
    sensor: &SensorModel,
    options: &BodyOptions<'_>,
) -> Result<()> {
    let mut filter = FilterSettings::for_sensor(sensor);
    options.common.change(&mut filter);
    match filter.unstated_min_range(scan).filter(|least| filter.max_range < *least) {
        Some(least) => bail!(WrongUsage(format!(
            "{name}: --max-range {} leaves no point, for nearer than {least} m to a {sensor} all are left out: \
             give a larger one, or --min-range 0",
            filter.max_range
        ))),
        None => Ok(()),
    }
}
