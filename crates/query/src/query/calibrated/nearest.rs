//! The two pieces of surface of two leaves with the least deviations between them.

use crate::recalibration::MOST_DEVIATIONS;

use super::leaf::Leaf;
use super::meeting::squared_deviations;

/// The least squared deviations between two pieces, and which these are; `None` where all have
/// [`MOST_DEVIATIONS`] or more. Notes for every piece what is its least.
pub(super) fn nearest_pieces(a: &mut Leaf<'_>, b: &mut Leaf<'_>) -> Option<(f64, usize, usize)> {
    let mut least = MOST_DEVIATIONS.powi(2);
    let mut nearest = None;
    let mut most_of_b = b.squared.iter().copied().fold(0.0, f64::max);
    for (i, (on_a, least_of_a)) in a.surfels.iter().zip(&mut a.squared).enumerate() {
        let limit = least_of_a.max(most_of_b);
        let reach = (limit * (on_a.most_variance + b.ball.variance)).sqrt();
        if !b.ball.is_within(&on_a.point.mean, reach) {
            continue;
        }
        for (j, (on_b, least_of_b)) in b.surfels.iter().zip(&mut b.squared).enumerate() {
            let limit = least_of_b.max(*least_of_a);
            let Some(squared) = squared_deviations(on_a, on_b, limit) else { continue };
            *least_of_a = least_of_a.min(squared);
            *least_of_b = least_of_b.min(squared);
            if squared < least {
                least = squared;
                nearest = Some((squared, i, j));
            }
        }
        most_of_b = b.squared.iter().copied().fold(0.0, f64::max);
    }
    nearest
}
