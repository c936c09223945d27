//! Shadow (veil) points: a pixel that sees half of a near and half of a far surface returns a
//! depth in between, where nothing is.
//!
//! In an image, such a point continues along its viewing ray: one neighbour is nearer, the opposite
//! one farther, and both steps run almost along the ray. So do those of a surface seen at a low angle, which
//! [goes on](super::going_on) past them. Beside veils pixels often have no return at all: then the next one
//! within a few pixels is the neighbour. Without an image layout the neighbours are the nearest points,
//! and a veil point is one whose neighbourhood is a line along the ray.

use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Vector3};
use cloudtouch_noise::{Neighborhoods, SensorModel};
use rayon::prelude::*;

use super::VeilSettings;
use super::going_on::goes_on;
use super::range::is_return_to;

/// A neighbour is at most so many pixels away: those between gave no return.
const ACROSS_HOLES: isize = 3;
/// Neighbours that decide whether an unorganised neighbourhood is a line along the ray.
const LINE_NEIGHBORS: usize = 10;
/// A neighbourhood counts as a line when its largest variance is this many times the next.
const LINE_RATIO: f64 = 9.0;

/// Returns the rows that go.
pub(super) fn drop_veil(
    cloud: &PointCloud,
    kept: &mut Vec<usize>,
    settings: &VeilSettings,
    sensor: &SensorModel,
) -> Vec<usize> {
    match cloud.image_size {
        Some((width, height)) if width > 1 && height > 1 => {
            drop_veil_of_image(&Image { cloud, size: [width, height] }, kept, settings, sensor)
        }
        _ => drop_veil_lines(cloud, kept, settings),
    }
}

/// A line of pixels through one.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// How many pixels are before it and after it on the line.
    before: usize,
    after: usize,
    /// How far apart two of them are in the list of all.
    apart: usize,
}

#[derive(Debug, Clone, Copy)]
struct Image<'a> {
    cloud: &'a PointCloud,
    /// Columns and rows.
    size: [usize; 2],
}

fn drop_veil_of_image(
    image: &Image<'_>,
    kept: &mut Vec<usize>,
    settings: &VeilSettings,
    sensor: &SensorModel,
) -> Vec<usize> {
    let least_cosine = settings.max_angle.cos();
    let from = image.cloud.sensor_origin();
    let steep = |&index: &usize| {
        let ray = image.cloud.points[index] - from;
        let lines = image.lines(index).map(|line| image.is_steep(index, line, &ray, least_cosine));
        (lines != [false; 2]).then_some((index, lines))
    };
    let steep: Vec<(usize, [bool; 2])> = kept.par_iter().filter_map(steep).collect();
    let stds = ranges_stds(image.cloud, steep.iter().map(|(index, _)| *index), sensor);
    let is_veil = |(&(index, is_steep), std): (&(usize, [bool; 2]), f64)| {
        let mut lines = image.lines(index).into_iter().zip(is_steep);
        let is_off = |(line, is_steep)| is_steep && !image.goes_on(index, line, std);
        lines.any(is_off).then_some(index)
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
    /// Its row and its column.
    fn lines(&self, index: usize) -> [Line; 2] {
        let [width, height] = self.size;
        let (row, column) = (index / width, index % width);
        [
            Line { before: column, after: width - 1 - column, apart: 1 },
            Line { before: row, after: height - 1 - row, apart: width },
        ]
    }

    /// The return so many pixels on along a line, if there is one.
    #[inline]
    fn on(&self, index: usize, line: Line, places: isize) -> Option<&Point3> {
        let (most, far) =
            (if places < 0 { line.before } else { line.after }, places.unsigned_abs());
        let other = index.checked_add_signed(places * line.apart as isize)?;
        let place = self.cloud.points.get(other).filter(|_| far <= most)?;
        is_return_to(&self.cloud.sensor_origin(), place).then_some(place)
    }

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

fn drop_veil_lines(
    cloud: &PointCloud,
    kept: &mut Vec<usize>,
    settings: &VeilSettings,
) -> Vec<usize> {
    let points: Vec<Point3> = kept.iter().map(|&i| cloud.points[i]).collect();
    let Ok(neighborhoods) = Neighborhoods::new(points) else { return Vec::new() };
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
    let mut is_veil = veil.into_iter();
    kept.extract_if(.., |_| is_veil.next() == Some(true)).collect()
}
