//! Sensors that look along rays: stereo, structured-light and time-of-flight cameras, laser scanners.

use cloudtouch_geom::{Covariance, Point3};

use crate::error::{NoiseError, check_value_not_negative, check_value_positive};
use crate::sensor::{Sensor, along_ray};

/// A stereo camera.
///
/// A disparity error moves the point along its viewing ray, with a depth component of standard
/// deviation z²/(f·b)·σ_d. Across the ray the standard deviation is half a pixel, z/(2f): the matched
/// pixel is known, the place in it is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StereoCamera {
    /// Distance between the two cameras, m.
    pub baseline: f64,
    /// Focal length, pixels.
    pub focal_px: f64,
    /// Standard deviation of the disparity, pixels.
    pub disparity_std: f64,
}

impl Sensor for StereoCamera {
    fn validate(&self) -> Result<(), NoiseError> {
        check_value_positive("the baseline", self.baseline)?;
        check_value_positive("the focal length", self.focal_px)?;
        check_value_not_negative("the standard deviation of the disparity", self.disparity_std)
    }

    fn covariance(&self, place: &Point3) -> Covariance {
        let (depth, stretch) = depth_and_stretch(place);
        let depth_std = depth * depth / (self.focal_px * self.baseline) * self.disparity_std;
        along_ray(place, depth_std * stretch, 0.5 * depth / self.focal_px)
    }

    fn is_camera(&self) -> bool {
        true
    }
}

/// The structured-light camera measured by Nguyen, Izadi and Lovell (2012).
///
/// The depth component has the standard deviation 0.0012 + 0.0019 (z − 0.4)² m and errs along the
/// viewing ray; across it 0.8 pixels, which are 0.0014 z. The fit was made for z from 0.5 to 3 m, and
/// surfaces seen at less than 60°; a steeper view is noisier than stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Kinect;

impl Sensor for Kinect {
    fn validate(&self) -> Result<(), NoiseError> {
        Ok(())
    }

    fn covariance(&self, place: &Point3) -> Covariance {
        let (depth, stretch) = depth_and_stretch(place);
        let depth_std = 0.0012 + 0.0019 * (depth - 0.4).powi(2);
        along_ray(place, depth_std * stretch, 0.0014 * depth)
    }

    fn is_camera(&self) -> bool {
        true
    }
}

/// A time-of-flight camera.
///
/// The range errs along the viewing ray by `std` + `per_metre` · range. Across it the standard deviation is
/// 0.001 of the range, half a pixel at a focal length of 500.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeOfFlight {
    /// Standard deviation of a range close by, m.
    pub std: f64,
    /// What each metre of range adds to it, m.
    pub per_metre: f64,
}

impl Sensor for TimeOfFlight {
    fn validate(&self) -> Result<(), NoiseError> {
        check_value_not_negative("the standard deviation of the range", self.std)?;
        check_value_not_negative("what a metre adds to it", self.per_metre)
    }

    fn covariance(&self, place: &Point3) -> Covariance {
        let range = place.coords.norm();
        along_ray(place, self.std + self.per_metre * range, 0.001 * range)
    }

    fn is_camera(&self) -> bool {
        true
    }
}

/// A laser scanner.
///
/// `range_std` acts along the ray. The return may come from anywhere in the footprint, a disc of
/// diameter range · `beam_rad`; a uniform disc has a quarter of its diameter as standard deviation on
/// each axis across the ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lidar {
    /// Standard deviation of the range, m.
    pub range_std: f64,
    /// Full divergence angle of the beam, rad.
    pub beam_rad: f64,
}

impl Sensor for Lidar {
    fn validate(&self) -> Result<(), NoiseError> {
        check_value_not_negative("the standard deviation of the range", self.range_std)?;
        check_value_not_negative("the beam divergence", self.beam_rad)
    }

    fn covariance(&self, place: &Point3) -> Covariance {
        along_ray(place, self.range_std, 0.25 * place.coords.norm() * self.beam_rad)
    }
}

/// The depth of a place before a camera, m, and how much longer an error along its ray is than the
/// depth component of it.
///
/// A camera sees less than 60° off its axis, so a point farther off, or behind it, counts as |z| deep
/// but never as less than half its range.
fn depth_and_stretch(place: &Point3) -> (f64, f64) {
    let range = place.coords.norm();
    let depth = place.z.abs().max(0.5 * range);
    // The square of a range below 1e-162 m is 0, and so is its root.
    (depth, if range > 0.0 { range / depth } else { 1.0 })
}
