//! One leaf pair: the kernel classifier, unless a plane is certain.

use crate::classifier::{PairAnswer, PairPoints, Trained, by_kernel};
use crate::stats::Stats;

use super::plane::{Plane, by_plane};
use super::task::Task;

/// The kernel classifier's answer. Where a plane is tried first, one that keeps every point below 1e-6
/// would say the same sooner; one that does not stands in where the classifier has no answer.
pub(super) fn classify(points: &PairPoints, task: &Task<'_>, stats: &mut Stats) -> Trained {
    let plane = if task.settings.plane_first { by_plane(points) } else { Plane::None };
    let by_plane = |answer| Trained { answer, solution: None };
    if let Plane::Certain(answer) = plane {
        stats.linear_certificates += 1;
        return by_plane(answer);
    }
    let kernel = by_kernel(points, &task.classifier, &task.clock, stats);
    match (plane, &kernel.answer) {
        (Plane::Doubtful(plane), PairAnswer::Indistinct | PairAnswer::Undecided) => by_plane(plane),
        _ => kernel,
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use cloudtouch_bvh::TraversalSettings;
    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};
    use cloudtouch_svm::Kernel;

    use super::*;
    use crate::classifier::{ClassifierSettings, Clock, PairPoint, Surface};
    use crate::paper::PaperSettings;

    /// Two rows of points along x, A above B by `gap`, m.
    fn rows(gap: f64) -> PairPoints {
        let row = |z: f64| -> Vec<PairPoint> {
            let at = |i: u32| UncertainPoint {
                mean: Point3::new(0.01 * f64::from(i), 0.0, z),
                covariance: Covariance::isotropic(0.004 * 0.004),
            };
            (0..12)
                .map(|i| PairPoint { index: Some(i), point: at(i), spacing: 0.01, radius: None })
                .collect()
        };
        PairPoints { a: row(gap), b: row(0.0), ..PairPoints::default() }
    }

    #[test]
    fn an_open_bias_was_read_as_its_middle() {
        // So small a penalty that no multiplier is free.
        let settings = ClassifierSettings { penalty: 1e-4, ..ClassifierSettings::default() };
        let clock = Clock::new(Instant::now(), None);
        let (points, stats) = (rows(0.02), &mut Stats::default());
        let trained = by_kernel(&points, &settings, &clock, stats).answer;
        assert!(matches!(trained, PairAnswer::Undecided), "{trained:?}");
        // What the plane says stands, where one was asked.
        let answer = |plane_first, stats: &mut Stats| {
            let of_paper = PaperSettings { plane_first, ..PaperSettings::default() };
            let traversal = TraversalSettings::default();
            let task = Task { settings: &of_paper, classifier: settings, traversal, clock };
            classify(&points, &task, stats).answer
        };
        let printed = answer(false, stats);
        assert!(matches!(printed, PairAnswer::Undecided), "{printed:?}");
        let answer = answer(true, stats);
        let PairAnswer::Separated { surface: Surface::Plane(_), .. } = answer else {
            panic!("{answer:?}");
        };
    }

    #[test]
    fn a_solve_ends_with_the_time_of_the_query() {
        let settings = ClassifierSettings::default();
        let stats = &mut Stats::default();
        let over = Clock::new(Instant::now(), Some(Duration::ZERO));
        let cut_short = by_kernel(&rows(0.005), &settings, &over, stats).answer;
        assert!(matches!(cut_short, PairAnswer::Undecided), "{cut_short:?}");
    }

    #[test]
    fn a_solve_cut_short_said_that_nothing_separates_the_pair() {
        // At a loose tolerance w = 0 cannot be excluded; at a tight one it can, and the bias is open.
        let settings = ClassifierSettings {
            kernel: Kernel::Gaussian { gamma: 10.0 },
            penalty: 0.3,
            distrusts_noise: false,
            ..ClassifierSettings::default()
        };
        for limit in [None, Some(Duration::ZERO)] {
            let clock = Clock::new(Instant::now(), limit);
            let answer = by_kernel(&rows(0.005), &settings, &clock, &mut Stats::default()).answer;
            assert!(matches!(answer, PairAnswer::Undecided), "{limit:?}: {answer:?}");
        }
    }

    #[test]
    fn a_gap_too_large_to_read_probabilities_at_left_every_pair_undecided() {
        let clock = Clock::new(Instant::now(), None);
        for relative_gap in [0.02, 0.05, 0.5] {
            let settings = ClassifierSettings { relative_gap, ..ClassifierSettings::default() };
            let answer = by_kernel(&rows(0.04), &settings, &clock, &mut Stats::default()).answer;
            assert!(matches!(answer, PairAnswer::Separated { .. }), "{relative_gap}: {answer:?}");
        }
    }
}
