//! Why a method gives no answer.

use std::fmt;

use cloudtouch_noise::NoiseError;
use cloudtouch_svm::{ProblemError, SettingsError};

/// Which of the two clouds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    A,
    B,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "A",
            Self::B => "B",
        })
    }
}

/// Why a method gives no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum RivalError {
    /// A cloud has no points.
    #[error("cloud {side} has no points: nothing can be said of its collisions")]
    Empty { side: Side },
    /// A point is NaN, infinite or farther away than any scene.
    #[error("point {index} of cloud {side} is {point:?}: remove points that are not finite")]
    Point { side: Side, index: usize, point: [f64; 3] },
    /// The pose has an entry that is not finite.
    #[error("the pose has the entry {value}: every entry must be finite")]
    Pose { value: f64 },
    /// The standard deviation of the sensor is negative or not finite.
    #[error("the sensor's standard deviation is {value}: it must be finite and not negative")]
    Std { value: f64 },
    /// The wanted rank is 0, or there are fewer different points than that.
    #[error("no distance of rank {rank} among {points} different points of cloud B")]
    Rank { rank: usize, points: usize },
    /// The side of the boxes is not positive and finite.
    #[error("the side of a box is {value}: it must be positive and finite")]
    BoxSide { value: f64 },
    /// The object has a mesh that parry does not take.
    #[error("the object's mesh cannot be indexed: {reason}")]
    Mesh { reason: String },
    /// The index over a cloud could not be built.
    #[error("the points cannot be indexed: {reason}")]
    Index { reason: String },
    /// The noise model refused the cloud.
    #[error("the noise model refuses the cloud")]
    Noise(#[from] NoiseError),
    /// The points do not make a classification problem.
    #[error("the points make no classification problem")]
    Problem(#[from] ProblemError),
    /// The solver refused its settings.
    #[error("the solver refuses its settings")]
    Solver(#[from] SettingsError),
}
