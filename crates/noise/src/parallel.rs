//! The parallel sum of two covariances that may differ by many orders of magnitude.

use cloudtouch_geom::{Covariance, Matrix3};

use crate::discretization::limited;

/// (Σ⁻¹ + Ψ⁻¹)⁻¹ for a sensor noise Σ and a sampling error Ψ, defined for singular ones too and
/// never above Σ.
///
/// Taken as S − S(Σ+Ψ)⁺S with S the smaller of the two, so that rounding is relative to the
/// result: the product Σ(Σ+Ψ)⁺Ψ rounds relative to the larger, and sampling is often a thousand
/// times coarser than the sensor.
pub(crate) fn parallel(sensor: &Covariance, sampling: &Covariance) -> Covariance {
    let smaller = if sensor.std_bound() <= sampling.std_bound() { sensor } else { sampling };
    let (values, axes) = sensor.sum(sampling).eigen();
    // Directions in which neither varies are left out.
    let floor = values[0] * 1e-14;
    let inverse = values.map(|v| if v > floor { 1.0 / v.sqrt() } else { 0.0 });
    let root = Matrix3::from_diagonal(&inverse) * axes.transpose() * smaller.matrix();
    let difference = smaller.matrix() - root.transpose() * root;
    let (values, axes) = Covariance::from_symmetric(&difference).eigen();
    limited(Covariance::from_eigen(&values, &axes), sensor.max_std())
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;

    use super::*;

    #[test]
    fn inverts_the_sum_of_precisions_at_any_ratio() {
        for ratio in [1e-16, 1e-8, 1.0, 1e8, 1e16] {
            let a = Covariance::diagonal([4.0, 1.0, 9.0]);
            let b = Covariance::diagonal([ratio, 2.0 * ratio, 3.0 * ratio]);
            let expected = Vector3::from_fn(|i, _| {
                let (p, q) = (a.upper_triangle()[[0, 3, 5][i]], b.upper_triangle()[[0, 3, 5][i]]);
                p * q / (p + q)
            });
            let found = parallel(&a, &b).matrix();
            let error = (found - Matrix3::from_diagonal(&expected)).amax();
            assert!(error < 1e-12 * expected.max(), "ratio {ratio}: {error}");
        }
    }

    #[test]
    fn a_direction_missing_in_one_is_missing_in_the_result() {
        let flat = Covariance::diagonal([4.0, 4.0, 0.0]);
        let found = parallel(&flat, &Covariance::isotropic(4.0)).matrix();
        assert!((found - Matrix3::from_diagonal(&Vector3::new(2.0, 2.0, 0.0))).amax() < 1e-14);
        assert!(parallel(&Covariance::zero(), &flat).is_zero());
        assert!(parallel(&Covariance::zero(), &Covariance::zero()).is_zero());
    }
}
