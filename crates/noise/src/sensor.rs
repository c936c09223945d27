//! Sensor models: how far a measured point may be from the surface point it saw.

use cloudtouch_geom::{Covariance, Point3, PointCloud, Vector3, unit};

use crate::NoiseError;

/// How a sensor errs: the position noise Σᵢ of a point (§3.2 of the paper).
///
/// The text forms that [`FromStr`](std::str::FromStr) reads and [`Display`](std::fmt::Display)
/// writes are given with each variant. Where a viewing ray matters, it runs from
/// [`PointCloud::sensor_origin`] to the point, and the depth of a camera is measured along the z
/// axis of the cloud's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SensorModel {
    /// `exact`: no position noise.
    Exact,
    /// `iso:STD`: the same standard deviation in every direction.
    Isotropic {
        /// Standard deviation, m.
        std: f64,
    },
    /// `axes:SX,SY,SZ`: a standard deviation for each axis of the cloud's frame, as airborne laser
    /// scanning has.
    Axes {
        /// Standard deviations along x, y and z, m.
        stds: [f64; 3],
    },
    /// `stereo:BASELINE,FOCAL_PX,DISPARITY_STD`: a stereo camera in its optical frame.
    ///
    /// A disparity error moves the point along its viewing ray, with a depth component of standard
    /// deviation z²/(f·b)·σ_d. Across the ray the standard deviation is half a pixel, z/(2f): the
    /// matched pixel is known, the place in it is not.
    Stereo {
        /// Distance between the two cameras, m.
        baseline: f64,
        /// Focal length, pixels.
        focal_px: f64,
        /// Standard deviation of the disparity, pixels.
        disparity_std: f64,
    },
    /// `kinect`: the structured-light camera measured by Nguyen, Izadi and Lovell (2012), in its
    /// optical frame.
    ///
    /// The depth component has the standard deviation 0.0012 + 0.0019 (z − 0.4)² m and errs along
    /// the viewing ray; across it 0.8 pixels, which are 0.0014 z. The fit was made for z from 0.5
    /// to 3 m, and surfaces seen at less than 60°; a steeper view is noisier than stated.
    Kinect,
    /// `lidar:RANGE_STD,BEAM_RAD`: a laser scanner.
    ///
    /// `range_std` acts along the ray. The return may come from anywhere in the footprint, a disc
    /// of diameter range · `beam_rad`; a uniform disc has a quarter of its diameter as standard
    /// deviation on each axis across the ray.
    Lidar {
        /// Standard deviation of the range, m.
        range_std: f64,
        /// Full divergence angle of the beam, rad.
        beam_rad: f64,
    },
    /// `grid:RESOLUTION`: centres of the occupied cells of a collision map, uniform over a cell:
    /// resolution²/12 on each axis. See [`quantize_to_grid`](crate::quantize_to_grid).
    Grid {
        /// Edge length of a cell, m.
        resolution: f64,
    },
    /// `per-point`: the covariances the cloud brings.
    PerPoint,
}

impl SensorModel {
    /// Checks the values of the model.
    ///
    /// # Errors
    /// When a standard deviation or angle is negative, a baseline, focal length or resolution is
    /// not positive, or any of them is not finite.
    pub fn validate(&self) -> Result<(), NoiseError> {
        match *self {
            Self::Exact | Self::Kinect | Self::PerPoint => Ok(()),
            Self::Isotropic { std } => check_not_negative("the standard deviation", std),
            Self::Axes { stds: [x, y, z] } => {
                check_not_negative("the standard deviation along x", x)?;
                check_not_negative("the standard deviation along y", y)?;
                check_not_negative("the standard deviation along z", z)
            }
            Self::Stereo { baseline, focal_px, disparity_std } => {
                check_positive("the baseline", baseline)?;
                check_positive("the focal length", focal_px)?;
                check_not_negative("the standard deviation of the disparity", disparity_std)
            }
            Self::Lidar { range_std, beam_rad } => {
                check_not_negative("the standard deviation of the range", range_std)?;
                check_not_negative("the beam divergence", beam_rad)
            }
            Self::Grid { resolution } => check_positive("the grid resolution", resolution),
        }
    }

