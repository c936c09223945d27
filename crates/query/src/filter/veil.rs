//! Shadow (veil) points: a pixel that sees half of a near and half of a far surface returns a
//! depth in between, where nothing is.
//!
//! In an image, such a point continues along its viewing ray: one neighbour is nearer, the opposite
//! one farther, and both steps run almost along the ray. So do those of a surface seen at a low angle, which
//! [goes on](super::going_on) past them, along a row or a column or, where a rod is too thin for that, aslant.
//! Beside veils pixels often have no return at all: then the next one within a few pixels is the neighbour.
//! Without an image layout nothing tells a line of veil points from a rod that recedes from the camera: all stay.

use cloudtouch_geom::{Covariance, Point3, PointCloud, Vector3};
use cloudtouch_noise::SensorModel;
use rayon::prelude::*;

use super::VeilSettings;
use super::going_on::goes_on;
use super::lines::{Image, Line};

/// Along rows and along columns.
const ALONG: [[isize; 2]; 2] = [[1, 0], [0, 1]];
/// A neighbour is at most so many pixels away: those between gave no return.
const ACROSS_HOLES: isize = 3;
/// Aslant: along one of these a rod goes on that is too thin to do so along a row or a column.
const ASLANT: [[isize; 2]; 10] =
    [[1, 1], [1, -1], [1, 2], [1, -2], [2, 1], [2, -1], [1, 3], [1, -3], [3, 1], [3, -1]];
/// A rod too thin to go on along a line is at most so many pixels wide.
const THIN: isize = 8;

/// Returns the rows that go.
pub(super) fn drop_veil(
    cloud: &PointCloud,
    kept: &mut Vec<usize>,
    settings: &VeilSettings,
    sensor: &SensorModel,
) -> Vec<usize> {
    let Some((width, height)) = cloud.image_size.filter(|_| cloud.is_image()) else {
        return Vec::new();
    };
    let image = &Image { cloud, size: [width, height] };
    let least_cosine = settings.max_angle.cos();
    let from = image.cloud.sensor_origin();
    let steep = |&index: &usize| {
        let ray = image.cloud.points[index] - from;
        let lines =
            ALONG.map(|step| image.is_steep(index, image.line(index, step), &ray, least_cosine));
        (lines != [false; 2]).then_some((index, lines))
    };
    let steep: Vec<(usize, [bool; 2])> = kept.par_iter().filter_map(steep).collect();
    let stds = ranges_stds(image.cloud, steep.iter().map(|(index, _)| *index), sensor);
    let is_veil = |(&(index, is_steep), std): (&(usize, [bool; 2]), f64)| {
        let along = ALONG.iter().zip(is_steep).filter(|(_, is_steep)| *is_steep);
        let lines = along.map(|(step, _)| image.line(index, *step));
        let mut ends = lines.filter(|line| !image.goes_on(index, *line, std)).peekable();
        ends.peek()?;
        let ray = image.cloud.points[index] - from;
        let is_thin = ends.all(|line| image.is_before_both_sides(index, line, &ray));
        let mut aslant = ASLANT.iter().map(|step| image.line(index, *step));
        let is_rod = is_thin
            && aslant.any(|line| {
                image.is_steep(index, line, &ray, least_cosine) && image.goes_on(index, line, std)
            });
        (!is_rod).then_some(index)
    };
    let mut veil = steep.iter().zip(stds).filter_map(is_veil).peekable();
    // Both are in order.
    kept.extract_if(.., |index| veil.next_if_eq(index).is_some()).collect()
}

/// The standard deviation of the range of each of these returns, m; none of those whose noise is not known.
fn ranges_stds(
    cloud: &PointCloud,
    indices: impl Iterator<Item = usize>,
    sensor: &SensorModel,
) -> Vec<f64> {
    let returns = cloud.select(&indices.collect::<Vec<_>>());
    let from = cloud.sensor_origin();
    let std = |(place, noise): (&Point3, &Covariance)| {
        (place - from).try_normalize(0.0).map_or(0.0, |ray| noise.std_along(&ray))
    };
    match sensor.covariances(&returns) {
        Ok(noise) => returns.points.iter().zip(noise.iter()).map(std).collect(),
        // Whoever prepares the cloud is told what is wrong.
        Err(_) => vec![0.0; returns.len()],
    }
}

impl Image<'_> {
    /// Whether a return lies between a nearer and a farther one of a line, both almost along its ray.
    fn is_steep(&self, index: usize, line: Line, ray: &Vector3, least_cosine: f64) -> bool {
        let point = &self.cloud.points[index];
        // PERF: without roots, for of most pixels no step runs along the ray.
        let least = least_cosine * least_cosine * ray.norm_squared();
        let next = |sign: isize| {
            let other = (1..=ACROSS_HOLES).find_map(|step| self.on(index, line, sign * step));
            other.map_or(0.0, |other| along_ray(ray, &(other - point), least))
        };
        let backward = next(-1);
        backward != 0.0 && backward * next(1) < 0.0
    }

    /// Whether what a return is on is thin: on either side of a line something farther is not many pixels away, as beside
    /// a rod and not beside a veil, one side of which is the nearer surface.
    fn is_before_both_sides(&self, index: usize, line: Line, ray: &Vector3) -> bool {
        let (from, own) = (self.cloud.sensor_origin(), ray.norm_squared());
        let is_farther = |places| {
            self.on(index, line, places).is_some_and(|other| (other - from).norm_squared() > own)
        };
        [-1, 1].into_iter().all(|sign| (1..=THIN).any(|step| is_farther(sign * step)))
    }

    /// Whether the surface of a return goes on along a line, given how well ranges are known, m.
    fn goes_on(&self, index: usize, line: Line, std: f64) -> bool {
        let from = self.cloud.sensor_origin();
        let inverse_range = |places| {
            let range = (self.on(index, line, places)? - from).norm();
            Some(1.0 / range)
        };
        goes_on(inverse_range, std)
    }
}

/// +1 when a step runs along the ray away from the sensor, −1 towards it, 0 when it does not run along the ray: when
/// the square of its cosine times that of the ray's length, m², is less than `least`.
fn along_ray(ray: &Vector3, step: &Vector3, least: f64) -> f64 {
    let along = step.dot(ray);
    if along * along > least * step.norm_squared() { along.signum() } else { 0.0 }
}
