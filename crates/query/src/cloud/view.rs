//! A single depth image: what lies behind its surfaces was never seen.

use std::ops::Range;
use std::sync::OnceLock;

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_noise::{Neighborhoods, SensorNoise, typical_spacing};

/// How many times the angle between pixels a ray may miss the nearest measured one.
const ANGLE_TOLERANCE: f64 = 4.0;

/// Pixels whose neighbours tell the angle between pixels.
const SPACING_SAMPLE: usize = 200;

/// Standard deviations of the measured surface that count as clearly behind it.
const CLEARLY: f64 = 3.0;

/// Where the sensor stood, and the measured directions once they are needed.
#[derive(Debug)]
pub(crate) struct SingleView {
    /// In the cloud's local frame, m.
    sensor_origin: Point3,
    /// Which points of the cloud are those of the image.
    points: Range<usize>,
    rays: OnceLock<Option<Rays>>,
}

#[derive(Debug)]
struct Rays {
    directions: Neighborhoods,
    ranges: Vec<f64>,
    /// How far a direction may be from a measured one, as a distance on the unit sphere.
    tolerance: f64,
}

impl SingleView {
    pub(super) fn new(sensor_origin: Point3, points: Range<usize>) -> Self {
        Self { sensor_origin, points, rays: OnceLock::new() }
    }

    /// Whether the sensor, which looked along the ray to `point`, met a surface clearly before it
    /// (by three standard deviations of the `noise` of the points `measured`, which are all of the
    /// cloud); `None` where it did not look. All in the cloud's local frame.
    pub(crate) fn is_behind(
        &self,
        (measured, noise): (&[Point3], &SensorNoise),
        point: &Point3,
    ) -> Option<bool> {
        let measure = || self.measure(&measured[self.points.clone()]);
        let rays = self.rays.get_or_init(measure).as_ref()?;
        let offset = point - self.sensor_origin;
        let range = offset.norm();
        if range == 0.0 {
            return None;
        }
        let direction = Point3::from(offset / range);
        let nearest = rays.directions.nearest_to(&direction, 1);
        let ray = nearest.first().filter(|n| n.squared_distance.sqrt() <= rays.tolerance)?;
        let margin = CLEARLY * noise[self.points.start + ray.index].std_bound();
        Some(range > rays.ranges[ray.index] + margin)
    }

    fn measure(&self, measured: &[Point3]) -> Option<Rays> {
        let offsets: Vec<Vector3> = measured.iter().map(|p| p - self.sensor_origin).collect();
        let ranges: Vec<f64> = offsets.iter().map(Vector3::norm).collect();
        let directions: Vec<Point3> = offsets
            .iter()
            .zip(&ranges)
            .map(|(offset, &range)| Point3::from(offset / range.max(f64::MIN_POSITIVE)))
            .collect();
        let directions = Neighborhoods::try_new(directions).ok()?;
        let tolerance = ANGLE_TOLERANCE * typical_spacing(&directions, SPACING_SAMPLE);
        Some(Rays { directions, ranges, tolerance })
    }
}
