//! What geometry says of single points, for pictures and planners.

use crate::record::{Evidence, PointProbability, Side};
use crate::search::{Found, Leaf, NoisyLeaf};

/// Adds the points that were looked for; none is more probable than the collision is.
pub(in crate::query) fn add_points(found: &Found<'_>, collision: f64, evidence: &mut Evidence) {
    let within = found.deviations_of_interest();
    for (side, leaves) in [(Side::A, &found.leaves_a), (Side::B, &found.leaves_b)] {
        for leaf in leaves.in_order() {
            if let Leaf::Noisy(leaf) = leaf {
                add_leaf(side, leaf, (within, collision), evidence);
            }
        }
    }
}

fn add_leaf(
    side: Side,
    leaf: &NoisyLeaf<'_>,
    (within, collision): (f64, f64),
    evidence: &mut Evidence,
) {
    for (surfel, probability) in leaf.probabilities(within) {
        evidence.add_point(PointProbability {
            side,
            index: Some(surfel.index),
            position: surfel.point.mean,
            probability: probability.min(collision),
            spacing: surfel.spacing,
        });
    }
}
