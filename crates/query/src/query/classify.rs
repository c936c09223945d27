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
        let kernel = by_kernel(points, settings, known, clock, stats);
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
            let kernel = by_kernel(points, settings, known, clock, stats);
            if plane.largest() <= kernel.largest() { plane } else { kernel }
        }
        None => by_kernel(points, settings, known, clock, stats),
    }
}
