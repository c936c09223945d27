//! One leaf pair: the ladder from a plane to a kernel classifier, and the surface it ends with.

use cloudtouch_svm::{DEFAULT_KAPPA_MAX, separate};

use crate::mode::Mode;
use crate::report::Stats;

use super::clock::Clock;
use super::pair::{PairAnswer, PairPoint, PairPoints};
use super::settings::QuerySettings;
use super::surface::Surface;
use super::train::by_kernel;

/// Beyond this many standard deviations on either side of a plane, no kernel problem is solved:
/// every point is less probable than 1e-6.
const CERTAIN_DEVIATIONS: f64 = DEFAULT_KAPPA_MAX;

/// Climbs the ladder until a rung answers.
///
/// A probability is a statement about the best separating surface there is: among the surfaces
/// tried, the calibrated mode takes the one whose worst point is least probable, and trains no
/// kernel classifier where a plane already keeps every point below what is `known` from other
/// pairs. The paper's mode takes the kernel classifier unless a plane is certain.
pub(crate) fn classify(
    points: &PairPoints,
    settings: &QuerySettings,
    known: f64,
    clock: &Clock,
    stats: &mut Stats,
) -> PairAnswer {
    let uncertain = |side: &[PairPoint]| side.iter().map(|p| p.point).collect::<Vec<_>>();
    let (a, b) = (uncertain(&points.a), uncertain(&points.b));
    // Why there is none makes no difference here.
    let separation = separate(&a, &b, CERTAIN_DEVIATIONS).ok();
    let plane = separation.and_then(|s| PairAnswer::of(Surface::Plane(s), &a, &b));
    let plane = match plane {
        Some(plane) if separation.is_some_and(|s| s.kappa >= CERTAIN_DEVIATIONS) => {
            stats.linear_certificates += 1;
            return plane;
        }
        plane => plane,
    };
    if settings.mode == Mode::Paper {
        let kernel = by_kernel(points, settings, clock, stats);
        return match (plane, kernel) {
            (Some(plane), PairAnswer::Indistinct | PairAnswer::Undecided) => plane,
            (_, kernel) => kernel,
        };
    }
    match plane {
        Some(plane) if plane.largest() <= known => {
            stats.linear_certificates += 1;
            plane
        }
        Some(plane) => {
            let kernel = by_kernel(points, settings, clock, stats);
            if plane.largest() <= kernel.largest() { plane } else { kernel }
        }
        None => by_kernel(points, settings, clock, stats),
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};

    use super::*;

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
        for mode in [Mode::Calibrated, Mode::Paper] {
            let settings = QuerySettings { penalty: 1e-4, ..QuerySettings::new(mode) };
            let clock = Clock::new(Instant::now(), None);
            let (points, stats) = (rows(0.02), &mut Stats::default());
            let trained = by_kernel(&points, &settings, &clock, stats);
            assert!(matches!(trained, PairAnswer::Undecided), "{trained:?}");
            // What the plane says stands.
            let answer = classify(&points, &settings, 0.0, &clock, stats);
            let PairAnswer::Separated { surface: Surface::Plane(_), .. } = answer else {
                panic!("{answer:?}");
            };
        }
    }

    #[test]
    fn a_solve_ends_with_the_time_of_the_query() {
        let settings = QuerySettings::new(Mode::Calibrated);
        let stats = &mut Stats::default();
        let over = Clock::new(Instant::now(), Some(Duration::ZERO));
        let cut_short = by_kernel(&rows(0.005), &settings, &over, stats);
        assert!(matches!(cut_short, PairAnswer::Undecided), "{cut_short:?}");
    }
}
