//! The error made by sampling: where between its neighbours the surface point of a sample may be
//! (eq. 17).

use cloudtouch_geom::{Covariance, Matrix3, Point3};

use crate::error::NoiseError;
use crate::index::neighbor::Neighbor;
use crate::neighborhoods::Neighborhoods;
use crate::settings_error::{SettingsError, check_at_least_one, check_at_most, check_positive};

/// Which points the sums of eq. 17 run over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Summed {
    /// The k nearest other positions: how far apart samples are, the second moment about a point of
    /// those around it.
    Neighbors,
    /// All points of the cloud and the point itself, as printed. The point itself adds the weight 1 to
    /// the denominator, points beyond the k-th to both: on a square lattice, at the default settings, Ψ is
    /// 11 % smaller. Each position counts once, and weights below 2⁻⁵³ are left out.
    #[default]
    AllPoints,
}

/// How the discretization covariance Ψᵢ is taken from the neighbours (eq. 17).
///
/// By default as printed; k and τ, which are not, are ours.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Discretization {
    /// k, the size of the neighbourhood, from 1 to 200. 12 by default: about two rings of neighbours,
    /// the second of which hardly counts.
    pub neighbors: usize,
    /// τ, the width of the weights in units of η = Rₖ/√k, which on a surface of spacing h is
    /// h/√π. 2 by default: a neighbour one spacing away weighs e^(−π/4) = 0.46, one two spacings
    /// away 0.04.
    pub width: f64,
    /// Which points the sums run over.
    pub summed: Summed,
    /// Whether no standard deviation of Ψᵢ exceeds the cap that
    /// [`NoiseModel::refine`](crate::NoiseModel::refine) is given: an isolated point far from all
    /// others is then not taken for a surface that reaches to them. Not printed, and off by default.
    pub is_capped: bool,
}

impl Default for Discretization {
    fn default() -> Self {
        Self { neighbors: 12, width: 2.0, summed: Summed::AllPoints, is_capped: false }
    }
}

/// More neighbours than this are no neighbourhood, and looking for them takes minutes: with the message
/// that says so.
const MOST_NEIGHBORS: (usize, &str) = (200, "at most 200; 12 are usual");

impl Discretization {
    /// Checks the settings.
    ///
    /// # Errors
    /// When there are no neighbours or more than 200, or the width is not positive and finite.
    pub fn validate(&self) -> Result<(), SettingsError> {
        check_at_least_one("discretization.neighbors", self.neighbors)?;
        check_at_most("discretization.neighbors", self.neighbors, MOST_NEIGHBORS)?;
        check_positive("discretization.width", self.width)
    }

    /// How far (m) points count, given the k nearest neighbours in order of distance.
    pub(crate) fn reach(&self, nearest: &[Neighbor]) -> f64 {
        let Some(last) = nearest.last() else { return f64::INFINITY };
        match self.summed {
            Summed::Neighbors => last.squared_distance.sqrt(),
            Summed::AllPoints => self.squared_reach(nearest).max(last.squared_distance).sqrt(),
        }
    }

    /// τᵢ² for k neighbours of which this is the last, m².
    fn squared_width(&self, nearest: &[Neighbor]) -> f64 {
        let last = nearest.last().map_or(0.0, |last| last.squared_distance);
        self.width.powi(2) * last / nearest.len() as f64
    }

    /// Where the weights are lost beside that of the point itself, m².
    fn squared_reach(&self, nearest: &[Neighbor]) -> f64 {
        self.squared_width(nearest) * LEAST_WEIGHT.ln().abs()
    }
}

/// The discretization covariance Ψᵢ of point `index` (eq. 17), m²; `None` for a point without
/// neighbours, about which it says nothing.
///
/// Ψᵢ = Σⱼ wᵢⱼ (xⱼ−xᵢ)(xⱼ−xᵢ)ᵀ / Σⱼ wᵢⱼ with wᵢⱼ = exp(−|xⱼ−xᵢ|²/τᵢ²), τᵢ = τ Rₖ/√k and Rₖ the
/// distance of the k-th nearest other position. [`Discretization::summed`] says what j runs over.
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
    let nearest = neighborhoods.nearest(index, settings.neighbors);
    Ok(sampling_error(neighborhoods, index, &nearest, settings))
}

/// Ψᵢ given the k nearest neighbours in order of distance.
pub(crate) fn sampling_error(
    neighborhoods: &Neighborhoods,
    index: usize,
    nearest: &[Neighbor],
    settings: &Discretization,
) -> Option<Covariance> {
    let first = nearest.first()?;
    let variance = settings.squared_width(nearest);
    let sum = |neighbors: &[Neighbor], of_point: f64, from: f64| {
        weighted_scatter(neighborhoods.points(), index, neighbors, variance, of_point, from)
    };
    Some(match settings.summed {
        // Relative to the nearest, so that narrow weights do not all vanish; it cancels out.
        Summed::Neighbors => sum(nearest, 0.0, first.squared_distance),
        Summed::AllPoints => {
            let all = neighborhoods.positions().within(index, settings.squared_reach(nearest));
            sum(&all, 1.0, 0.0)
        }
    })
}

