//! How covariances are made.

use super::{Covariance, Form};
use crate::covariance::axis_form::AxisForm;
use crate::covariance::error::CovarianceError;
use crate::covariance::symmetric::Symmetric;
use crate::covariance::variance::not_negative;
use crate::vectors::{Matrix3, UnitVector3, Vector3};

/// Relative size of what counts as rounding when a matrix is checked.
const ROUNDING: f64 = 1e-9;
/// Larger entries could overflow when a few are added or a pair is multiplied.
const LARGEST: f64 = 1e200;

impl Covariance {
    /// No uncertainty at all.
    pub const fn zero() -> Self {
        Self(Form::Isotropic(0.0))
    }

    /// The same variance (m²) in every direction; a negative one counts as zero.
    pub fn isotropic(variance: f64) -> Self {
        Self(Form::Isotropic(not_negative(variance)))
    }

    /// Independent variances (m²) along x, y and z; negative ones count as zero.
    pub fn diagonal(variances: [f64; 3]) -> Self {
        let [xx, yy, zz] = variances.map(not_negative);
        Self::full(Symmetric { xx, xy: 0.0, xz: 0.0, yy, yz: 0.0, zz })
    }

    /// `along`² in the direction `axis` and `across`² in the plane across it.
    ///
    /// Both are standard deviations in metres, of which the sign does not matter.
    pub fn from_axis(axis: &UnitVector3, along: f64, across: f64) -> Self {
        let (along, across) = (along.abs(), across.abs());
        if along == across {
            return Self::isotropic(along * along);
        }
        Self(Form::Axis(AxisForm { axis: *axis, along, across }))
    }

    /// Checks a matrix and takes it; a negative eigenvalue within rounding becomes zero.
    ///
    /// # Errors
    /// When an entry is not finite or beyond 1e200 m², or the matrix is not symmetric, or it has a
    /// negative eigenvalue; rounding is 1e-9 of its largest entry.
    pub fn try_from_matrix(matrix: &Matrix3) -> Result<Self, CovarianceError> {
        for row in 0..3 {
            for column in 0..3 {
                let value = matrix[(row, column)];
                if !value.is_finite() {
                    return Err(CovarianceError::NotFinite { row, column, value });
                }
                if value.abs() > LARGEST {
                    return Err(CovarianceError::TooLarge { row, column, value });
                }
            }
        }
        let scale = matrix.amax();
        for (row, column) in [(0, 1), (0, 2), (1, 2)] {
            let difference = matrix[(row, column)] - matrix[(column, row)];
            if difference.abs() > ROUNDING * scale {
                return Err(CovarianceError::NotSymmetric { row, column, difference });
            }
        }
        let symmetric = Symmetric::average(matrix);
        let eigenvalue = symmetric.eigen().0.min();
        if eigenvalue < -ROUNDING * scale {
            return Err(CovarianceError::Negative { eigenvalue });
        }
        Ok(Self::full(symmetric.semidefinite()))
    }

    /// The covariance nearest to a matrix: its average with its transpose, negative eigenvalues made
    /// zero. One that is not finite stays so, see [`Self::is_finite`].
    ///
    /// For what is a covariance but for rounding, such as a sum of outer products. Use
    /// [`Self::try_from_matrix`] for anything a user supplied.
    pub fn from_symmetric(matrix: &Matrix3) -> Self {
        Self::full(Symmetric::average(matrix).semidefinite())
    }

    /// Rebuilds from variances along orthonormal axes (columns); negative variances become zero.
    pub fn from_eigen(eigenvalues: &Vector3, axes: &Matrix3) -> Self {
        let clamped = eigenvalues.map(not_negative);
        Self::congruent(axes, &Matrix3::from_diagonal(&clamped))
    }

    /// T M Tᵀ for a semidefinite M, which it then is itself up to rounding.
    pub(super) fn congruent(by: &Matrix3, semidefinite: &Matrix3) -> Self {
        let mut symmetric = Symmetric::average(&(by * semidefinite * by.transpose()));
        for variance in [&mut symmetric.xx, &mut symmetric.yy, &mut symmetric.zz] {
            *variance = not_negative(*variance);
        }
        Self::full(symmetric)
    }
}
