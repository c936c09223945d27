//! One leaf pair: the kernel classifier, unless a plane is certain.

use crate::classifier::{ClassifierSettings, Clock, PairAnswer, PairPoints, by_kernel};
use crate::report::Stats;

use super::plane::{Plane, by_plane};

/// The kernel classifier's answer. A plane that keeps every point below 1e-6 would say the same
/// sooner; one that does not stands in where the classifier has no answer.
pub(crate) fn classify(
    points: &PairPoints,
    settings: &ClassifierSettings,
    clock: &Clock,
    stats: &mut Stats,
) -> PairAnswer {
    let plane = match by_plane(points) {
        Plane::Certain(plane) => {
            stats.linear_certificates += 1;
            return plane;
        }
        Plane::Doubtful(plane) => Some(plane),
        Plane::None => None,
    };
    let kernel = by_kernel(points, settings, clock, stats);
    match (plane, kernel) {
        (Some(plane), PairAnswer::Indistinct | PairAnswer::Undecided) => plane,
        (_, kernel) => kernel,
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};

    use super::*;
    use crate::classifier::{PairPoint, Surface};

    /// Two rows of points along x, A above B by `gap`, m.
    fn rows(gap: f64) -> PairPoints {
        let row = |z: f64| -> Vec<PairPoint> {
            let at = |i: u32| UncertainPoint {
                mean: Point3::new(0.01 * f64::from(i), 0.0, z),
                covariance: Covariance::isotropic(0.004 * 0.004),
            };
            (0..12).map(|i| PairPoint { index: Some(i), point: at(i), spacing: 0.01 }).collect()
        };
        PairPoints { a: row(gap), b: row(0.0), ..PairPoints::default() }
    }

    #[test]
    fn an_open_bias_was_read_as_its_middle() {
        // So small a penalty that no multiplier is free.
        let settings = ClassifierSettings { penalty: 1e-4, ..ClassifierSettings::default() };
        let clock = Clock::new(Instant::now(), None);
        let (points, stats) = (rows(0.02), &mut Stats::default());
        let trained = by_kernel(&points, &settings, &clock, stats);
        assert!(matches!(trained, PairAnswer::Undecided), "{trained:?}");
        // What the plane says stands.
        let answer = classify(&points, &settings, &clock, stats);
        let PairAnswer::Separated { surface: Surface::Plane(_), .. } = answer else {
            panic!("{answer:?}");
        };
    }

    #[test]
    fn a_solve_ends_with_the_time_of_the_query() {
        let settings = ClassifierSettings::default();
        let stats = &mut Stats::default();
        let over = Clock::new(Instant::now(), Some(Duration::ZERO));
        let cut_short = by_kernel(&rows(0.005), &settings, &over, stats);
        assert!(matches!(cut_short, PairAnswer::Undecided), "{cut_short:?}");
    }
}
