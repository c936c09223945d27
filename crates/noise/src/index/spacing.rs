//! The spacing of samples: the side of the square of surface that belongs to one point.

use std::f64::consts::PI;

use cloudtouch_geom::Covariance;

use crate::index::neighbor::Neighbor;

/// The neighbour whose distance gives the spacing: enough to average over direction, few enough
/// to stay local.
pub(crate) const SPACING_NEIGHBORS: usize = 6;

/// Where the noise is more than this many spacings the nearest neighbours are all noise.
const NOISY_SPACINGS: f64 = 1.35;

/// The local spacing from neighbours in order of distance; `None` without any.
pub(crate) fn spacing_around(neighbors: &[Neighbor]) -> Option<f64> {
    let rank = neighbors.len().min(SPACING_NEIGHBORS);
    let last = neighbors.get(rank.checked_sub(1)?)?;
    Some(spacing_of_rank(last.squared_distance.sqrt(), rank))
}

/// h from the distance of the neighbour of this rank (from 1): π d² of surface holds `rank` of
/// the squares h².
pub(crate) fn spacing_of_rank(distance: f64, rank: usize) -> f64 {
    distance * (PI / rank as f64).sqrt()
}

/// Whether the noise of a point exceeds the spacing about it so far that its nearest neighbours tell
/// nothing of the surface.
pub(crate) fn is_noisy(noise: &Covariance, spacing: f64) -> bool {
    let most = NOISY_SPACINGS * spacing;
    // PERF: mostly told without eigenvalues.
    !noise.is_within(most) && noise.max_std() > most
}
