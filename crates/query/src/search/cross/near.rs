//! Which pieces of a leaf are so near another leaf that an edge from there may cross what is in it.
//!
//! That can be told before the edges are known: the half of one that is counted at a piece is not longer than
//! its disc reaches, and runs along the surface.

use cloudtouch_geom::Vector3;

use crate::cloud::{DISC_SPACINGS, MOST_ALONG, Pieces, Surfel, edge_along};
use crate::search::compare::facet::Facet;
use crate::search::visit::leaf::{ExactLeaf, NoisyLeaf};

/// Distances are rounded, relative, generously.
const ROUNDING: f64 = 1e-9;

/// The pieces of a leaf near which an edge from there may cross a disc of another leaf, by what encloses that.
pub(in crate::search) fn reaching(of_edges: &NoisyLeaf<'_>, of_discs: &NoisyLeaf<'_>) -> Pieces {
    let NoisyLeaf { ball, slab, .. } = of_discs;
    let mut reaching = Pieces::default();
    for (place, surfel) in of_edges.surfels.iter().enumerate() {
        let Some(normal) = surfel.normal else { continue };
        let half = DISC_SPACINGS * surfel.spacing;
        let middle = &surfel.point.mean;
        let off = slab.distance(middle);
        // PERF: most are told by their height alone.
        if off <= half * MOST_ALONG
            && ball.is_within(middle, half + DISC_SPACINGS * ball.spacing)
            && (off == 0.0 || off <= half * edge_along(&normal, &slab.direction))
        {
            reaching.insert(place);
        }
    }
    reaching
}

/// The pieces of a leaf of which the disc, or the near half of an edge, may reach a facet.
pub(in crate::search) fn reaching_facets(of_edges: &NoisyLeaf<'_>, facets: &ExactLeaf) -> Pieces {
    let reaches = |surfel: &Surfel| {
        surfel.normal.is_some()
            && facets.ball.is_within(&surfel.point.mean, DISC_SPACINGS * surfel.spacing)
    };
    let pieces = of_edges.surfels.iter().enumerate();
    pieces.filter(|(_, surfel)| reaches(surfel)).map(|(place, _)| place).collect()
}

/// The same disc by disc: whether there is any. It takes longer, but not as long as fitting what edges lead to.
pub(in crate::search) fn may_cross_a_disc(
    of_edges: &NoisyLeaf<'_>,
    of_discs: &NoisyLeaf<'_>,
) -> bool {
    let crosses = |from: &Surfel, normal: &Vector3, disc: &Surfel| {
        let offset = disc.point.mean - from.point.mean;
        let half = DISC_SPACINGS * from.spacing;
        let reach = half.mul_add(1.0 + ROUNDING, DISC_SPACINGS * disc.spacing);
        let is_along = |across: &Vector3| {
            offset.dot(across).abs() <= half * edge_along(normal, across) * (1.0 + ROUNDING)
        };
        offset.norm_squared() <= reach * reach && disc.normal.as_ref().is_some_and(is_along)
    };
    let mut from = of_edges.surfels.iter().filter_map(|from| Some((from, from.normal?)));
    from.any(|(from, normal)| of_discs.surfels.iter().any(|disc| crosses(from, &normal, disc)))
}

/// The same for facets.
pub(in crate::search) fn may_cross_a_facet(of_edges: &NoisyLeaf<'_>, facets: &ExactLeaf) -> bool {
    let mut from = of_edges.surfels.iter();
    from.any(|from| facets.facets.iter().any(|facet| may_reach_through(from, facet)))
}

/// Whether an edge may lead from a piece through a facet.
pub(super) fn may_reach_through(from: &Surfel, facet: &Facet) -> bool {
    let half = DISC_SPACINGS * from.spacing * (1.0 + ROUNDING);
    let is_along = |(normal, across): (&Vector3, &Vector3)| {
        facet.height(&from.point.mean).abs() <= half * edge_along(normal, across)
    };
    from.normal.as_ref().zip(facet.normal.as_ref()).is_some_and(is_along)
        && facet.way_from(&from.point.mean).norm() <= half
}
