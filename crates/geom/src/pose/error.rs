//! What is wrong with a pose.

use crate::message::number;

/// What counts as rounding in R Rᵀ = I: files often hold six to nine digits, and four may leave 1.7e-4.
pub(super) const ROUNDING: f64 = 2e-4;

/// Why a matrix is not a rigid motion.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PoseError {
    /// An entry is NaN or infinite.
    #[error("pose entry ({row}, {column}) is {}: every entry must be finite", number(*value))]
    NotFinite {
        /// Row of the entry, from 0.
        row: usize,
        /// Column of the entry, from 0.
        column: usize,
        /// What was found.
        value: f64,
    },
    /// The last row is not 0 0 0 1.
    #[error("the last row of the pose is {found:?}, not [0, 0, 0, 1]: is the matrix row-major?")]
    LastRow {
        /// What was found.
        found: [f64; 4],
    },
    /// The 3×3 part stretches or shears.
    #[error(
        "the 3x3 part of the pose is not a rotation: R·Rᵀ differs from the identity by {error:.3e} \
         (at most {ROUNDING:e} is taken as rounding); remove scale and shear"
    )]
    NotOrthonormal {
        /// Largest entry of |R Rᵀ − I|.
        error: f64,
    },
    /// The quaternion is not of length one.
    #[error("the quaternion of the pose has the length {}: it must be 1", number(*length))]
    QuaternionLength {
        /// What was found.
        length: f64,
    },
    /// The 3×3 part mirrors.
    #[error("the 3x3 part of the pose mirrors (determinant {determinant:.3}): swap two axes back")]
    Mirrored {
        /// The determinant, about −1.
        determinant: f64,
    },
}
