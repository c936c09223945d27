//! Symmetric positive semidefinite 3×3 matrices: zero and singular ones are ordinary values.

mod axis_form;
mod combined;
mod error;
mod jacobi;
mod jacobi_of_two;
mod made;
mod spread;
mod symmetric;
mod variance;

use crate::vectors::Matrix3;

use symmetric::Symmetric;
use variance::not_negative;

pub use axis_form::AxisForm;
pub use error::CovarianceError;

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

impl Covariance {
    /// A semidefinite matrix in the form that suits it.
    #[inline]
    fn full(symmetric: Symmetric) -> Self {
        let Symmetric { xx, xy, xz, yy, yz, zz } = symmetric;
        let is_ball = xx == yy && yy == zz && [xy, xz, yz] == [0.0; 3];
        Self(if is_ball { Form::Isotropic(not_negative(xx)) } else { Form::Full(symmetric) })
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

    /// Whether there is no uncertainty at all.
    pub fn is_zero(&self) -> bool {
        *self == Self::zero()
    }

    /// Whether every entry is finite.
    pub fn is_finite(&self) -> bool {
        self.upper_triangle().iter().all(|v| v.is_finite())
    }
}

impl PartialEq for Covariance {
    fn eq(&self, other: &Self) -> bool {
        self.symmetric() == other.symmetric()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    use super::*;
    use crate::unit::unit;
    use crate::vectors::{UnitVector3, Vector3};

    /// Its root is −0, by which what is on one side was on the other.
    #[test]
    fn a_variance_of_minus_nothing_is_none() {
        let zero = Matrix3::zeros();
        for covariance in [
            Covariance::isotropic(-0.0),
            Covariance::diagonal([-0.0; 3]),
            Covariance::from_symmetric(&-zero),
            Covariance::try_from_matrix(&-zero).unwrap(),
        ] {
            let std = covariance.std_along(&Vector3::z());
            assert!(std == 0.0 && std.is_sign_positive(), "{covariance:?}");
            assert!(covariance.max_std().is_sign_positive(), "{covariance:?}");
        }
    }

    #[test]
    fn what_is_not_a_number_is_not_exact() {
        let covariance = Covariance::diagonal([f64::NAN, 1.0, 2.0]);
        assert!(covariance.std_along(&Vector3::x()).is_nan() && covariance.max_std().is_nan());
    }

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

    /// With a sign it came after all numbers, and the largest was one of these.
    #[test]
    fn nan_with_a_sign_was_less_than_any_variance() {
        for nan in [f64::NAN, -f64::NAN] {
            let unknown = Covariance::diagonal([nan, 1.0, 2.0]);
            assert!(unknown.max_std().is_nan() && unknown.eigen().0[2].is_nan());
        }
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
