//! Shadow (veil) points: a pixel that sees half of a near and half of a far surface returns a
//! depth in between, where nothing is.
//!
//! In an image, such a point continues along its viewing ray: one neighbour is nearer, the opposite
//! one farther, and both steps run almost along the ray. On a true surface that steep to the ray a
//! camera gets hardly any return. Beside veils pixels often have no return at all: then the next one
//! within a few pixels is the neighbour. Without an image layout the neighbours are the nearest points,
//! and a veil point is one whose neighbourhood is a line along the ray.

use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Vector3};
use cloudtouch_noise::Neighborhoods;
use rayon::prelude::*;

use super::VeilSettings;

/// A neighbour is at most so many pixels away: those between gave no return.
const ACROSS_HOLES: usize = 3;
/// Neighbours that decide whether an unorganised neighbourhood is a line along the ray.
const LINE_NEIGHBORS: usize = 10;
/// A neighbourhood counts as a line when its largest variance is this many times the next.
const LINE_RATIO: f64 = 9.0;

pub(super) fn drop_veil(cloud: &PointCloud, kept: &mut Vec<usize>, settings: &VeilSettings) {
    match cloud.image_size {
        Some((width, height)) if width > 1 && height > 1 => {
            let (from, least_cosine) = (cloud.sensor_origin(), settings.max_angle.cos());
            let size = (width, height);
            let is_kept =
                |&i: &usize| !is_veil_in_image(&cloud.points, i, size, &from, least_cosine);
            *kept = std::mem::take(kept).into_par_iter().filter(is_kept).collect();
        }
        _ => drop_veil_lines(cloud, kept, settings),
    }
}

fn is_veil_in_image(
    points: &[Point3],
    index: usize,
    (width, height): (usize, usize),
    from: &Point3,
    least_cosine: f64,
) -> bool {
    let (row, column) = (index / width, index % width);
    let point = &points[index];
    let ray = point - from;
    // Of a pixel with so many others before it in its row or column, and so many after it, so far apart.
    let is_between = |before: usize, after: usize, apart: usize| {
        let next = |most: usize, at: fn(usize, usize) -> usize| {
            (1..=most.min(ACROSS_HOLES))
                .filter_map(|step| points.get(at(index, step * apart)))
                .find(|other| PointCloud::is_return(other))
                .map_or(0.0, |other| along_ray(&ray, point, other, least_cosine))
        };
        let backward = next(before, |index, by| index - by);
        // PERF: of most pixels no step runs along the ray.
        backward != 0.0 && backward * next(after, |index, by| index + by) < 0.0
    };
    is_between(column, width - 1 - column, 1) || is_between(row, height - 1 - row, width)
}

/// +1 when the step from `point` to `other` runs along the ray away from the sensor, −1 towards it,
/// 0 when it does not run along the ray.
fn along_ray(ray: &Vector3, point: &Point3, other: &Point3, least_cosine: f64) -> f64 {
    let step = other - point;
    let cosine = step.dot(ray) / (step.norm() * ray.norm());
    if cosine.abs() > least_cosine { cosine.signum() } else { 0.0 }
}

fn drop_veil_lines(cloud: &PointCloud, kept: &mut Vec<usize>, settings: &VeilSettings) {
    let points: Vec<Point3> = kept.iter().map(|&i| cloud.points[i]).collect();
    let Ok(neighborhoods) = Neighborhoods::new(points) else { return };
    let points = neighborhoods.points();
    let veil: Vec<bool> = (0..points.len())
        .into_par_iter()
        .map(|i| {
            let neighbors = neighborhoods.nearest(i, LINE_NEIGHBORS);
            if neighbors.len() < LINE_NEIGHBORS {
                return false;
            }
            let offsets = neighbors.iter().map(|n| points[n.index] - points[i]);
            let scatter: Matrix3 = offsets.map(|d| d * d.transpose()).sum();
            let (variances, axes) = Covariance::from_symmetric(&scatter).eigen();
            let ray = points[i] - cloud.sensor_origin();
            let cosine = axes.column(0).dot(&ray).abs() / ray.norm();
            variances[0] > LINE_RATIO * variances[1] && cosine > settings.max_angle.cos()
        })
        .collect();
    let mut position = 0;
    kept.retain(|_| {
        position += 1;
        !veil[position - 1]
    });
}
