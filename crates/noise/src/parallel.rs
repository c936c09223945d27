//! The parallel sum of two covariances that may differ by many orders of magnitude.

use cloudtouch_geom::Covariance;

use crate::limited::limited;

/// (Σ⁻¹ + Ψ⁻¹)⁻¹ for a sensor noise Σ and a sampling error Ψ, defined for singular ones too and
/// never above Σ.
///
/// The smaller of the two is updated by the other as by three measurements, along the axes of the
/// other and with its variances: P − P e eᵀP / (eᵀP e + t). So P only falls, and rounding is
/// relative to the smaller, where the product Σ(Σ+Ψ)⁺Ψ rounds relative to the larger; sampling is
/// often a thousand times coarser than the sensor.
pub(crate) fn parallel(sensor: &Covariance, sampling: &Covariance) -> Covariance {
    let (smaller, larger) = if sensor.std_bound() <= sampling.std_bound() {
        (sensor, sampling)
    } else {
        (sampling, sensor)
    };
    let (variances, axes) = larger.eigen();
    let mut left = smaller.matrix();
    for (variance, axis) in variances.iter().zip(axes.column_iter()) {
        let gain = left * axis;
        let total = axis.dot(&gain) + variance;
        if total > 0.0 {
            left -= gain * (gain / total).transpose();
        }
    }
    let (values, axes) = Covariance::from_symmetric(&left).eigen();
    limited(Covariance::from_eigen(&values, &axes), sensor.max_std())
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Matrix3, Vector3};

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
        // Two needles in different directions, one 10⁸ times the other.
        let root = Vector3::new(0.0, 4.4e-4, -4.3e-4);
        let needle = Covariance::from_symmetric(&(root * root.transpose()));
        let left = parallel(&needle, &Covariance::diagonal([0.0, 0.0, 21.0])).matrix();
        assert!(left.amax() < 1e-15 * 21.0, "{left}");
        assert!(parallel(&Covariance::zero(), &Covariance::zero()).is_zero());
    }
}
