//! References that are obviously right and slow.

use cloudtouch_geom::{Point3, UncertainPoint, seed};
use rand_chacha::ChaCha8Rng;

use crate::random::normal_vector;

/// Indices of the `k` points nearest to `query`, nearest first, ties by lower index.
///
/// Gives fewer when there are fewer; `query` itself is found when it is one of the points.
pub fn nearest_neighbours(points: &[Point3], query: &Point3, k: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let distance = |&i: &usize| (points[i] - query).norm_squared();
    order.sort_by(|i, j| distance(i).total_cmp(&distance(j)).then(i.cmp(j)));
    order.truncate(k);
    order
}

/// The least distance between a point of `a` and one of `b`, m; infinite when one is empty.
pub fn minimum_distance(a: &[Point3], b: &[Point3]) -> f64 {
    a.iter()
        .flat_map(|p| b.iter().map(move |q| (p - q).norm_squared()))
        .fold(f64::INFINITY, f64::min)
        .sqrt()
}

/// A probability found by trying.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The share of trials that succeeded.
    pub probability: f64,
    /// Its standard error, never below that of half a success, so that 0 is not taken as certain.
    pub standard_error: f64,
}

impl Estimate {
    /// Whether `probability` is within `errors` standard errors.
    pub fn agrees_with(&self, probability: f64, errors: f64) -> bool {
        (self.probability - probability).abs() <= errors * self.standard_error
    }
}

/// The share of `trials` in which `succeeds` says yes, each with the next numbers of one stream.
///
/// # Panics
/// When there are no trials.
pub fn monte_carlo(
    trials: usize,
    seed: u64,
    mut succeeds: impl FnMut(&mut ChaCha8Rng) -> bool,
) -> Estimate {
    assert!(trials > 0, "an estimate needs at least one trial");
    let mut rng = seed::generator(seed);
    let n = trials as f64;
    let successes = (0..trials).filter(|_| succeeds(&mut rng)).count() as f64;
    let shrunk = successes.clamp(0.5, n - 0.5) / n;
    Estimate { probability: successes / n, standard_error: (shrunk * (1.0 - shrunk) / n).sqrt() }
}

/// A draw from the distribution of an uncertain point.
pub fn draw(point: &UncertainPoint, rng: &mut ChaCha8Rng) -> Point3 {
    point.mean + point.covariance.sqrt() * normal_vector(rng)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, normal};

    use super::*;

    #[test]
    fn neighbours_come_nearest_first_and_ties_in_order() {
        let points: Vec<_> =
            [3.0, 1.0, -1.0, 0.0].iter().map(|&x| Point3::new(x, 0.0, 0.0)).collect();
        assert_eq!(nearest_neighbours(&points, &Point3::origin(), 3), [3, 1, 2]);
        assert_eq!(nearest_neighbours(&points, &Point3::origin(), 9).len(), 4);
        assert_eq!(minimum_distance(&points[..1], &points[1..]), 2.0);
        assert_eq!(minimum_distance(&points, &[]), f64::INFINITY);
        // Missing returns do not count.
        let points = [Point3::new(f64::NAN, 0.0, 0.0), Point3::new(3.0, 4.0, 0.0)];
        assert_eq!(minimum_distance(&points, &[Point3::origin()]), 5.0);
        assert_eq!(minimum_distance(&points[..1], &[Point3::origin()]), f64::INFINITY);
    }

    #[test]
    fn drawing_agrees_with_the_normal_distribution() {
        // P(z < 0) for a mean one standard deviation above the plane, however the ellipsoid lies.
        let point = UncertainPoint {
            mean: Point3::new(5.0, -2.0, 0.02),
            covariance: Covariance::diagonal([1.0, 0.0, 0.0004]),
        };
        let estimate = monte_carlo(20_000, 5, |rng| draw(&point, rng).z < 0.0);
        assert!(estimate.agrees_with(normal::cdf(-1.0), 4.0), "{estimate:?}");
        assert!(!estimate.agrees_with(0.5, 4.0));
        let never = monte_carlo(100, 0, |_| false);
        assert!(never.probability == 0.0 && never.standard_error > 0.0);
    }
}
