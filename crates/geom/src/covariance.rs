//! Symmetric positive semidefinite 3×3 matrices: zero and singular ones are ordinary values.

use nalgebra::UnitQuaternion;

use crate::axis_form::AxisForm;
use crate::covariance_error::CovarianceError;
use crate::symmetric::Symmetric;
use crate::vectors::{Matrix3, UnitVector3, Vector3};

/// A covariance in square metres; symmetric and positive semidefinite by construction, up to
/// rounding of its largest entry.
///
/// What is known of its shape is kept: a ball is one number, and a disc or needle is an axis with a
/// standard deviation along it and one across. So a spread of a nanometre across a disc of a metre is
/// that, of which a matrix in double precision would leave nothing, also after turning and scaling.
/// Two covariances are equal when all entries of their matrices are.
#[derive(Debug, Clone, Copy)]
pub struct Covariance(Form);

#[derive(Debug, Clone, Copy)]
enum Form {
    /// The variance in every direction, m².
    Isotropic(f64),
    Axis(AxisForm),
    Full(Symmetric),
}

/// Relative size of what counts as rounding when a matrix is checked.
const ROUNDING: f64 = 1e-9;
/// Relative slack of a largest variance, far above the rounding of eigenvalues.
const WITHIN: f64 = 1e-12;
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
    fn congruent(by: &Matrix3, semidefinite: &Matrix3) -> Self {
        let mut symmetric = Symmetric::average(&(by * semidefinite * by.transpose()));
        for variance in [&mut symmetric.xx, &mut symmetric.yy, &mut symmetric.zz] {
            *variance = not_negative(*variance);
        }
        Self::full(symmetric)
    }

    /// A semidefinite matrix in the form that suits it.
    #[inline]
    fn full(symmetric: Symmetric) -> Self {
        let Symmetric { xx, xy, xz, yy, yz, zz } = symmetric;
        let is_ball = xx == yy && yy == zz && [xy, xz, yz] == [0.0; 3];
        Self(if is_ball { Form::Isotropic(xx) } else { Form::Full(symmetric) })
    }

    /// The variance (m²) where it is the same in every direction, else `None`.
    pub fn isotropic_variance(&self) -> Option<f64> {
        match self.0 {
            Form::Isotropic(variance) => Some(variance),
            _ => None,
        }
    }

    /// The axis with the standard deviations along and across it, where it was made of these.
    pub fn axis_form(&self) -> Option<AxisForm> {
        match self.0 {
            Form::Axis(axis) => Some(axis),
            _ => None,
        }
    }

    #[inline]
    fn symmetric(&self) -> Symmetric {
        match &self.0 {
            &Form::Isotropic(v) => Symmetric { xx: v, xy: 0.0, xz: 0.0, yy: v, yz: 0.0, zz: v },
            Form::Axis(axis) => axis.symmetric(),
            Form::Full(symmetric) => *symmetric,
        }
    }

    /// The full matrix, m².
    #[inline]
    pub fn matrix(&self) -> Matrix3 {
        self.symmetric().matrix()
    }

    /// The six distinct entries xx, xy, xz, yy, yz, zz.
    pub fn upper_triangle(&self) -> [f64; 6] {
        self.symmetric().entries()
    }

    /// Variances in descending order and the unit axes (columns, right-handed or not) they
    /// belong to.
    pub fn eigen(&self) -> (Vector3, Matrix3) {
        match &self.0 {
            Form::Isotropic(variance) => (Vector3::repeat(*variance), Matrix3::identity()),
            Form::Axis(axis) => axis.eigen(),
            Form::Full(symmetric) => {
                let (values, axes) = symmetric.eigen();
                let mut order = [0, 1, 2];
                order.sort_by(|&i, &j| values[j].total_cmp(&values[i]));
                (
                    Vector3::from_fn(|k, _| values[order[k]].max(0.0)),
                    Matrix3::from_fn(|row, k| axes[(row, order[k])]),
                )
            }
        }
    }

    /// The symmetric root S with S S = Σ, in metres.
    pub fn sqrt(&self) -> Matrix3 {
        match &self.0 {
            Form::Isotropic(variance) => Matrix3::identity() * variance.sqrt(),
            Form::Axis(axis) => axis.root(),
            Form::Full(_) => {
                let (values, axes) = self.eigen();
                axes * Matrix3::from_diagonal(&values.map(f64::sqrt)) * axes.transpose()
            }
        }
    }

    /// Variance (m²) of the component along `direction`, which need not have unit length.
    #[inline]
    pub fn variance_along(&self, direction: &Vector3) -> f64 {
        match &self.0 {
            Form::Isotropic(variance) => variance * direction.norm_squared(),
            Form::Axis(axis) => axis.variance_along(direction),
            Form::Full(symmetric) => symmetric.quadratic(direction).max(0.0),
        }
    }

    /// Standard deviation (m) of the component along `direction`.
    pub fn std_along(&self, direction: &Vector3) -> f64 {
        self.variance_along(direction).sqrt()
    }

    /// An upper bound on the standard deviation in any direction: √trace ≥ √λ₁.
    ///
    /// At most √3 too large, and much cheaper than the eigenvalue; see [`Self::max_std`].
    pub fn std_bound(&self) -> f64 {
        match &self.0 {
            Form::Isotropic(variance) => (3.0 * variance).sqrt(),
            Form::Axis(AxisForm { along, across, .. }) => {
                (along * along + 2.0 * across * across).sqrt()
            }
            Form::Full(symmetric) => (symmetric.xx + symmetric.yy + symmetric.zz).sqrt(),
        }
    }

    /// The largest standard deviation in any direction, m.
    pub fn max_std(&self) -> f64 {
        match &self.0 {
            Form::Isotropic(variance) => variance.sqrt(),
            Form::Axis(AxisForm { along, across, .. }) => along.max(*across),
            Form::Full(_) => self.eigen().0[0].sqrt(),
        }
    }

    /// The largest standard deviation in any direction, m, or up to a millionth more: a bound that is soon
    /// told, see [`Self::max_std`].
    pub fn max_std_at_most(&self) -> f64 {
        match &self.0 {
            Form::Isotropic(_) | Form::Axis(_) => self.max_std(),
            Form::Full(symmetric) => symmetric.largest_at_most().sqrt(),
        }
    }

    /// Whether no standard deviation is above this one, m: soon told, without eigenvalues. Perhaps not
    /// where the largest is less than 1e-12 below it; never where it is above.
    pub fn is_within(&self, std: f64) -> bool {
        match &self.0 {
            Form::Isotropic(_) | Form::Axis(_) => self.max_std() <= std,
            Form::Full(symmetric) => symmetric.is_within(std * std * (1.0 - WITHIN)),
        }
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
    #[must_use]
    pub fn rotated(&self, rotation: &UnitQuaternion<f64>) -> Self {
        match &self.0 {
            // Else the matrix of the rotation is formed for nothing.
            Form::Isotropic(_) => *self,
            _ => self.turned(rotation.to_rotation_matrix().matrix()),
        }
    }

    /// The same with R as a matrix.
    #[inline]
    pub(crate) fn turned(&self, rotation: &Matrix3) -> Self {
        match &self.0 {
            Form::Isotropic(_) => *self,
            Form::Axis(axis) => Self(Form::Axis(axis.turned(rotation))),
            Form::Full(symmetric) => Self::congruent(rotation, &symmetric.matrix()),
        }
    }

    /// The covariance of `factor`·x.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let squared = factor * factor;
        Self(match &self.0 {
            Form::Isotropic(variance) => Form::Isotropic(variance * squared),
            Form::Axis(axis) => Form::Axis(axis.scaled(factor.abs())),
            Form::Full(symmetric) => Form::Full(symmetric.scaled(squared)),
        })
    }

    /// Σ + Ψ: the covariance of a sum of independent errors.
    #[inline]
    #[must_use]
    pub fn sum(&self, other: &Self) -> Self {
        match (&self.0, &other.0) {
            (Form::Isotropic(a), Form::Isotropic(b)) => Self(Form::Isotropic(a + b)),
            (Form::Isotropic(0.0), _) => *other,
            (_, Form::Isotropic(0.0)) => *self,
            (Form::Axis(axis), Form::Isotropic(variance))
            | (Form::Isotropic(variance), Form::Axis(axis)) => {
                Self(Form::Axis(axis.widened(variance.sqrt(), variance.sqrt())))
            }
            (Form::Axis(a), Form::Axis(b)) if a.axis == b.axis => {
                Self(Form::Axis(a.widened(b.along, b.across)))
            }
            _ => Self::full(self.symmetric().plus(&other.symmetric())),
        }
    }
}

