//! What a sensor model has to say, and how it becomes the noise of a cloud.

pub(crate) mod model;
pub(crate) mod noise;
pub(crate) mod ranging;
mod spec;

use cloudtouch_geom::{Covariance, Point3, PointCloud, Pose, Vector3, unit};
use rayon::prelude::*;

use crate::error::NoiseError;
use crate::finite::is_finite;
use crate::sensor::noise::SensorNoise;

/// A sensor whose error depends on where a point is as it sees it.
///
/// [`StereoCamera`](crate::StereoCamera), [`Kinect`](crate::Kinect), [`TimeOfFlight`](crate::TimeOfFlight) and
/// [`Lidar`](crate::Lidar) are four; implement it for another one. [`SensorModel`](crate::SensorModel) gathers the known ones
/// under their text forms; a cloud whose noise comes from elsewhere brings it as
/// [`PointCloud::covariances`] and is read with [`SensorModel::PerPoint`](crate::SensorModel::PerPoint).
///
/// ```
/// use cloudtouch_geom::{Covariance, Point3, PointCloud};
/// use cloudtouch_noise::{NoiseError, Sensor, SensorModel, along_ray, position_noise};
///
/// /// One per cent of the range along the ray, a milliradian across it.
/// struct Sonar;
///
/// impl Sensor for Sonar {
///     fn validate(&self) -> Result<(), NoiseError> {
///         Ok(())
///     }
///
///     fn covariance(&self, place: &Point3) -> Covariance {
///         let range = place.coords.norm();
///         along_ray(place, 0.01 * range, 0.001 * range)
///     }
/// }
///
/// let mut cloud = PointCloud::from_points(vec![Point3::new(0.0, 0.0, 2.0)]);
/// let noise = position_noise(&Sonar, &cloud)?;
/// assert_eq!(noise[0].max_std(), 0.02);
///
/// // For a query: the cloud brings its noise along.
/// cloud.covariances = Some(noise.iter().copied().collect());
/// assert_eq!(SensorModel::PerPoint.covariances(&cloud)?[0], noise[0]);
/// # Ok::<(), NoiseError>(())
/// ```
pub trait Sensor {
    /// Checks the values of the model.
    ///
    /// # Errors
    /// When one of them is out of range.
    fn validate(&self) -> Result<(), NoiseError>;

    /// The position noise Σ of a point at `place`, m and m², both in the frame of the sensor.
    fn covariance(&self, place: &Point3) -> Covariance;

    /// Whether it sees only what is before it, along the z axis of its own frame, as cameras do.
    fn is_camera(&self) -> bool {
        false
    }
}

/// The position noise of every point of a cloud as `sensor` saw it, in the frame of the cloud; on all
/// threads of the pool.
///
/// The sensor stands at the origin of [`PointCloud::sensor_pose`] and is turned as this says. The
/// turn of a camera is believed only where it puts at least half of the points before the camera:
/// files state turns that their points are not in. Otherwise the camera is taken to look along the z
/// axis of the cloud's frame, as clouds in an optical frame have it. A missing return (a point that
/// is not finite) gets the zero covariance, to keep rows in step.
///
/// # Errors
/// When [`Sensor::validate`] objects, the sensor pose is not finite, or a covariance leaves the range
/// of `f64`.
pub fn position_noise(
    sensor: &(impl Sensor + Sync),
    cloud: &PointCloud,
) -> Result<SensorNoise, NoiseError> {
    sensor.validate()?;
    let pose = plausible_pose(sensor, cloud)?;
    let cloud_to_sensor = pose.inverse();
    let one = |(index, point): (usize, &Point3)| {
        if !is_finite(point) {
            return Ok(Covariance::zero());
        }
        let covariance = sensor.covariance(&cloud_to_sensor.transform_point(point));
        if covariance.is_finite() {
            Ok(covariance.rotated(pose.rotation()))
        } else {
            Err(NoiseError::CovarianceNotFinite { index, point: *point })
        }
    };
    let all: Vec<Result<Covariance, NoiseError>> =
        cloud.points.par_iter().enumerate().map(one).collect();
    // The first of the errors, whoever found it.
    let all: Result<Vec<Covariance>, NoiseError> = all.into_iter().collect();
    Ok(all?.into())
}

/// The pose of the sensor, without a turn that a camera cannot have had.
fn plausible_pose(sensor: &impl Sensor, cloud: &PointCloud) -> Result<Pose, NoiseError> {
    let stated = cloud.from_sensor();
    checked_pose(&stated)?;
    let axis = stated.transform_vector(&Vector3::z());
    let origin = cloud.sensor_origin();
    let finite = || cloud.points.iter().filter(|point| is_finite(point));
    let seen = finite().filter(|&point| (point - origin).dot(&axis) > 0.0).count();
    if sensor.is_camera() && 2 * seen < finite().count() {
        return Ok(Pose::from_translation(stated.translation()));
    }
    Ok(stated)
}

/// Whether a pose can be computed with.
pub(crate) fn checked_pose(pose: &Pose) -> Result<(), NoiseError> {
    match pose.non_finite_entry() {
        Some(value) => Err(NoiseError::SensorPose { value }),
        None => Ok(()),
    }
}

/// The standard deviation `along` the ray to a place in the frame of the sensor, and `across` it, m;
/// the larger of them in every direction for a place at the sensor itself, which has no ray.
pub fn along_ray(place: &Point3, along: f64, across: f64) -> Covariance {
    match unit(&place.coords) {
        Ok(direction) => Covariance::from_axis(&direction, along, across),
        Err(_) => Covariance::isotropic(along.max(across).powi(2)),
    }
}
