//! Gathers the passages that two leaves may have while one of them drifts.

use crate::cloud::{DISC_SPACINGS, edge_along};

use super::course::Course;
use super::dividing::Dividing;
use super::drifts::Drifts;
use super::leaf::{SweptCloud, SweptEdges, SweptMesh};
use super::passage::{Adrift, may_pierce, mesh_through_disc};
use super::pool::Passages;
use super::track::{Direction, SweptFacet};
use crate::search::compare::facet::Facet;
use crate::search::cross::crossings::Witness;
use crate::search::cross::past::Past;
use crate::search::visit::around::OfMesh;
use crate::search::visit::leaf::{ExactLeaf, NoisyLeaf};

/// Whether an edge may get to a disc of another leaf, as `search/cross/gather.rs` asks of leaves that keep
/// still.
pub(super) fn may_reach(
    of_edges: &SweptCloud<'_>,
    of_discs: &NoisyLeaf<'_>,
    drift: &Course,
) -> bool {
    let NoisyLeaf { ball, slab, .. } = of_discs;
    let (turn, direction) = (drift.turn(), Direction::new(slab.direction, drift));
    of_edges.leaf.surfels.iter().zip(&of_edges.tracks).any(|(surfel, track)| {
        let Some(normal) = surfel.normal else { return false };
        let half = DISC_SPACINGS * surfel.spacing;
        let across = edge_along(&normal, &slab.direction) + turn;
        slab.is_within(&track.place, half * across + track.along(&direction))
            && track.gets_to(ball, half + DISC_SPACINGS * ball.spacing)
    })
}

/// The same of the facets of a mesh, and of discs, which reach no farther.
pub(super) fn may_reach_facets(
    of_edges: &SweptCloud<'_>,
    facets: &ExactLeaf,
    drift: &Course,
) -> bool {
    of_edges.leaf.surfels.iter().zip(&of_edges.tracks).any(|(surfel, track)| {
        let Some(normal) = surfel.normal else { return false };
        let half = DISC_SPACINGS * surfel.spacing;
        let gets_to_plane = |facet: &Facet| {
            let Some(n) = facet.normal else { return true };
            let across = edge_along(&normal, &n) + drift.turn();
            let room = half * across + track.along(&Direction::new(n, drift));
            facet.height(&track.place).abs() <= room
        };
        track.gets_to(&facets.ball, half) && facets.facets.iter().any(gets_to_plane)
    })
}

/// Whether any edge of a leaf may meet a disc of another, all of each looked at as one box.
pub(super) fn may_meet(
    is_a: bool,
    (of_edges, edges): (&SweptCloud<'_>, &SweptEdges),
    of_discs: &SweptCloud<'_>,
    dividing: Dividing,
) -> bool {
    let (Some(edges), Some(discs)) = (&edges.hull, &of_discs.discs) else { return false };
    let (still, drifting) = if is_a { (edges, discs) } else { (discs, edges) };
    let thin = [of_discs, of_edges].map(|leaf| leaf.leaf.slab.direction);
    dividing.known().chain(thin).all(|n| still.meets_along(drifting, &n))
}

/// Adds the passages of edges of one leaf, which drift so, through discs of another.
pub(super) fn add_edges_through_discs(
    is_a: bool,
    of_edges: &SweptCloud<'_>,
    of_discs: &NoisyLeaf<'_>,
    drift: &Course,
    (found, dividing): (&mut Passages, &mut Dividing),
) {
    let Some(edges) = of_edges.edges() else { return };
    let (around, slab) = (of_discs.ball, of_discs.slab);
    // Most discs are beyond all edges of the leaf.
    let thin = [slab.direction, of_edges.leaf.slab.direction];
    let discs = dividing.discs_met(&of_discs.surfels, edges, thin, drift);
    if discs.is_empty() {
        return;
    }
    let direction = Direction::new(slab.direction, drift);
    for (edge, track) in edges.all.iter().zip(&edges.tracks) {
        let room = track.ends[0].along(&direction).max(track.ends[1].along(&direction));
        if !slab.may_hold(edge.ends.each_ref(), room) {
            continue;
        }
        let half = edge.half_length;
        if !track.middle.gets_to(&around, half + DISC_SPACINGS * around.spacing) {
            continue;
        }
        let past = Past::new(of_edges.leaf.cloud, edge, of_edges.motion.as_ref());
        let adrift = Adrift::new(is_a, edge, track, &past);
        for disc in &discs {
            let near =
                track.middle.times_near(&disc.point.mean, half + DISC_SPACINGS * disc.spacing);
            let Some(times) = near else { continue };
            if let Some(passage) = adrift.through_disc(disc, times, drift) {
                found.add(Witness::edge(is_a, edge), &track.middle, &passage);
            }
        }
    }
}

/// Adds the passages of edges of a leaf through the triangles of another.
pub(super) fn add_edges_through_facets(
    is_a: bool,
    of_edges: &SweptCloud<'_>,
    facets: &SweptMesh,
    drifts: &Drifts,
    (found, dividing): (&mut Passages, &mut Dividing),
) {
    let Some(edges) = of_edges.edges() else { return };
    let SweptEdges { all, tracks, .. } = edges;
    let met = dividing.facets_met(facets, edges, of_edges.leaf.slab.direction, drifts.of(!is_a));
    if met.is_empty() {
        return;
    }
    for (edge, track) in all.iter().zip(tracks) {
        if !track.middle.gets_to(&facets.leaf.ball, edge.half_length) {
            continue;
        }
        let past = Past::new(of_edges.leaf.cloud, edge, of_edges.motion.as_ref());
        let adrift = Adrift::new(is_a, edge, track, &past);
        for facet in &met {
            if let Some(passage) = adrift.through_facet(*facet, drifts) {
                found.add(Witness::edge(is_a, edge), &track.middle, &passage);
            }
        }
    }
}

/// Adds what a mesh may do to the discs of a leaf that one of these triangles may get to; `around` gives
/// all triangles of the mesh within a distance of a place.
pub(super) fn add_mesh_through_discs(
    is_a: bool,
    discs: &SweptCloud<'_>,
    facets: &SweptMesh,
    around: &mut OfMesh<'_>,
    drifts: &Drifts,
    found: &mut Passages,
) {
    let Some(hull) = discs.discs else { return };
    let thin = Direction::new(discs.leaf.slab.direction, drifts.of(!is_a));
    let met = facets.facets().filter(|facet| hull.meets_facet(facet, &thin));
    let met: Vec<SweptFacet<'_>> = met.collect();
    if met.is_empty() {
        return;
    }
    for (disc, track) in discs.leaf.surfels.iter().zip(&discs.tracks) {
        let Some(normal) = disc.normal else { continue };
        if !track.gets_to(&facets.leaf.ball, DISC_SPACINGS * disc.spacing) {
            continue;
        }
        let off = may_pierce(is_a, (disc, track), &normal, &met, drifts);
        if let Some(off) = off.filter(|_| disc.spacing > 0.0) {
            let passage = mesh_through_disc(disc, (normal, off), around, drifts.of(is_a));
            found.add(Witness::disc(is_a, disc), track, &passage);
        }
    }
}
