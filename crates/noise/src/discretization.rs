//! The error made by sampling: where between its neighbours the surface point of a sample may be
//! (eq. 17).

use cloudtouch_geom::{Covariance, Matrix3, Point3};

use crate::settings::{check_at_least, check_positive};
use crate::{Neighbor, Neighborhoods, NoiseError};

/// How the discretization covariance Ψᵢ is taken from the neighbours (eq. 17).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Discretization {
    /// k, the size of the neighbourhood. 12 by default: about two rings of neighbours, the second
    /// of which hardly counts.
    pub neighbors: usize,
    /// τ, the width of the weights in units of η = Rₖ/√k, which on a surface of spacing h is
    /// h/√π. 2 by default: a neighbour one spacing away weighs e^(−π/4) = 0.46, one two spacings
    /// away 0.04.
    pub width: f64,
}

impl Default for Discretization {
    fn default() -> Self {
        Self { neighbors: 12, width: 2.0 }
    }
}

impl Discretization {
    /// Checks the settings.
    ///
    /// # Errors
    /// When there are no neighbours or the width is not positive and finite.
    pub fn validate(&self) -> Result<(), NoiseError> {
        check_at_least("discretization.neighbors", self.neighbors, 1)?;
        check_positive("discretization.width", self.width)
    }
}

/// The discretization covariance Ψᵢ of point `index` (eq. 17), m²; `None` for a point without
/// neighbours, about which it says nothing.
///
/// Ψᵢ = Σⱼ wᵢⱼ (xⱼ−xᵢ)(xⱼ−xᵢ)ᵀ / Σⱼ wᵢⱼ over the k nearest other positions, with
/// wᵢⱼ = exp(−|xⱼ−xᵢ|²/τᵢ²), τᵢ = τ Rₖ/√k and Rₖ the distance of the last of them. The point
/// itself is not in the sum, where it would only make Ψᵢ smaller.
///
/// # Errors
/// When the settings are out of range.
///
/// # Panics
/// When `index` is out of range.
pub fn discretization(
    neighborhoods: &Neighborhoods,
    index: usize,
    settings: &Discretization,
) -> Result<Option<Covariance>, NoiseError> {
    settings.validate()?;
    let neighbors = neighborhoods.nearest(index, settings.neighbors);
    Ok(weighted_scatter(neighborhoods.points(), index, &neighbors, settings.width))
}

/// Ψᵢ from neighbours in order of distance.
pub(crate) fn weighted_scatter(
    points: &[Point3],
    index: usize,
    neighbors: &[Neighbor],
    width: f64,
) -> Option<Covariance> {
    let (first, last) = (neighbors.first()?, neighbors.last()?);
    let variance = width * width * last.squared_distance / neighbors.len() as f64;
    let mut total = 0.0;
    let mut scatter = Matrix3::zeros();
    for neighbor in neighbors {
        // Relative to the nearest, so that narrow weights do not all vanish; it cancels out.
        let weight = (-(neighbor.squared_distance - first.squared_distance) / variance).exp();
        // At the distance of the nearest the weight is one, even where the width underflows.
        let weight = if weight.is_nan() { 1.0 } else { weight };
        let offset = points[neighbor.index] - points[index];
        total += weight;
        scatter += offset * offset.transpose() * weight;
    }
    Some(Covariance::from_symmetric(&(scatter / total)))
}

/// The covariance scaled down, if need be, so that no standard deviation exceeds `limit`.
pub(crate) fn limited(covariance: Covariance, limit: f64) -> Covariance {
    let std = covariance.max_std();
    // A hair inside the limit, so that rounding does not cross it.
    if std > limit { covariance.scaled((limit / std) * (1.0 - 1e-12)) } else { covariance }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(xs: &[f64]) -> Neighborhoods {
        Neighborhoods::try_new(xs.iter().map(|&x| Point3::new(x, 0.0, 0.0)).collect()).unwrap()
    }

    #[test]
    fn matches_the_formula_by_hand() {
        // From x = 0: neighbours at 1 and -2, so R = 2, k = 2, and the width is 1 · 2/√2.
        let cloud = line(&[0.0, 1.0, -2.0, 50.0]);
        let settings = Discretization { neighbors: 2, width: 1.0 };
        let psi = discretization(&cloud, 0, &settings).unwrap().unwrap();
        let (near, far) = ((-1.0_f64 / 2.0).exp(), (-4.0_f64 / 2.0).exp());
        let expected = (near * 1.0 + far * 4.0) / (near + far);
        let found = psi.upper_triangle();
        assert!((found[0] - expected).abs() < 1e-12, "{found:?} against {expected}");
        assert!(found[1..].iter().all(|v| v.abs() < 1e-15), "{found:?}");
    }

    #[test]
    fn narrow_weights_leave_the_nearest_neighbour() {
        let cloud = line(&[0.0, 1.0, -2.0]);
        let settings = Discretization { neighbors: 2, width: 1e-3 };
        let psi = discretization(&cloud, 0, &settings).unwrap().unwrap();
        assert!((psi.upper_triangle()[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_lone_point_has_none_and_bad_settings_are_refused() {
        let settings = Discretization::default();
        assert_eq!(discretization(&line(&[3.0, 3.0]), 0, &settings), Ok(None));
        for bad in [
            Discretization { neighbors: 0, ..settings },
            Discretization { width: 0.0, ..settings },
            Discretization { width: f64::NAN, ..settings },
        ] {
            assert!(matches!(
                discretization(&line(&[0.0, 1.0]), 0, &bad),
                Err(NoiseError::Setting { .. })
            ));
        }
    }
}
