//! What returns of a depth image say that are left out because they are far: that there is nothing before.

use cloudtouch_geom::{PointCloud, Vector3};

use crate::cloud::preparation::Preparation;
use crate::cloud::view::raster::CLEARLY;
use crate::error::PrepareError;

/// The rows of the returns beyond the range that is kept, in order, with their rays up to where that range ends
/// or the surface may be, m.
pub(super) fn beyond_range(
    image: &PointCloud,
    by: Preparation<'_>,
) -> Result<Vec<(usize, Vector3)>, PrepareError> {
    let most = by.filter.max_range;
    let from = image.sensor_origin();
    let is_beyond = |&row: &usize| {
        let place = &image.points[row];
        PointCloud::is_return(place) && (place - from).norm() > most
    };
    let rows: Vec<usize> = match most.is_finite() {
        true => (0..image.len()).filter(is_beyond).collect(),
        false => Vec::new(),
    };
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let beyond = image.select(&rows);
    let noise = by.sensor.covariances(&beyond)?;
    let rays = rows.into_iter().enumerate().filter_map(|(index, row)| {
        let place = &beyond.points[index];
        let ray = place - from;
        let range = ray.norm();
        let empty = most.min(range - CLEARLY * noise[index].std_bound());
        (empty > 0.0).then(|| (row, ray * (empty / range)))
    });
    Ok(rays.collect())
}
