//! Gathers the crossings of two leaves.

use cloudtouch_geom::{Motion, Point3, Vector3};

use crate::cloud::{DISC_SPACINGS, Edge, LeafEdges, Pieces};

use super::crossing::{of_mesh, through_disc, through_facet};
use super::crossings::{Crossings, Witness};
use super::past::Past;
use super::through_mesh::Outline;
use crate::search::visit::around::OfMesh;
use crate::search::visit::leaf::{ExactLeaf, NoisyLeaf};

/// A disc that edges of a leaf may pass, as far as most of them are told to miss it.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct NearDisc {
    /// Its place in its leaf.
    at: usize,
    middle: Point3,
    normal: Vector3,
    radius: f64,
}

impl NearDisc {
    /// Whether an edge has its ends on two sides of it, and its middle near enough.
    fn may_be_passed_by(&self, ends: &[Point3; 2], middle: &Point3, half_length: f64) -> bool {
        let reach = half_length + self.radius;
        if (self.middle - middle).norm_squared() > reach * reach {
            return false;
        }
        let height = |end: &Point3| (end - self.middle).dot(&self.normal);
        height(&ends[0]) * height(&ends[1]) < 0.0
    }
}

/// Adds the crossings of edges of one leaf with discs of another near its pieces that [`reaching`] gave;
/// the points they join, and those of the discs, are as probable as their clearest crossing. `motion` leads
/// from where the edges were measured to the frame of A, none those of A; `discs` is memory to use again.
pub(in crate::search) fn add_edges_through_discs(
    motion: Option<&Motion>,
    (of_edges, near): (&mut NoisyLeaf<'_>, Pieces),
    of_discs: &mut NoisyLeaf<'_>,
    discs: &mut Vec<NearDisc>,
    found: &mut Crossings,
) {
    let Some(LeafEdges { edges, joined, slab: edge_slab }) = of_edges.edges else { return };
    let edge_slab = motion.map_or(*edge_slab, |motion| edge_slab.moved(motion));
    // Half of an edge is no longer than a disc of the pieces it is near to.
    let reach = DISC_SPACINGS * of_edges.ball.spacing;
    discs.clear();
    discs.extend(of_discs.surfels.iter().enumerate().filter_map(|(at, disc)| {
        let (normal, middle, radius) =
            (disc.normal?, disc.point.mean, DISC_SPACINGS * disc.spacing);
        let is_near =
            edge_slab.may_hold_disc_of(disc) && of_edges.ball.is_within(&middle, reach + radius);
        is_near.then_some(NearDisc { at, middle, normal, radius })
    }));
    if discs.is_empty() {
        return;
    }
    let (around, slab) = (of_discs.ball, of_discs.slab);
    let (around, slab) = motion
        .map_or((around, slab), |motion| (around.moved_back(motion), slab.moved_back(motion)));
    for (edge, &joined) in edges.iter().zip(joined) {
        if !near.meet(joined) || !slab.may_hold(&edge.ends, 0.0) {
            continue;
        }
        if !around.is_within(&edge.middle(), edge.half_length + DISC_SPACINGS * around.spacing) {
            continue;
        }
        // PERF: of most no more than the ends are asked.
        let ends = motion.map_or(edge.ends, |motion| edge.moved_ends(motion));
        let middle = nalgebra::center(&ends[0], &ends[1]);
        let passes = |disc: &&NearDisc| disc.may_be_passed_by(&ends, &middle, edge.half_length);
        let mut passed = discs.iter().filter(passes).peekable();
        if passed.peek().is_none() {
            continue;
        }
        let edge = &Edge { ends, ..*edge };
        let past = Past::new(of_edges.cloud, edge, motion);
        for &NearDisc { at, .. } in passed {
            let disc = &of_discs.surfels[at];
            let Some(crossing) = through_disc(edge, disc, |end| past.of(end)) else { continue };
            of_discs.raise(at, crossing.probability);
            of_edges.raise_ends(edge, crossing.probability);
            found.add(Witness::edge(motion.is_none(), edge), &middle, &crossing);
        }
    }
}

/// Adds the crossings of edges of a leaf with the triangles of another near its pieces that [`reaching_facets`]
/// gave: an edge is counted by the end that is nearer to what it passes. `motion` as for discs.
pub(in crate::search) fn add_edges_through_facets(
    motion: Option<&Motion>,
    (of_edges, near): (&mut NoisyLeaf<'_>, Pieces),
    facets: &ExactLeaf,
    found: &mut Crossings,
) {
    let Some(LeafEdges { edges, joined, .. }) = of_edges.edges else { return };
    let around = motion.map_or(facets.ball, |motion| facets.ball.moved_back(motion));
    for (edge, &joined) in edges.iter().zip(joined) {
        if !near.meet(joined) || !around.is_within(&edge.middle(), edge.half_length) {
            continue;
        }
        let edge = &motion.map_or(*edge, |motion| edge.moved(motion));
        let past = Past::new(of_edges.cloud, edge, motion);
        for facet in facets.facets.iter() {
            let Some(crossing) = through_facet(edge, facet, |end| past.of(end)) else { continue };
            of_edges.raise_ends(edge, crossing.probability);
            found.add(Witness::edge(motion.is_none(), edge), &edge.middle(), &crossing);
        }
    }
}

/// Adds what a mesh does to the discs of a leaf that one of these triangles passes; `around` gives
/// all triangles of the mesh within a distance of a place.
pub(in crate::search) fn add_mesh_through_discs(
    is_a: bool,
    discs: &mut NoisyLeaf<'_>,
    facets: &ExactLeaf,
    around: &mut OfMesh<'_>,
    found: &mut Crossings,
) {
    for k in 0..discs.surfels.len() {
        let disc = &discs.surfels[k];
        let Some(normal) = disc.normal else { continue };
        let (middle, radius) = (disc.point.mean, DISC_SPACINGS * disc.spacing);
        if discs.is_pierced(k) || !facets.ball.is_within(&middle, radius) {
            continue;
        }
        let outline = Outline::new(middle, normal, radius);
        if !outline.is_passed_by(&facets.facets) {
            continue;
        }
        // Once, and by all of the mesh there: however its triangles are shared out to leaves.
        let through = outline.through(around.near(&middle, std::f64::consts::SQRT_2 * radius));
        let crossing = of_mesh(disc, normal, &through);
        found.add(Witness::disc(is_a, disc), &middle, &crossing);
        discs.set_pierced(k);
        discs.raise(k, crossing.probability);
    }
}
