//! The sensors that have a text form.

use cloudtouch_geom::{Covariance, PointCloud};

use crate::error::{NoiseError, check_value_not_negative, check_value_positive};
use crate::finite::is_finite;
use crate::sensor::noise::SensorNoise;
use crate::sensor::ranging::{Kinect, Lidar, StereoCamera, TimeOfFlight};
use crate::sensor::{Sensor, checked_pose, position_noise};

/// How a sensor errs: the position noise Σᵢ of a point (§3.2 of the paper).
///
/// The text forms that [`FromStr`](std::str::FromStr) reads and [`Display`](std::fmt::Display)
/// writes are given with each variant. Where a viewing ray matters, it runs from the origin of
/// [`PointCloud::sensor_pose`] to the point, and the depth of a camera is measured along the z axis of
/// that pose; see [`position_noise`] for when its turn is believed. For sensors that are not here see
/// [`Sensor`].
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
    /// `stereo:BASELINE,FOCAL_PX,DISPARITY_STD`: see [`StereoCamera`].
    Stereo {
        /// Distance between the two cameras, m.
        baseline: f64,
        /// Focal length, pixels.
        focal_px: f64,
        /// Standard deviation of the disparity, pixels.
        disparity_std: f64,
    },
    /// `kinect`: see [`Kinect`].
    Kinect,
    /// `tof:STD,PER_METRE`: see [`TimeOfFlight`].
    TimeOfFlight {
        /// Standard deviation of a range close by, m.
        std: f64,
        /// What each metre of range adds to it, m.
        per_metre: f64,
    },
    /// `lidar:RANGE_STD,BEAM_RAD`: see [`Lidar`].
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
    /// Whether it is a camera, which sees only what is before it.
    pub fn is_camera(&self) -> bool {
        matches!(self, Self::Stereo { .. } | Self::Kinect | Self::TimeOfFlight { .. })
    }

    /// Where the depth of a stereo camera errs by a third of itself, m: a disparity of three standard deviations, and
    /// farther away it is not told from none. Infinite for all others.
    pub fn farthest(&self) -> f64 {
        match *self {
            Self::Stereo { baseline, focal_px, disparity_std } => {
                baseline * focal_px / (3.0 * disparity_std)
            }
            _ => f64::INFINITY,
        }
    }

    /// Checks the values of the model.
    ///
    /// # Errors
    /// When a standard deviation or angle is negative, a baseline, focal length or resolution is
    /// not positive, or any of them is not finite or more than 1e10.
    pub fn validate(&self) -> Result<(), NoiseError> {
        match *self {
            Self::Exact | Self::PerPoint => Ok(()),
            Self::Isotropic { std } => check_value_not_negative("the standard deviation", std),
            Self::Axes { stds: [x, y, z] } => {
                check_value_not_negative("the standard deviation along x", x)?;
                check_value_not_negative("the standard deviation along y", y)?;
                check_value_not_negative("the standard deviation along z", z)
            }
            Self::Stereo { baseline, focal_px, disparity_std } => {
                StereoCamera { baseline, focal_px, disparity_std }.validate()
            }
            Self::Kinect => Kinect.validate(),
            Self::TimeOfFlight { std, per_metre } => TimeOfFlight { std, per_metre }.validate(),
            Self::Lidar { range_std, beam_rad } => Lidar { range_std, beam_rad }.validate(),
            Self::Grid { resolution } => check_value_positive("the grid resolution", resolution),
        }
    }

    /// The position noise Σᵢ of every point of a cloud, in its frame, m².
    ///
    /// # Errors
    /// When [`validate`](Self::validate) objects, the sensor pose is not finite, a covariance
    /// leaves the range of `f64`, or per-point covariances are asked for and missing, too few or
    /// not finite.
    pub fn covariances(&self, cloud: &PointCloud) -> Result<SensorNoise, NoiseError> {
        self.validate()?;
        checked_pose(&cloud.from_sensor())?;
        match *self {
            Self::Exact => uniform(Covariance::zero(), cloud),
            Self::Isotropic { std } => uniform(Covariance::isotropic(std * std), cloud),
            Self::Axes { stds } => uniform(Covariance::diagonal(stds.map(|s| s * s)), cloud),
            Self::Grid { resolution } => {
                uniform(Covariance::isotropic(resolution * resolution / 12.0), cloud)
            }
            Self::Stereo { baseline, focal_px, disparity_std } => {
                position_noise(&StereoCamera { baseline, focal_px, disparity_std }, cloud)
            }
            Self::Kinect => position_noise(&Kinect, cloud),
            Self::TimeOfFlight { std, per_metre } => {
                position_noise(&TimeOfFlight { std, per_metre }, cloud)
            }
            Self::Lidar { range_std, beam_rad } => {
                position_noise(&Lidar { range_std, beam_rad }, cloud)
            }
            Self::PerPoint => brought(cloud),
        }
    }
}

fn uniform(covariance: Covariance, cloud: &PointCloud) -> Result<SensorNoise, NoiseError> {
    match cloud.points.first() {
        Some(&point) if !covariance.is_finite() => {
            Err(NoiseError::CovarianceNotFinite { index: 0, point })
        }
        _ => Ok(SensorNoise::uniform(covariance, cloud.len())),
    }
}

/// The covariances that a cloud brings; zero for missing returns.
fn brought(cloud: &PointCloud) -> Result<SensorNoise, NoiseError> {
    let all = cloud.covariances.as_ref().ok_or(NoiseError::NoCovariances)?;
    if all.len() != cloud.len() {
        let (points, covariances) = (cloud.len(), all.len());
        return Err(NoiseError::CovarianceCount { points, covariances });
    }
    let mut checked = Vec::with_capacity(all.len());
    for (index, (point, covariance)) in cloud.points.iter().zip(all).enumerate() {
        checked.push(if !is_finite(point) {
            Covariance::zero()
        } else if covariance.is_finite() {
            *covariance
        } else {
            return Err(NoiseError::CovarianceNotFinite { index, point: *point });
        });
    }
    Ok(checked.into())
}
