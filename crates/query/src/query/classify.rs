//! One leaf pair: the ladder from a plane to a kernel classifier, and the surface it ends with.

use crate::classifier::{
    ClassifierSettings, Clock, PairAnswer, PairPoints, Plane, by_kernel, by_plane,
};
use crate::report::Stats;

/// Climbs the ladder until a rung answers.
///
/// A probability is a statement about the best separating surface there is: the surface whose worst
/// point is least probable is taken, and no kernel classifier is trained where a plane already keeps
/// every point below what is `known` from other pairs.
pub(super) fn classify(
    points: &PairPoints,
    settings: &ClassifierSettings,
    known: f64,
    clock: &Clock,
    stats: &mut Stats,
) -> PairAnswer {
    match by_plane(points) {
        Plane::Certain(plane) => {
            stats.linear_certificates += 1;
            plane
        }
        Plane::Doubtful(plane) if plane.largest() <= known => {
            stats.linear_certificates += 1;
            plane
        }
        Plane::Doubtful(plane) => {
            let kernel = by_kernel(points, settings, clock, stats);
            if plane.largest() <= kernel.largest() { plane } else { kernel }
        }
        Plane::None => by_kernel(points, settings, clock, stats),
    }
}
