//! What can be wrong with a sensor, a cloud or the settings.

use cloudtouch_geom::Point3;

/// Why uncertain points could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoiseError {
    /// The sensor has a name nobody knows.
    #[error(
        "unknown sensor `{spec}`: use exact, iso:STD, axes:SX,SY,SZ, \
         stereo:BASELINE,FOCAL_PX,DISPARITY_STD, kinect, lidar:RANGE_STD,BEAM_RAD, \
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
    #[error("{name} of the sensor is {value}: it must be finite and {requirement}")]
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
        "the covariance of point {index} at {point} is not finite: remove the point or rescale the cloud"
    )]
    CovarianceNotFinite {
        /// Which point.
        index: usize,
        /// Where it is.
        point: Point3,
    },
    /// The sensor origin is not finite.
    #[error("the sensor origin {origin} is not finite: give the position the cloud was seen from")]
    SensorOrigin {
        /// What was given.
        origin: Point3,
    },
    /// A cloud is too large for the index.
    #[error("the cloud has {points} points, more than the 4294967295 an index can hold: split it")]
    TooManyPoints {
        /// How many points.
        points: usize,
    },
    /// A coordinate is so large that squared distances leave the range of `f64`.
    #[error("point {index} at {point} is beyond 1e150 m: check the unit, or remove the point")]
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
    #[error("setting `{name}` is {value}: it must be finite and {requirement}")]
    Setting {
        /// Which setting.
        name: &'static str,
        /// What was given.
        value: f64,
        /// The range it must be in.
        requirement: &'static str,
    },
    /// The probability mass of the ellipsoids is out of range.
    #[error("kappa is {kappa}: the {rule} radius needs a value in {range}")]
    Kappa {
        /// What was given.
        kappa: f64,
        /// Which rule was asked for.
        rule: &'static str,
        /// The range it must be in.
        range: &'static str,
    },
    /// A point lies too many cells from the origin to be put on the grid.
    #[error("point {index} at {point} is more than 2^53 cells of {resolution} m from the origin")]
    GridRange {
        /// Which point.
        index: usize,
        /// Where it is.
        point: Point3,
        /// Edge length of a cell, m.
        resolution: f64,
    },
}