/// Beside the weight 1 of the point itself less than this is lost to rounding.
const LEAST_WEIGHT: f64 = 0.5 * f64::EPSILON;

/// Σ w d dᵀ / (w₀ + Σ w) with w = exp(−(|d|² − `from`)/`variance`) and w₀ = `of_point`.
fn weighted_scatter(
    points: &[Point3],
    index: usize,
    neighbors: &[Neighbor],
    variance: f64,
    of_point: f64,
    from: f64,
) -> Covariance {
    let mut total = of_point;
    let mut scatter = Matrix3::zeros();
    for neighbor in neighbors {
        let weight = (-(neighbor.squared_distance - from) / variance).exp();
        // At the distance of the nearest the weight is one, even where the width underflows.
        let weight = if weight.is_nan() { 1.0 } else { weight };
        let offset = points[neighbor.index] - points[index];
        total += weight;
        scatter += offset * offset.transpose() * weight;
    }
    Covariance::from_symmetric(&(scatter / total))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums over the nearest neighbours.
    const NEAREST: Discretization =
        Discretization { neighbors: 12, width: 2.0, summed: Summed::Neighbors, is_capped: false };

    fn line(xs: &[f64]) -> Neighborhoods {
        Neighborhoods::new(xs.iter().map(|&x| Point3::new(x, 0.0, 0.0)).collect()).unwrap()
    }

    #[test]
    fn matches_the_formula_by_hand() {
        // From x = 0: neighbours at 1 and -2, so R = 2, k = 2, and the width is 1 · 2/√2.
        let cloud = line(&[0.0, 1.0, -2.0, 50.0]);
        let settings = Discretization { neighbors: 2, width: 1.0, ..NEAREST };
        let psi = discretization(&cloud, 0, &settings).unwrap().unwrap();
        let (near, far) = ((-1.0_f64 / 2.0).exp(), (-4.0_f64 / 2.0).exp());
        let expected = (near * 1.0 + far * 4.0) / (near + far);
        let found = psi.upper_triangle();
        assert!((found[0] - expected).abs() < 1e-12, "{found:?} against {expected}");
        assert!(found[1..].iter().all(|v| v.abs() < 1e-15), "{found:?}");
    }

    /// As printed: j runs over all points and i itself. The code summed over twelve neighbours only.
    #[test]
    fn the_printed_sums_run_over_all_points_and_the_point_itself() {
        let xs = [0.0, 1.0, -2.0, 2.5, 50.0];
        let cloud = line(&xs);
        let settings = Discretization { neighbors: 2, width: 1.0, ..Discretization::default() };
        let psi = discretization(&cloud, 0, &settings).unwrap().unwrap();
        let weight = |x: f64| (-x * x / 2.0).exp();
        let total: f64 = xs.iter().map(|&x| weight(x)).sum();
        let expected = xs.iter().map(|&x| weight(x) * x * x).sum::<f64>() / total;
        assert!((psi.upper_triangle()[0] - expected).abs() < 1e-14, "{psi:?} against {expected}");
        assert_eq!(discretization(&line(&[3.0, 3.0]), 0, &settings), Ok(None));
    }

    #[test]
    fn narrow_weights_leave_the_nearest_neighbour() {
        let cloud = line(&[0.0, 1.0, -2.0]);
        let settings = Discretization { neighbors: 2, width: 1e-3, ..NEAREST };
        let psi = discretization(&cloud, 0, &settings).unwrap().unwrap();
        assert!((psi.upper_triangle()[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn printed_sums_are_a_ninth_smaller_on_a_square_lattice() {
        let place = |i: i32| Point3::new(f64::from(i % 17), f64::from(i / 17), 0.0);
        let lattice = Neighborhoods::new((0..289).map(place).collect()).unwrap();
        let [ours, printed] = [Summed::Neighbors, Summed::AllPoints].map(|summed| {
            let settings = Discretization { summed, ..Discretization::default() };
            discretization(&lattice, 144, &settings).unwrap().unwrap().matrix().trace()
        });
        assert!((printed / ours - 0.889).abs() < 0.001, "{printed} of {ours}");
    }

    #[test]
    fn a_lone_point_has_none_and_bad_settings_are_refused() {
        let settings = Discretization::default();
        assert_eq!(discretization(&line(&[3.0, 3.0]), 0, &settings), Ok(None));
        for bad in [
            Discretization { neighbors: 0, ..settings },
            // All of a room were looked for about each of its points, for minutes.
            Discretization { neighbors: 201, ..settings },
            Discretization { width: 0.0, ..settings },
            Discretization { width: f64::NAN, ..settings },
        ] {
            assert!(matches!(
                discretization(&line(&[0.0, 1.0]), 0, &bad),
                Err(NoiseError::Setting(_))
            ));
        }
    }
}
