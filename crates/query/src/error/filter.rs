//! Why a cloud could not be filtered.

use cloudtouch_geom::message::number;
use cloudtouch_noise::NoiseError;

/// A setting of the pipeline that is out of range, or a cloud whose lists do not fit together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// The cloud does not have one of something for each point.
    #[error("{count} {what} for {points} points: give one for each, or none")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many points there are.
        points: usize,
    },
    /// The range limits are not 0 ≤ min < max.
    #[error("range limits {} m to {} m: need 0 <= min < max", number(*min), number(*max))]
    Range {
        /// Lower limit, m.
        min: f64,
        /// Upper limit, m.
        max: f64,
    },
    /// The padding of a robot link is negative or not finite.
    #[error("robot padding {} m: give a finite value of 0 or more", number(*value))]
    Padding {
        /// What was given, m.
        value: f64,
    },
    /// The pose of a robot link has an entry that is not finite.
    #[error("the pose of a robot link contains {}: every entry must be finite", number(*value))]
    LinkPose {
        /// What was found.
        value: f64,
    },
    /// The veil angle is not between 0 and 90 degrees.
    #[error("veil angle {} rad: give one between 0 and pi/2", number(*value))]
    VeilAngle {
        /// What was given, rad.
        value: f64,
    },
    /// The outlier settings make no sense.
    #[error(
        "outliers by {neighbors} neighbours and {} deviations: need at least one neighbour, and deviations \
         above 0",
        number(*deviations)
    )]
    Outliers {
        /// Neighbours asked for.
        neighbors: usize,
        /// Deviations asked for.
        deviations: f64,
    },
    /// The cloud does not have as many points as its image has pixels.
    #[error(
        "the cloud has {points} points and an image of {width} x {height}: give one for each pixel, \
         NaN where there is no return"
    )]
    ImageSize {
        /// How many points.
        points: usize,
        /// Pixels in a row.
        width: usize,
        /// Rows of the image.
        height: usize,
    },
    /// The points do not fit into a collision map.
    #[error(transparent)]
    CollisionMap(#[from] NoiseError),
    /// The collision map resolution is not positive.
    #[error("collision map resolution {} m: give a positive value such as 0.01", number(*value))]
    Resolution {
        /// What was given, m.
        value: f64,
    },
}
