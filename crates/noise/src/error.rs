//! What can be wrong with a sensor, a cloud or the settings.

use cloudtouch_geom::Point3;
use cloudtouch_geom::message::{number, position};

use crate::settings_error::SettingsError;

/// Why uncertain points could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoiseError {
    /// The sensor has a name nobody knows.
    #[error(
        "unknown sensor `{spec}`: use exact, iso:STD, axes:SX,SY,SZ, \
         stereo:BASELINE,FOCAL_PX,DISPARITY_STD, kinect, tof:STD,PER_METRE, lidar:RANGE_STD,BEAM_RAD, \
         grid:RESOLUTION or per-point"
    )]
    UnknownSensor {
        /// What was given.
        spec: String,
    },
    /// The sensor has the wrong number of values, or one that is not a number.
    #[error("sensor `{spec}` does not read as `{form}`: {problem}")]
    SensorSyntax {
        /// What was given.
        spec: String,
        /// The right form.
        form: &'static str,
        /// What is wrong with it.
        problem: String,
    },
    /// A value of the sensor is out of range.
    #[error("{name} of the sensor is {}: it must be finite and {requirement}", number(*value))]
    SensorValue {
        /// Which value.
        name: &'static str,
        /// What was given.
        value: f64,
        /// The range it must be in.
        requirement: &'static str,
    },
    /// `per-point` noise was asked of a cloud that has none.
    #[error(
        "the cloud has no covariance per point: give covariance columns in its file, or another sensor"
    )]
    NoCovariances,
    /// The cloud does not have as many covariances as points.
    #[error("the cloud has {points} points and {covariances} covariances: give one for each point")]
    CovarianceCount {
        /// How many points.
        points: usize,
        /// How many covariances.
        covariances: usize,
    },
    /// The covariance of a point is not finite, or too large to be represented.
    #[error(
        "the covariance of point {index} at {} is not finite: remove the point or rescale the cloud",
        position(point)
    )]
    CovarianceNotFinite {
        /// Which point.
        index: usize,
        /// Where it is.
        point: Point3,
    },
    /// The sensor pose is not finite.
    #[error(
        "the sensor pose has the entry {}: give the pose the cloud was seen from",
        number(*value)
    )]
    SensorPose {
        /// What was found.
        value: f64,
    },
    /// A cloud is too large for the index.
    #[error("the cloud has {points} points, more than the 4294967295 an index can hold: split it")]
    TooManyPoints {
        /// How many points.
        points: usize,
    },
    /// A coordinate is so large that squared distances leave the range of `f64`.
    #[error(
        "point {index} at {} is beyond 1e150 m: check the unit, or remove the point",
        position(point)
    )]
    CoordinateRange {
        /// Which point.
        index: usize,
        /// Where it is.
        point: Point3,
    },
    /// The index could not be built.
    #[error("the index over {points} points could not be built: {reason}")]
    Index {
        /// How many points.
        points: usize,
        /// What the tree says.
        reason: String,
    },
    /// A setting is out of range.
    #[error(transparent)]
    Setting(#[from] SettingsError),
    /// The probability mass of the ellipsoids is out of range.
    #[error("kappa is {}: the {rule} radius needs a value in {range}", number(*kappa))]
    Kappa {
        /// What was given.
        kappa: f64,
        /// Which rule was asked for.
        rule: &'static str,
        /// The range it must be in.
        range: &'static str,
    },
    /// A point lies too many cells from the origin to be put on the grid.
    #[error(
        "point {index} at {} is more than 2^53 cells of {} m from the origin",
        position(point), number(*resolution)
    )]
    GridRange {
        /// Which point.
        index: usize,
        /// Where it is.
        point: Point3,
        /// Edge length of a cell, m.
        resolution: f64,
    },
}

/// No coordinate of a body is larger; squares of larger numbers, as covariances hold, may leave the range
/// of `f64`.
const MOST_VALUE: f64 = 1e10;

pub(crate) fn check_value_positive(name: &'static str, value: f64) -> Result<(), NoiseError> {
    check_value(value > 0.0, name, value, "positive")
}

pub(crate) fn check_value_not_negative(name: &'static str, value: f64) -> Result<(), NoiseError> {
    check_value(value >= 0.0, name, value, "not negative")
}

fn check_value(
    holds: bool,
    name: &'static str,
    value: f64,
    requirement: &'static str,
) -> Result<(), NoiseError> {
    if !holds || !value.is_finite() {
        Err(NoiseError::SensorValue { name, value, requirement })
    } else if value > MOST_VALUE {
        Err(NoiseError::SensorValue { name, value, requirement: "at most 1e10" })
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_points_are_spelled_in_few_digits() {
        let error = NoiseError::CoordinateRange { index: 3, point: Point3::new(0.5, -1e300, 2.0) };
        let expected = "point 3 at (0.5, -1e300, 2) is beyond 1e150 m: ";
        assert!(error.to_string().starts_with(expected), "{error}");
        let error = NoiseError::SensorValue { name: "std", value: -0.25, requirement: "positive" };
        assert!(error.to_string().starts_with("std of the sensor is -0.25: "), "{error}");
    }
}
