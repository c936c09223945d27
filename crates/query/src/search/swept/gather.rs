//! Gathers the passages that two leaves may have while one of them drifts.

use cloudtouch_geom::{Drift, Point3};

use crate::cloud::{DISC_SPACINGS, SLOPE};

use super::super::crossings::Witness;
use super::super::facet::Facet;
use super::super::leaf::{ExactLeaf, NoisyLeaf};
use super::passage::{Adrift, may_pierce, mesh_through_disc};
use super::pool::Passages;
use super::track::Track;

/// Whether an edge may get to a disc of another leaf, as `search/gather.rs` asks of leaves that keep
/// still.
pub(super) fn may_reach(of_edges: &NoisyLeaf<'_>, of_discs: &NoisyLeaf<'_>, drift: &Drift) -> bool {
    let NoisyLeaf { ball, slab, .. } = of_discs;
    let turn = drift.turn();
    of_edges.surfels.iter().any(|surfel| {
        let Some(normal) = surfel.normal else { return false };
        let half = DISC_SPACINGS * surfel.spacing;
        let middle = &surfel.point.mean;
        let across = SLOPE.mul_add(slab.cosine(&normal), slab.sine(&normal)) + turn;
        slab.is_within(middle, half * across + drift.along(&slab.direction, middle))
            && Track::of(middle, drift).gets_to(ball, half + DISC_SPACINGS * ball.spacing)
    })
}

/// The same of the facets of a mesh.
pub(super) fn may_reach_facets(
    of_edges: &NoisyLeaf<'_>,
    facets: &ExactLeaf,
    drift: &Drift,
) -> bool {
    of_edges.surfels.iter().any(|surfel| {
        let middle = &surfel.point.mean;
        let track = Track::of(middle, drift);
        surfel.normal.is_some() && track.gets_to(&facets.ball, DISC_SPACINGS * surfel.spacing)
    })
}

/// Adds the passages of edges of one leaf through discs of another.
pub(super) fn add_edges_through_discs(
    is_a: bool,
    of_edges: &NoisyLeaf<'_>,
    of_discs: &NoisyLeaf<'_>,
    drift: &Drift,
    found: &mut Passages,
) {
    let (around, slab) = (of_discs.ball, of_discs.slab);
    for edge in of_edges.edges() {
        let room = edge.ends.map(|end| drift.along(&slab.direction, &end));
        if !slab.may_hold(&edge.ends, room[0].max(room[1])) {
            continue;
        }
        let adrift = Adrift::new(is_a, edge, drift);
        let track = Track::of(&nalgebra::center(&edge.ends[0], &edge.ends[1]), drift);
        // Its ends may get ahead of its middle by the turn.
        let half = edge.half_length * (1.0 + drift.turn());
        if !track.gets_to(&around, half + DISC_SPACINGS * around.spacing) {
            continue;
        }
        for disc in of_discs.surfels.iter() {
            if track.keeps_off(&disc.point.mean) > half + DISC_SPACINGS * disc.spacing {
                continue;
            }
            if let Some(passage) = adrift.through_disc(disc, drift) {
                found.add(Witness::edge(is_a, edge), &passage);
            }
        }
    }
}

/// Adds the passages of edges of a leaf through the triangles of another.
pub(super) fn add_edges_through_facets(
    is_a: bool,
    of_edges: &NoisyLeaf<'_>,
    facets: &ExactLeaf,
    drift: &Drift,
    found: &mut Passages,
) {
    for edge in of_edges.edges() {
        let adrift = Adrift::new(is_a, edge, drift);
        let track = Track::of(&nalgebra::center(&edge.ends[0], &edge.ends[1]), drift);
        if !track.gets_to(&facets.ball, edge.half_length * (1.0 + drift.turn())) {
            continue;
        }
        for facet in &facets.facets {
            if let Some(passage) = adrift.through_facet(facet, drift) {
                found.add(Witness::edge(is_a, edge), &passage);
            }
        }
    }
}

/// Adds what a mesh may do to the discs of a leaf that one of these triangles may get to; `around` gives
/// all triangles of the mesh within a distance of a place.
pub(super) fn add_mesh_through_discs(
    is_a: bool,
    discs: &NoisyLeaf<'_>,
    facets: &ExactLeaf,
    around: impl Fn(&Point3, f64) -> Vec<Facet>,
    drift: &Drift,
    found: &mut Passages,
) {
    for disc in discs.surfels.iter() {
        let Some(normal) = disc.normal else { continue };
        let track = Track::of(&disc.point.mean, drift);
        if !track.gets_to(&facets.ball, DISC_SPACINGS * disc.spacing) {
            continue;
        }
        let off = may_pierce(is_a, disc, &normal, &facets.facets, drift);
        if let Some(off) = off.filter(|_| disc.spacing > 0.0) {
            let passage = mesh_through_disc(is_a, disc, (normal, off), &around, drift);
            found.add(Witness::disc(is_a, disc), &passage);
        }
    }
}
