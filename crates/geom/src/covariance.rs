//! Symmetric positive semidefinite 3×3 matrices: zero and singular ones are ordinary values.

use crate::message::number;
use crate::{Matrix3, Vector3};

/// A covariance in square metres; symmetric and positive semidefinite by construction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Covariance {
    xx: f64,
    xy: f64,
    xz: f64,
    yy: f64,
    yz: f64,
    zz: f64,
}

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
        /// Row of the worst entry.
        row: usize,
        /// Column of the worst entry.
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

/// Relative size of what counts as rounding when a matrix is checked.
const ROUNDING: f64 = 1e-9;
/// Jacobi sweeps at most; more than six have not been seen.
const MOST_SWEEPS: usize = 20;
/// Larger entries could overflow when a few are added or a pair is multiplied.
const LARGEST: f64 = 1e200;

impl Covariance {
    /// No uncertainty at all.
    pub const fn zero() -> Self {
        Self { xx: 0.0, xy: 0.0, xz: 0.0, yy: 0.0, yz: 0.0, zz: 0.0 }
    }

    /// The same variance (m²) in every direction; a negative one counts as zero.
    pub fn isotropic(variance: f64) -> Self {
        Self::diagonal([variance; 3])
    }

    /// The variance (m²) where it is the same in every direction, else `None`.
    pub fn isotropic_variance(&self) -> Option<f64> {
        let is_round = self.xx == self.yy && self.yy == self.zz;
        let is_diagonal = self.xy == 0.0 && self.xz == 0.0 && self.yz == 0.0;
        (is_round && is_diagonal).then_some(self.xx)
    }

    /// Independent variances (m²) along x, y and z; negative ones count as zero.
    pub fn diagonal(variances: [f64; 3]) -> Self {
        let [xx, yy, zz] = variances.map(not_negative);
        Self { xx, yy, zz, ..Self::zero() }
    }

    /// `along`² in the direction `axis` (unit length) and `across`² in the plane across it.
    ///
    /// Both are standard deviations in metres.
    pub fn from_axis(axis: &Vector3, along: f64, across: f64) -> Self {
        let extra = along * along - across * across;
        Self::from_symmetric(
            &(Matrix3::identity() * (across * across) + axis * axis.transpose() * extra),
        )
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
        let symmetric = Self::symmetrized(matrix);
        let (eigenvalues, axes) = symmetric.raw_eigen();
        let eigenvalue = eigenvalues.min();
        if eigenvalue < -ROUNDING * scale {
            return Err(CovarianceError::Negative { eigenvalue });
        }
        if eigenvalue < 0.0 {
            return Ok(Self::from_eigen(&eigenvalues, &axes));
        }
        Ok(symmetric)
    }

    /// Takes a matrix known to be positive semidefinite up to rounding, such as a sum or a
    /// congruence of covariances; averages it with its transpose.
    ///
    /// Not checked: use [`Self::try_from_matrix`] for anything a user supplied.
    pub fn from_symmetric(matrix: &Matrix3) -> Self {
        let mut symmetric = Self::symmetrized(matrix);
        for variance in [&mut symmetric.xx, &mut symmetric.yy, &mut symmetric.zz] {
            *variance = not_negative(*variance);
        }
        symmetric
    }

    fn symmetrized(m: &Matrix3) -> Self {
        Self {
            xx: m[(0, 0)],
            xy: 0.5 * (m[(0, 1)] + m[(1, 0)]),
            xz: 0.5 * (m[(0, 2)] + m[(2, 0)]),
            yy: m[(1, 1)],
            yz: 0.5 * (m[(1, 2)] + m[(2, 1)]),
            zz: m[(2, 2)],
        }
    }

    /// Rebuilds from variances along orthonormal axes (columns); negative variances become zero.
    pub fn from_eigen(eigenvalues: &Vector3, axes: &Matrix3) -> Self {
        let clamped = eigenvalues.map(not_negative);
        Self::from_symmetric(&(axes * Matrix3::from_diagonal(&clamped) * axes.transpose()))
    }

    /// The full matrix, m².
    pub fn matrix(&self) -> Matrix3 {
        Matrix3::new(
            self.xx, self.xy, self.xz, self.xy, self.yy, self.yz, self.xz, self.yz, self.zz,
        )
    }

    /// The six distinct entries xx, xy, xz, yy, yz, zz.
    pub fn upper_triangle(&self) -> [f64; 6] {
        [self.xx, self.xy, self.xz, self.yy, self.yz, self.zz]
    }

