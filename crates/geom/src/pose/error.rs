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
        "the 3x3 part of the pose is not a rotation: R·Rᵀ differs from the identity by {} \
         (at most {ROUNDING:e} is taken as rounding); remove scale and shear",
        beyond_rounding(*error)
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

/// In as few digits as show it to be more than rounding, and three behind the point at least.
fn beyond_rounding(error: f64) -> String {
    let shown = |digits: usize| format!("{error:.digits$e}");
    let is_beyond = |text: &String| text.parse().is_ok_and(|shown: f64| shown > ROUNDING);
    (3..16).map(shown).find(is_beyond).unwrap_or_else(|| format!("{error:e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_just_beyond_rounding_was_told_as_the_bound() {
        let told = |error: f64| PoseError::NotOrthonormal { error }.to_string();
        assert!(told(2.000_04e-4).contains("by 2.00004e-4 (at most 2e-4"), "{}", told(2.000_04e-4));
        assert!(told(0.25).contains("by 2.500e-1 ("), "{}", told(0.25));
        assert!(told(f64::INFINITY).contains("by inf ("), "{}", told(f64::INFINITY));
    }
}
