//! Statistical outliers: specks far from everything else.

use cloudtouch_geom::{Point3, PointCloud};
use cloudtouch_noise::Neighborhoods;
use rayon::prelude::*;

use super::OutlierSettings;

/// Drops points whose mean distance to their neighbours exceeds the mean over all points by more
/// than the set number of standard deviations. Returns the rows that go.
pub(super) fn drop_outliers(
    cloud: &PointCloud,
    kept: &mut Vec<usize>,
    settings: &OutlierSettings,
) -> Vec<usize> {
    let points: Vec<Point3> = kept.iter().map(|&i| cloud.points[i]).collect();
    let Ok(neighborhoods) = Neighborhoods::new(points) else { return Vec::new() };
    let points = neighborhoods.points();
    let distances: Vec<f64> = (0..points.len())
        .into_par_iter()
        .map(|i| {
            let neighbors = neighborhoods.nearest(i, settings.neighbors);
            let total: f64 = neighbors.iter().map(|n| n.squared_distance.sqrt()).sum();
            total / neighbors.len().max(1) as f64
        })
        .collect();
    let count = distances.len().max(1) as f64;
    let mean = distances.iter().sum::<f64>() / count;
    let variance = distances.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / count;
    let limit = mean + settings.deviations * variance.sqrt();
    let mut distances = distances.into_iter();
    kept.extract_if(.., |_| distances.next().is_some_and(|distance| distance > limit)).collect()
}