    /// Variances in descending order and the unit axes (columns, right-handed or not) they
    /// belong to.
    pub fn eigen(&self) -> (Vector3, Matrix3) {
        let (values, axes) = self.raw_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| values[j].total_cmp(&values[i]));
        (
            Vector3::from_fn(|k, _| values[order[k]].max(0.0)),
            Matrix3::from_fn(|row, k| axes[(row, order[k])]),
        )
    }

    fn raw_eigen(&self) -> (Vector3, Matrix3) {
        let scale = self.matrix().amax();
        if scale == 0.0 || !scale.is_finite() {
            return (Vector3::repeat(scale), Matrix3::identity());
        }
        // Scaled to unit size: the iteration squares entries, and 1e-160² underflows.
        let (values, axes) = jacobi(self.matrix() / scale);
        (values * scale, axes)
    }

    /// The symmetric root S with S S = Σ, in metres.
    pub fn sqrt(&self) -> Matrix3 {
        let (values, axes) = self.eigen();
        axes * Matrix3::from_diagonal(&values.map(f64::sqrt)) * axes.transpose()
    }

    /// Variance (m²) of the component along `direction`, which need not have unit length.
    pub fn variance_along(&self, direction: &Vector3) -> f64 {
        direction.dot(&(self.matrix() * direction)).max(0.0)
    }

    /// Standard deviation (m) of the component along `direction`.
    pub fn std_along(&self, direction: &Vector3) -> f64 {
        self.variance_along(direction).sqrt()
    }

    /// An upper bound on the standard deviation in any direction: √trace ≥ √λ₁.
    ///
    /// At most √3 too large, and much cheaper than the eigenvalue; see [`Self::max_std`].
    pub fn std_bound(&self) -> f64 {
        (self.xx + self.yy + self.zz).sqrt()
    }

    /// The largest standard deviation in any direction, m.
    pub fn max_std(&self) -> f64 {
        self.isotropic_variance().unwrap_or_else(|| self.eigen().0[0]).sqrt()
    }

    /// Whether there is no uncertainty at all.
    pub fn is_zero(&self) -> bool {
        *self == Self::zero()
    }

    /// Whether every entry is finite.
    pub fn is_finite(&self) -> bool {
        self.upper_triangle().iter().all(|v| v.is_finite())
    }

    /// R Σ Rᵀ.
    pub fn rotated(&self, rotation: &nalgebra::UnitQuaternion<f64>) -> Self {
        self.turned(rotation.to_rotation_matrix().matrix())
    }

    /// The same with R as a matrix.
    pub(crate) fn turned(&self, rotation: &Matrix3) -> Self {
        if self.is_zero() {
            return *self;
        }
        Self::from_symmetric(&(rotation * self.matrix() * rotation.transpose()))
    }

    /// The covariance of `factor`·x.
    pub fn scaled(&self, factor: f64) -> Self {
        let f = factor * factor;
        let [xx, xy, xz, yy, yz, zz] = self.upper_triangle().map(|v| v * f);
        Self { xx, xy, xz, yy, yz, zz }
    }

    /// Σ + Ψ: the covariance of a sum of independent errors.
    pub fn sum(&self, other: &Self) -> Self {
        Self {
            xx: self.xx + other.xx,
            xy: self.xy + other.xy,
            xz: self.xz + other.xz,
            yy: self.yy + other.yy,
            yz: self.yz + other.yz,
            zz: self.zz + other.zz,
        }
    }
}

/// Eigenvalues and axes (columns) of a symmetric matrix by cyclic Jacobi rotations: for 3×3 several
/// times as fast as a tridiagonal decomposition, and more accurate for small eigenvalues.
fn jacobi(mut m: Matrix3) -> (Vector3, Matrix3) {
    let mut axes = Matrix3::identity();
    // Four are usual: from then on the error is squared each time.
    for _ in 0..MOST_SWEEPS {
        if [(0, 1), (0, 2), (1, 2)].iter().all(|&at| m[at] == 0.0) {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m[(p, q)];
            // What rounds away beside both of its diagonal entries is done with.
            if m[(p, p)] + off == m[(p, p)] && m[(q, q)] + off == m[(q, q)] {
                (m[(p, q)], m[(q, p)]) = (0.0, 0.0);
                continue;
            }
            let ratio = (m[(q, q)] - m[(p, p)]) / (2.0 * off);
            let tangent = ratio.signum() / (ratio.abs() + (1.0 + ratio * ratio).sqrt());
            let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
            let sine = tangent * cosine;
            let r = 3 - p - q;
            let (rp, rq) = (m[(r, p)], m[(r, q)]);
            m[(p, p)] -= tangent * off;
            m[(q, q)] += tangent * off;
            (m[(p, q)], m[(q, p)]) = (0.0, 0.0);
            m[(r, p)] = cosine * rp - sine * rq;
            m[(r, q)] = sine * rp + cosine * rq;
            (m[(p, r)], m[(q, r)]) = (m[(r, p)], m[(r, q)]);
            let (of_p, of_q) = (axes.column(p).into_owned(), axes.column(q).into_owned());
            axes.set_column(p, &(of_p * cosine - of_q * sine));
            axes.set_column(q, &(of_p * sine + of_q * cosine));
        }
    }
    (m.diagonal(), axes)
}

