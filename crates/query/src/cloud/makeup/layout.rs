//! Whether the rows and columns of an image are those of a camera or of a laser scanner.

use cloudtouch_geom::{Point3, PointCloud, Vector3};
use cloudtouch_noise::SensorModel;

use super::bearing::begin;
use super::panorama::Cones;
use super::{panorama, pinhole};

/// A camera sees nothing so far off its axis (cosine): 80°.
pub(super) const BESIDE: f64 = 0.17;
/// What is so near to the axis of a scanner (cosine) it does not see: 10°.
const ALONG: f64 = 0.985;
/// Cones are about the vertical of a scanner where their axis is no farther off than this (cosine): 18°.
const UPRIGHT: f64 = 0.95;
/// A direction is off where a camera has it in two ways, and off a scanner's line in one: of equal errors half are
/// larger than so many times as much.
const TWO_WAYS: f64 = 1.7456;

/// Half of the returns of a scanner are no farther from the cone of their line than this part of what parts lines: seen
/// from where it was not, what is near is.
const MOST_OF_APART: f64 = 0.15;

/// What the rows and columns of an image tell of its sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::cloud) struct Layout {
    /// Of a scanner, the bearing about z in its frame where those of its view begin, rad; `None` of a camera, and of
    /// neither.
    pub scanner: Option<f64>,
    /// Whether neither at the place stated for it can have taken it.
    pub is_misplaced: bool,
}

impl Layout {
    /// Whether a camera at the place stated for it can have taken it.
    pub(super) fn is_camera(&self) -> bool {
        self.scanner.is_none() && !self.is_misplaced
    }

    /// Of an image, given the sensor stated for it and the points that were kept. What is not a camera as stated, and has
    /// all its returns ahead, is whichever fits better: a part of a panorama that looks ahead is still one.
    pub(in crate::cloud) fn of(
        image: &PointCloud,
        sensor: &SensorModel,
        points: &[Point3],
    ) -> Self {
        let place = image.sensor_origin();
        let rays = || points.iter().map(|p| p - place);
        let by_pinhole = || pinhole::misfit(image, &place);
        let of_camera = |misfit: Option<f64>| Self {
            scanner: None,
            is_misplaced: misfit == Some(f64::INFINITY),
        };
        if sensor.is_camera() {
            return of_camera(by_pinhole());
        }
        let by_cones = || panorama::fit(image, &place);
        let vertical = image.from_sensor().transform_vector(&Vector3::z());
        let is_upright = |cones: &Cones| cones.axis.dot(&vertical).abs() > UPRIGHT;
        let Some(forward) = ahead(rays()) else {
            let cones = by_cones();
            let begin = cones.filter(is_upright).and_then(|cones| begin(image, &place, &cones));
            let is_misplaced = cones.is_some_and(|cones| cones.misfit == f64::INFINITY);
            return Self { scanner: Some(begin.unwrap_or(0.0)), is_misplaced };
        };
        let camera = by_pinhole();
        // A panorama is told by its bearings, which there are none of along the axis of the scanner.
        let is_along = |ray: Vector3| ray.dot(&vertical).abs() > ALONG * ray.norm();
        if forward.dot(&vertical).abs() > ALONG || rays().any(is_along) {
            return of_camera(camera);
        }
        let is_better = |cones: &Cones| {
            cones.misfit <= MOST_OF_APART * cones.apart
                && camera.is_some_and(|camera| TWO_WAYS * cones.misfit < camera)
        };
        let scanner = by_cones().filter(is_upright).filter(is_better);
        match scanner.and_then(|cones| begin(image, &place, &cones)) {
            Some(begin) => Self { scanner: Some(begin), is_misplaced: false },
            None => of_camera(camera),
        }
    }
}

/// Where a sensor looks that all of these lie ahead of, as those of a camera do; `None` where they do not.
fn ahead(mut rays: impl Iterator<Item = Vector3> + Clone) -> Option<Vector3> {
    let forward = rays.clone().filter_map(|ray| ray.try_normalize(0.0)).sum::<Vector3>();
    let forward = forward.try_normalize(0.0).unwrap_or_else(Vector3::z);
    rays.all(|ray| ray.dot(&forward) >= BESIDE * ray.norm()).then_some(forward)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIDAR: SensorModel = SensorModel::Lidar { range_std: 0.01, beam_rad: 0.003 };

    /// Of rows and columns about straight ahead along x, of a camera or a scanner with a view so wide and high (rad),
    /// at a wall and a pillar.
    fn image(is_scanner: bool, [wide, high]: [f64; 2]) -> PointCloud {
        let (columns, rows) = (60, 16);
        let pixel = |i: usize| {
            let part = |k: usize, of: usize| k as f64 / (of - 1) as f64 - 0.5;
            let (a, b) = (wide * part(i % columns, columns), high * part(i / columns, rows));
            let ray = match is_scanner {
                true => Vector3::new(b.cos() * a.cos(), b.cos() * a.sin(), b.sin()),
                false => Vector3::new(1.0, a, b),
            };
            let range = if (20..30).contains(&(i % columns)) { 1.0 } else { 3.0 };
            Point3::from(ray * range)
        };
        let points = (0..columns * rows).map(pixel).collect();
        PointCloud { image_size: Some((columns, rows)), ..PointCloud::from_points(points) }
    }

    fn told(image: &PointCloud, sensor: &SensorModel) -> [bool; 2] {
        let Layout { scanner, is_misplaced } = Layout::of(image, sensor, &image.points);
        [scanner.is_some(), is_misplaced]
    }

    #[test]
    fn a_sector_of_a_panorama_was_taken_for_the_image_of_a_camera() {
        let iso = SensorModel::Isotropic { std: 0.01 };
        for view in [[0.5, 0.3], [1.0, 0.5], [1.8, 0.5], [2.6, 0.4]] {
            for sensor in [&iso, &LIDAR] {
                assert_eq!(told(&image(true, view), sensor), [true, false], "{view:?}");
                assert_eq!(told(&image(false, view), sensor), [false, false], "{view:?}");
            }
        }
    }

    #[test]
    fn what_a_camera_or_a_scanner_looks_at_from_elsewhere_is_of_neither() {
        for is_scanner in [false, true] {
            let mut image = image(is_scanner, [1.8, 0.8]);
            image.points.iter_mut().for_each(|point| *point += Vector3::new(0.3, 0.5, 0.4));
            assert_eq!(told(&image, &LIDAR), [false, true], "{is_scanner}");
        }
    }
}
