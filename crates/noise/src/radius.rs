//! The radius rᵢ of the ellipsoids a robust classifier keeps on one side (eqs. 11 and 12).

use cloudtouch_geom::normal;

use crate::error::NoiseError;

/// How the probability κ with which a point is to lie on its side becomes the radius r of its
/// ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RadiusRule {
    /// r = Φ⁻¹(κ), κ in [½, 1): points are normal (eq. 11).
    #[default]
    Gaussian,
    /// r = √(κ/(1−κ)), κ in [0, 1): whatever the distribution (eq. 12).
    Chebyshev,
}

impl RadiusRule {
    /// r, in standard deviations.
    ///
    /// # Errors
    /// When κ is outside the range of the rule.
    pub fn radius(self, kappa: f64) -> Result<f64, NoiseError> {
        match self {
            Self::Gaussian => radius_gaussian(kappa),
            Self::Chebyshev => radius_chebyshev(kappa),
        }
    }
}

/// The ellipsoid radius for Gaussian points: r = Φ⁻¹(κ) (eq. 11), in standard deviations.
///
/// `kappa` is the probability with which a point is to lie on its side of the surface, in
/// [½, 1): below ½ the radius would be negative.
///
/// # Errors
/// When `kappa` is outside that range.
///
/// ```
/// assert_eq!(cloudtouch_noise::radius_gaussian(0.5)?, 0.0);
/// # Ok::<(), cloudtouch_noise::NoiseError>(())
/// ```
pub fn radius_gaussian(kappa: f64) -> Result<f64, NoiseError> {
    if !(0.5..1.0).contains(&kappa) {
        return Err(NoiseError::Kappa { kappa, rule: "Gaussian", range: "[0.5, 1)" });
    }
    // Bisection ends a rounding error away from zero at one half.
    Ok(if kappa == 0.5 { 0.0 } else { normal::quantile(kappa) })
}

/// The ellipsoid radius for any distribution with the given mean and covariance:
/// r = √(κ/(1−κ)) (eq. 12), in standard deviations.
///
/// Never smaller than [`radius_gaussian`], since it covers the worst distribution. `kappa` is in
/// [0, 1).
///
/// # Errors
/// When `kappa` is outside that range.
pub fn radius_chebyshev(kappa: f64) -> Result<f64, NoiseError> {
    if !(0.0..1.0).contains(&kappa) {
        return Err(NoiseError::Kappa { kappa, rule: "Chebyshev", range: "[0, 1)" });
    }
    Ok((kappa / (1.0 - kappa)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_match_their_closed_forms() {
        assert!((radius_gaussian(0.975).unwrap() - 1.959963984540054).abs() < 1e-12);
        assert!((radius_chebyshev(0.8).unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(radius_chebyshev(0.0), Ok(0.0));
        for kappa in [0.5, 0.6, 0.9, 0.999, 1.0 - 1e-12] {
            assert!(radius_gaussian(kappa).unwrap() < radius_chebyshev(kappa).unwrap());
        }
    }

    #[test]
    fn values_out_of_range_are_refused() {
        for kappa in [0.4999, 1.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(radius_gaussian(kappa), Err(NoiseError::Kappa { .. })), "{kappa}");
        }
        for kappa in [-1e-9, 1.0, f64::NAN] {
            assert!(matches!(radius_chebyshev(kappa), Err(NoiseError::Kappa { .. })), "{kappa}");
        }
    }
}