/// Zero for a negative number; NaN stays NaN, so that it cannot pass for an exact point.
fn not_negative(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_covariance() -> impl Strategy<Value = Covariance> {
        (prop::array::uniform9(-1.0..1.0_f64), -6..3_i32).prop_map(|(entries, exponent)| {
            let root = Matrix3::from_row_slice(&entries) * 10_f64.powi(exponent);
            Covariance::from_symmetric(&(root * root.transpose()))
        })
    }

    proptest! {
        #[test]
        fn root_squares_back(a in any_covariance()) {
            let root = a.sqrt();
            prop_assert!((root * root - a.matrix()).amax() <= 1e-12 * a.matrix().amax());
        }

        #[test]
        fn bounds_are_in_order(a in any_covariance(), d in prop::array::uniform3(-1.0..1.0_f64)) {
            let direction = Vector3::from(d);
            prop_assume!(direction.norm() > 1e-3);
            let along = a.std_along(&direction.normalize());
            prop_assert!(along <= a.max_std() * (1.0 + 1e-9));
            prop_assert!(a.max_std() <= a.std_bound() * (1.0 + 1e-9));
        }
    }

    #[test]
    fn nan_does_not_become_an_exact_point() {
        assert!(!Covariance::isotropic(f64::NAN).is_finite());
        assert!(!Covariance::from_symmetric(&Matrix3::repeat(f64::NAN)).is_finite());
        assert_eq!(Covariance::isotropic(-1.0), Covariance::zero());
    }

    #[test]
    fn checks_name_what_is_wrong() {
        let mut m = Matrix3::identity();
        m[(0, 2)] = 0.5;
        assert!(matches!(
            Covariance::try_from_matrix(&m),
            Err(CovarianceError::NotSymmetric { row: 0, column: 2, .. })
        ));
        m = Matrix3::identity();
        m[(1, 1)] = -1.0;
        assert!(matches!(
            Covariance::try_from_matrix(&m),
            Err(CovarianceError::Negative { eigenvalue }) if eigenvalue < 0.0
        ));
        m[(1, 1)] = f64::NAN;
        assert!(matches!(
            Covariance::try_from_matrix(&m),
            Err(CovarianceError::NotFinite { row: 1, column: 1, .. })
        ));
    }

    #[test]
    fn two_finite_entries_whose_sum_is_infinite_are_refused() {
        let mut m = Matrix3::identity();
        (m[(1, 2)], m[(2, 1)]) = (1e308, 1e308);
        assert!(matches!(
            Covariance::try_from_matrix(&m),
            Err(CovarianceError::TooLarge { row: 1, column: 2, .. })
        ));
    }

    proptest::proptest! {
        #[test]
        fn jacobi_agrees_with_a_tridiagonal_decomposition(
            entries in proptest::array::uniform9(-1.0..1.0_f64),
            stretch in -8..1_i32,
        ) {
            let root = Matrix3::from_row_slice(&entries)
                * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 10_f64.powi(stretch)));
            let matrix = root * root.transpose();
            let (values, axes) = jacobi(matrix);
            let back = axes * Matrix3::from_diagonal(&values) * axes.transpose();
            proptest::prop_assert!((back - matrix).amax() < 1e-14);
            proptest::prop_assert!((axes.transpose() * axes - Matrix3::identity()).amax() < 1e-14);
            let mut expected: Vec<f64> =
                nalgebra::SymmetricEigen::new(matrix).eigenvalues.iter().copied().collect();
            let mut found: Vec<f64> = values.iter().copied().collect();
            expected.sort_by(f64::total_cmp);
            found.sort_by(f64::total_cmp);
            for (expected, found) in expected.iter().zip(&found) {
                proptest::prop_assert!((expected - found).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn tiny_and_huge_scales_keep_their_eigenvalues() {
        for scale in [1e-200, 1e-12, 1.0, 1e150] {
            let c = Covariance::diagonal([3.0 * scale, scale, 2.0 * scale]);
            let (values, _) = c.eigen();
            for (value, expected) in values.iter().zip([3.0, 2.0, 1.0]) {
                assert!((value / (expected * scale) - 1.0).abs() < 1e-12);
            }
        }
    }
}