    /// The position noise Σᵢ of every point of a cloud, in its frame, m².
    ///
    /// A missing return (a point that is not finite) gets the zero covariance, to keep rows in
    /// step. A camera sees less than 60° off its axis, so a point farther off, or behind it, counts
    /// as |z| deep but never as less than half its range. A point at the sensor itself has no ray;
    /// it gets the larger of its two standard deviations in every direction.
    ///
    /// # Errors
    /// When [`validate`](Self::validate) objects, the sensor origin is not finite, a covariance
    /// leaves the range of `f64`, or per-point covariances are asked for and missing, too few or
    /// not finite.
    pub fn covariances(&self, cloud: &PointCloud) -> Result<Vec<Covariance>, NoiseError> {
        self.validate()?;
        let origin = cloud.sensor_origin();
        if !is_finite(&origin) {
            return Err(NoiseError::SensorOrigin { origin });
        }
        let given = cloud.covariances.as_deref();
        if matches!(self, Self::PerPoint) {
            let covariances = given.ok_or(NoiseError::NoCovariances)?.len();
            if covariances != cloud.len() {
                return Err(NoiseError::CovarianceCount { points: cloud.len(), covariances });
            }
        }
        let one = |(index, point): (usize, &Point3)| {
            if !is_finite(point) {
                return Ok(Covariance::zero());
            }
            let covariance = match (self, given) {
                (Self::PerPoint, Some(all)) => all[index],
                _ => self.covariance_at(&(point - origin)),
            };
            if covariance.is_finite() {
                Ok(covariance)
            } else {
                Err(NoiseError::CovarianceNotFinite { index, point: *point })
            }
        };
        cloud.points.iter().enumerate().map(one).collect()
    }

    /// Σ of the point at `from_sensor`, for every model but `PerPoint`, which has none of its own.
    fn covariance_at(&self, from_sensor: &Vector3) -> Covariance {
        let range = from_sensor.norm();
        let depth = from_sensor.z.abs().max(0.5 * range);
        // A depth error moves the point along its ray, so it is longer than its depth component.
        let stretch = if depth > 0.0 { range / depth } else { 1.0 };
        match *self {
            Self::Exact | Self::PerPoint => Covariance::zero(),
            Self::Isotropic { std } => Covariance::isotropic(std * std),
            Self::Axes { stds } => Covariance::diagonal(stds.map(|s| s * s)),
            Self::Stereo { baseline, focal_px, disparity_std } => {
                let depth_std = depth * depth / (focal_px * baseline) * disparity_std;
                along_ray(from_sensor, depth_std * stretch, 0.5 * depth / focal_px)
            }
            Self::Kinect => {
                let depth_std = 0.0012 + 0.0019 * (depth - 0.4).powi(2);
                along_ray(from_sensor, depth_std * stretch, 0.0014 * depth)
            }
            Self::Lidar { range_std, beam_rad } => {
                along_ray(from_sensor, range_std, 0.25 * range * beam_rad)
            }
            Self::Grid { resolution } => Covariance::isotropic(resolution * resolution / 12.0),
        }
    }
}

/// Standard deviation `along` a ray and `across` it; the larger of them where there is no ray.
fn along_ray(ray: &Vector3, along: f64, across: f64) -> Covariance {
    match unit(ray) {
        Ok(direction) => Covariance::from_axis(&direction, along, across),
        Err(_) => Covariance::isotropic(along.max(across).powi(2)),
    }
}

pub(crate) fn is_finite(point: &Point3) -> bool {
    point.coords.iter().all(|v| v.is_finite())
}

pub(crate) fn check_positive(name: &'static str, value: f64) -> Result<(), NoiseError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(NoiseError::SensorValue { name, value, requirement: "positive" })
}

fn check_not_negative(name: &'static str, value: f64) -> Result<(), NoiseError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(NoiseError::SensorValue { name, value, requirement: "not negative" })
}
