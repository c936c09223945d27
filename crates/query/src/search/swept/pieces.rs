//! How few deviations two pieces of surface can have between them while one of them drifts.
//!
//! Two pieces with the offset δ have at least n·δ/√(nᵀΣn) deviations between them, for any n. Where δ
//! moves by s·u, s from −1 to 1, and by no more than r beside that, these are at least
//! (n·δ − |n·u| − r)/√(nᵀΣn), and of all n the one that says most is Σ⁻¹(δ + s·u) for the s with the
//! fewest deviations.

use cloudtouch_geom::Vector3;

use crate::cloud::Surfel;

use super::course::Course;
use super::track::{
    Approach, Direction, Drifting, SweptFacet, Track, directions, least_at, nearest_time,
};
use crate::search::compare::meeting::{LEAST_STD, solve};
use crate::search::compare::triangle::nearest_to_origin;
use crate::search::compare::whitening::Whitening;

/// The pieces of two clouds, that of B drifting along its track; `None` where they have `limit` or more.
pub(super) fn between_discs(
    a: &Surfel,
    (b, track): (&Surfel, &Track),
    drift: &Course,
    limit: f64,
) -> Option<f64> {
    let offset = track.place - a.point.mean;
    let way = track.way;
    let reach = track.beside + limit * (a.most_variance + b.most_variance).sqrt();
    // No direction has more variance than this: most pairs end here.
    if (offset + way * nearest_time(&offset, &way)).norm_squared() > reach * reach {
        return None;
    }
    let joint = a.point.covariance.sum(&b.point.covariance).matrix();
    let (of_offset, of_way) = (solve(&joint, &offset)?, solve(&joint, &way)?);
    let time = least_at(way.dot(&of_offset), way.dot(&of_way));
    let Some(n) = (of_offset + of_way * time).try_normalize(0.0) else { return Some(0.0) };
    let n = Direction::new(n, drift);
    let gap = n.n.dot(&offset) - track.along(&n);
    let of_a = a.point.covariance.variance_along(&n.n);
    let deviations = gap / (of_a + turned_variance(b, &n, drift)).max(LEAST_STD.powi(2)).sqrt();
    (deviations < limit).then_some(deviations.max(0.0))
}

/// A piece of a cloud and an exact one. `is_facet_still`: whether the piece of the cloud drifts.
pub(super) fn to_facet(
    (surfel, whitening, track): (&Surfel, &Whitening, &Track),
    SweptFacet { facet, corners }: SweptFacet<'_>,
    is_facet_still: bool,
    drift: &Course,
    limit: f64,
) -> Option<f64> {
    let mean = surfel.point.mean;
    let drifting = if is_facet_still { Drifting::Place(track) } else { Drifting::Corners(corners) };
    let approach = Approach { place: &mean, facet, drifting, drift };
    let along = |n: &Vector3| {
        let n = Direction::new(*n, drift);
        let gap = approach.gap_along(&n);
        let variance = match is_facet_still {
            true => turned_variance(surfel, &n, drift),
            false => surfel.point.covariance.variance_along(&n.n),
        };
        (gap, gap / variance.max(LEAST_STD.powi(2)).sqrt())
    };
    if let Some(n) = facet.normal {
        let n = if facet.height(&mean) > 0.0 { -n } else { n };
        if along(&n).1 >= limit {
            return None;
        }
    }
    let offsets = facet.corners.map(|corner| corner - mean);
    let shortest = nearest_to_origin(&offsets);
    let mut most: f64 = 0.0;
    if let Some(n) = shortest.try_normalize(0.0) {
        let (gap, deviations) = along(&n);
        if gap > limit * surfel.most_variance.sqrt() {
            return None;
        }
        most = most.max(deviations);
    }
    let way = whitening.apply(&approach.way());
    let corners = offsets.map(|offset| whitening.apply(&offset));
    for n in directions(&corners, &way) {
        // Across what parts them in standard deviations.
        let Some(n) = whitening.apply(&n).try_normalize(0.0) else { break };
        most = most.max(along(&n).1);
        if most >= limit {
            return None;
        }
    }
    Some(most)
}

/// nᵀΣn of a piece at any turn of the drift.
pub(super) fn turned_variance(surfel: &Surfel, n: &Direction, drift: &Course) -> f64 {
    if drift.turn() == 0.0 {
        return surfel.point.covariance.variance_along(&n.n);
    }
    let most = surfel.most_variance.sqrt();
    let turned = surfel.point.covariance.std_along(&n.n) + drift.turn() * n.across * most;
    turned.min(most).powi(2)
}