impl PartialEq for Covariance {
    fn eq(&self, other: &Self) -> bool {
        self.symmetric() == other.symmetric()
    }
}

/// Zero for a negative number; NaN stays NaN, so that it cannot pass for an exact point.
fn not_negative(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::unit::unit;

    fn any_covariance() -> impl Strategy<Value = Covariance> {
        let full =
            (prop::array::uniform9(-1.0..1.0_f64), -6..3_i32).prop_map(|(entries, exponent)| {
                let root = Matrix3::from_row_slice(&entries) * 10_f64.powi(exponent);
                Covariance::from_symmetric(&(root * root.transpose()))
            });
        let std =
            || (0.1..1.0_f64, -6..3_i32).prop_map(|(std, exponent)| std * 10_f64.powi(exponent));
        let axis = (any_direction(), std(), std())
            .prop_map(|(axis, along, across)| Covariance::from_axis(&axis, along, across));
        prop_oneof![full, axis, std().prop_map(Covariance::isotropic)]
    }

    fn any_direction() -> impl Strategy<Value = UnitVector3> {
        prop::array::uniform3(-1.0..1.0_f64)
            .prop_filter_map("a direction", |v| unit(&Vector3::from(v)).ok())
    }

    fn any_rotation() -> impl Strategy<Value = UnitQuaternion<f64>> {
        prop::array::uniform3(-3.0..3.0_f64)
            .prop_map(|[roll, pitch, yaw]| UnitQuaternion::from_euler_angles(roll, pitch, yaw))
    }

    proptest! {
        #[test]
        fn root_squares_back(a in any_covariance()) {
            let root = a.sqrt();
            prop_assert!((root * root - a.matrix()).amax() <= 1e-12 * a.matrix().amax());
        }

        #[test]
        fn bounds_are_in_order(a in any_covariance(), direction in any_direction()) {
            let along = a.std_along(&direction);
            prop_assert!(along <= a.max_std() * (1.0 + 1e-9));
            prop_assert!(a.max_std() <= a.std_bound() * (1.0 + 1e-9));
            let most = a.max_std();
            prop_assert!(a.is_within(most * (1.0 + 1e-11)));
            prop_assert!(a.is_within(f64::INFINITY));
            prop_assert!(most == 0.0 || !a.is_within(most * (1.0 - 1e-15)));
        }

        /// What each form answers is what its matrix does.
        #[test]
        fn every_form_agrees_with_its_matrix(
            a in any_covariance(),
            b in any_covariance(),
            direction in any_direction(),
            rotation in any_rotation(),
            factor in -3.0..3.0_f64,
        ) {
            let (m, scale) = (a.matrix(), a.matrix().amax());
            let expected = direction.dot(&(m * *direction));
            prop_assert!((a.variance_along(&direction) - expected).abs() <= 1e-14 * scale);
            let (values, axes) = a.eigen();
            let back = axes * Matrix3::from_diagonal(&values) * axes.transpose();
            prop_assert!((back - m).amax() <= 1e-14 * scale);
            prop_assert!(values[0] >= values[1] && values[1] >= values[2]);
            let r = rotation.to_rotation_matrix().into_inner();
            let turned = a.rotated(&rotation).matrix();
            prop_assert!((turned - r * m * r.transpose()).amax() <= 1e-14 * scale);
            prop_assert!((a.scaled(factor).matrix() - m * factor * factor).amax() <= 1e-14 * 9.0 * scale);
            let total = m + b.matrix();
            prop_assert!((a.sum(&b).matrix() - total).amax() <= 1e-14 * total.amax());
            prop_assert!((a.max_std().powi(2) - values[0]).abs() <= 1e-14 * scale);
            prop_assert!(Covariance::try_from_matrix(&m).is_ok());
        }

        /// The classifier scales to the unit box and asks across a plane: a thin disc stays thin.
        #[test]
        fn a_disc_keeps_its_thickness_when_turned_and_scaled(
            axis in any_direction(),
            rotation in any_rotation(),
            factor in 1e-3..1e3_f64,
        ) {
            let disc = Covariance::from_axis(&axis, 1e-9, 1.0);
            prop_assert!((disc.std_along(&axis) / 1e-9 - 1.0).abs() < 1e-15);
            let moved = disc.rotated(&rotation).scaled(factor);
            let thickness = moved.std_along(&(rotation * axis));
            prop_assert!((thickness / (1e-9 * factor) - 1.0).abs() < 1e-9, "{thickness}");
            let twice = disc.sum(&disc).std_along(&axis);
            prop_assert!((twice / (2_f64.sqrt() * 1e-9) - 1.0).abs() < 1e-12, "{twice}");
        }
    }

    #[test]
    fn what_is_no_covariance_becomes_the_nearest_one() {
        // Eigenvalues 3 and -1: only the diagonal was looked at, and all of it is positive.
        let indefinite = Matrix3::new(1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        let mended = Covariance::from_symmetric(&indefinite);
        let expected = Matrix3::new(1.5, 1.5, 0.0, 1.5, 1.5, 0.0, 0.0, 0.0, 1.0);
        assert!((mended.matrix() - expected).amax() < 1e-15, "{mended:?}");
    }

    /// It read back as zero: 1 − (1 − 1e-18) in double precision.
    #[test]
    fn a_small_spread_across_a_wide_disc_is_kept() {
        let normal = unit(&Vector3::new(1.0, 2.0, -2.0)).unwrap();
        assert_eq!(Covariance::from_axis(&normal, 1e-9, 1.0).std_along(&normal), 1e-9);
    }

    #[test]
    fn nan_does_not_become_an_exact_point() {
        assert!(!Covariance::isotropic(f64::NAN).is_finite());
        assert!(!Covariance::from_symmetric(&Matrix3::repeat(f64::NAN)).is_finite());
        assert!(!Covariance::from_axis(&Vector3::z_axis(), f64::NAN, 1.0).is_finite());
        assert!(
            Covariance::from_axis(&Vector3::z_axis(), 1.0, f64::NAN)
                .std_along(&Vector3::x())
                .is_nan()
        );
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
