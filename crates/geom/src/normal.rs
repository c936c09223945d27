//! The standard normal distribution with tails that keep their relative accuracy.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI, SQRT_2};

/// Density of a standard normal variable at `z`: φ(z), what [`cdf`] rises by.
pub fn density(z: f64) -> f64 {
    0.5 * FRAC_1_SQRT_2 * FRAC_2_SQRT_PI * (-0.5 * z * z).exp()
}

/// Probability that a standard normal variable is below `z`: Φ(z).
///
/// `z` may be infinite; NaN in gives NaN out. The lower tail keeps relative accuracy down to
/// z = −38, where the result leaves the range of `f64`.
///
/// ```
/// use cloudtouch_geom::normal::cdf;
/// assert_eq!(cdf(0.0), 0.5);
/// assert!((cdf(-12.0) / 1.776482112077679e-33 - 1.0).abs() < 1e-12);
/// ```
pub fn cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// Probability that a standard normal variable is above `z`: 1 − Φ(z), without the cancellation.
pub fn upper_tail(z: f64) -> f64 {
    cdf(-z)
}

/// Probability that a normal variable with this mean and standard deviation, whose sign does not matter, is below
/// zero.
///
/// A standard deviation of zero gives the step function: 1 below zero, ½ at zero, 0 above. NaN in gives NaN out.
pub fn below_zero(mean: f64, std: f64) -> f64 {
    if mean == 0.0 && !std.is_nan() {
        0.5
    } else {
        // A zero `std` divides to ±infinity, which is the step wanted.
        cdf(-mean / std.abs())
    }
}

/// The `z` with Φ(z) = `probability`, for a probability in (0, 1); ∓infinity at 0 and 1.
///
/// Found by bisection on [`cdf`] (set-up code calls it, inner loops do not); accurate to 1e-14
/// where the distribution itself can tell values apart. NaN outside \[0, 1\].
///
/// ```
/// use cloudtouch_geom::normal::quantile;
/// assert!((quantile(0.975) - 1.959963984540054).abs() < 1e-12);
/// ```
pub fn quantile(probability: f64) -> f64 {
    if !(0.0..=1.0).contains(&probability) {
        return f64::NAN;
    }
    if probability > 0.5 {
        // The lower tail has the better relative accuracy.
        return -quantile_lower(1.0 - probability);
    }
    quantile_lower(probability)
}

fn quantile_lower(probability: f64) -> f64 {
    if probability == 0.0 {
        return f64::NEG_INFINITY;
    }
    let (mut low, mut high) = (-38.5, 0.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if cdf(middle) < probability { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_of_minus_nothing_is_none() {
        for std in [0.0, -0.0] {
            assert_eq!([-1.0, 0.0, 1.0].map(|mean| below_zero(mean, std)), [1.0, 0.5, 0.0]);
        }
    }

    /// It was ½ where the mean was exactly zero, as of a point on the surface.
    #[test]
    fn a_deviation_that_is_no_number_tells_nothing() {
        for mean in [-1.0, 0.0, -0.0, 1.0, f64::INFINITY, f64::NAN] {
            assert!(below_zero(mean, f64::NAN).is_nan(), "{mean}");
        }
    }

    #[test]
    fn tails_keep_relative_accuracy() {
        // Reference values from a 50-digit evaluation of erfc.
        for (z, expected) in [(-5.0, 2.866515718791939e-7), (-30.0, 4.906713927148187e-198)] {
            assert!((cdf(z) / expected - 1.0).abs() < 1e-12, "z = {z}: {}", cdf(z));
        }
        assert_eq!(cdf(f64::INFINITY), 1.0);
        assert_eq!(upper_tail(f64::INFINITY), 0.0);
        assert!(cdf(f64::NAN).is_nan());
    }

    #[test]
    fn the_density_is_what_the_distribution_rises_by() {
        for z in [-3.0, -0.5, 0.0, 1.2, 4.0] {
            let slope = (cdf(z + 1e-6) - cdf(z - 1e-6)) / 2e-6;
            assert!((slope - density(z)).abs() < 1e-9, "{z}: {slope} {}", density(z));
        }
    }

    #[test]
    fn quantile_inverts_cdf() {
        for p in [1e-300, 1e-12, 0.01, 0.3, 0.5, 0.84, 1.0 - 1e-9] {
            assert!((cdf(quantile(p)) / p - 1.0).abs() < 1e-11, "p = {p}");
        }
        assert_eq!(quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(quantile(1.0), f64::INFINITY);
        assert!(quantile(1.5).is_nan());
    }

    #[test]
    fn below_zero_is_a_step_without_spread() {
        assert_eq!(below_zero(0.1, 0.0), 0.0);
        assert_eq!(below_zero(-0.1, 0.0), 1.0);
        assert_eq!(below_zero(0.0, 0.0), 0.5);
    }
}
