//! What can be wrong with a matrix that is to be a covariance.

use crate::message::number;

/// Why a matrix is not a covariance.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CovarianceError {
    /// An entry is NaN or infinite.
    #[error("covariance entry ({row}, {column}) is {}: every entry must be finite", number(*value))]
    NotFinite {
        /// Row of the entry, from 0.
        row: usize,
        /// Column of the entry, from 0.
        column: usize,
        /// What was found.
        value: f64,
    },
    /// An entry is so large that sums of it overflow.
    #[error("covariance entry ({row}, {column}) is {value:e} m²: entries go up to 1e200 m²")]
    TooLarge {
        /// Row of the entry, from 0.
        row: usize,
        /// Column of the entry, from 0.
        column: usize,
        /// What was found.
        value: f64,
    },
    /// The matrix differs from its transpose by more than rounding.
    #[error(
        "covariance is not symmetric: entry ({row}, {column}) differs from its mirror by {}",
        number(*difference)
    )]
    NotSymmetric {
        /// Row of the first entry that differs.
        row: usize,
        /// Column of the first entry that differs.
        column: usize,
        /// Difference from the mirrored entry.
        difference: f64,
    },
    /// The matrix has a negative eigenvalue beyond rounding.
    #[error(
        "covariance has the negative eigenvalue {}: variances cannot be negative",
        number(*eigenvalue)
    )]
    Negative {
        /// The smallest eigenvalue.
        eigenvalue: f64,
    },
}
