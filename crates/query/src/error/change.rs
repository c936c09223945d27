//! Why a cloud cannot be changed as asked.

use cloudtouch_geom::message::number;

use super::prepare::PrepareError;

/// Why a cloud cannot be changed as asked; it is left as it was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChangeError {
    /// The cloud has no such point.
    #[error("there is no point {index}: the cloud has {count}, counted from 0 as filtered")]
    NoSuchPoint {
        /// What was asked for.
        index: usize,
        /// Points of the cloud.
        count: usize,
    },
    /// A point is named twice.
    #[error("point {index} is named twice: name each point once")]
    Twice {
        /// Which.
        index: usize,
    },
    /// Every point would go.
    #[error("all {count} points would be removed: a cloud has at least one; drop it instead")]
    NothingLeft {
        /// Points of the cloud.
        count: usize,
    },
    /// A coordinate is beyond what a cloud holds.
    #[error(
        "point {index} would get the coordinate {}: give metres, finite and at most 1e10",
        number(*value)
    )]
    Coordinate {
        /// Which point.
        index: usize,
        /// What was given, m.
        value: f64,
    },
    /// A frame that is no depth image does not tell what it saw through.
    #[error(
        "the frame is no depth image, so that what it saw through is not known: give the organised \
         cloud, or insert its points"
    )]
    NotAnImage,
    /// A scan of which every point is in the cloud already: it would count as a second look, which it is not.
    #[error(
        "all {count} points of the scan are in the cloud already: it tells nothing new; give each scan once"
    )]
    RepeatedScan {
        /// Its points, as filtered.
        count: usize,
    },
    /// What was given cannot be prepared, or not together with the rest.
    #[error(transparent)]
    Prepare(#[from] PrepareError),
}
