//! What returns of a depth image say that are no points: that there is nothing before them.

use cloudtouch_geom::{Covariance, PointCloud, Vector3};

use crate::cloud::preparation::Preparation;
use crate::cloud::view::raster::CLEARLY;
use crate::cloud::view::{AT_SENSOR, OtherReturn};
use crate::error::PrepareError;
use crate::filter::{Removed, is_return_to};

use super::noise::noise_of;

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
        is_return_to(&from, place) && (place - from).norm() > most
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

/// The rows of returns that went and still say how far was seen: those that became cells of a collision map, which are wider than
/// pixels, so that no hole of the image would be found between them; what was taken for veil, for outliers or for the
/// robot, past which nobody saw, whatever it is; and what is nearer than returns are kept.
pub(super) fn other_returns(
    image: &PointCloud,
    removed: &Removed,
    by: Preparation<'_>,
) -> Result<Vec<(usize, OtherReturn)>, PrepareError> {
    let from = image.sensor_origin();
    let told = |&row: &usize, std: f64| (row, OtherReturn { ray: image.points[row] - from, std });
    // Rows at the place of the sensor, which may be in the robot, have no direction.
    let is_return = |row: &&usize| is_return_to(&from, &image.points[**row]);
    let opaque = removed.veil.iter().chain(&removed.outliers).chain(&removed.robot);
    let opaque = opaque.filter(is_return);
    let mut all: Vec<_> = opaque.map(|row| told(row, 0.0)).collect();
    // How far away these are is not to be trusted, so that nothing is known there from the sensor on.
    let near = removed.near.iter().map(|row| {
        let ray = (image.points[*row] - from).normalize() * AT_SENSOR;
        (*row, OtherReturn { ray, std: 0.0 })
    });
    all.extend(near);
    if !removed.mapped.is_empty() {
        let noise = noise_of(&image.select(&removed.mapped), by)?;
        let stds = noise.iter().map(Covariance::std_bound);
        all.extend(removed.mapped.iter().zip(stds).map(|(row, std)| told(row, std)));
    }
    Ok(all)
}
