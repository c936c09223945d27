//! The first rung: a plane, which is cheap and often enough.

use cloudtouch_svm::{DEFAULT_KAPPA_MAX, separate};

use crate::classifier::{PairAnswer, PairPoint, PairPoints, Surface};

/// Beyond this many standard deviations on either side of a plane, no kernel problem is solved:
/// every point is less probable than 1e-6.
const CERTAIN_DEVIATIONS: f64 = DEFAULT_KAPPA_MAX;

/// What the best plane between the points says.
#[derive(Debug)]
pub(super) enum Plane {
    /// No point is on the wrong side of it with more than 1e-6.
    Certain(PairAnswer),
    /// Some point may be.
    Doubtful(PairAnswer),
    /// None separates the points.
    None,
}

/// Separates the points by a plane.
pub(super) fn by_plane(points: &PairPoints) -> Plane {
    let uncertain = |side: &[PairPoint]| side.iter().map(|p| p.point).collect::<Vec<_>>();
    let (a, b) = (uncertain(&points.a), uncertain(&points.b));
    // Why there is none makes no difference here.
    let Ok(separation) = separate(&a, &b, CERTAIN_DEVIATIONS) else { return Plane::None };
    match PairAnswer::of(Surface::Plane(separation), &a, &b) {
        Some(answer) if separation.kappa >= CERTAIN_DEVIATIONS => Plane::Certain(answer),
        Some(answer) => Plane::Doubtful(answer),
        None => Plane::None,
    }
}
