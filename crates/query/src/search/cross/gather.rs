//! Gathers the crossings of two leaves.

use cloudtouch_geom::{Motion, Vector3};

use crate::cloud::{DISC_SPACINGS, Edge, Pieces};

use super::crossing::{of_mesh, through_disc, through_facet};
use super::crossings::{Crossings, Witness};
use super::near_discs::{Memory, NearDisc, Told};
use super::past::Past;
use super::through_mesh::Outline;
use crate::search::compare::facet::Facet;
use crate::search::visit::around::OfMesh;
use crate::search::visit::leaf::{ExactLeaf, NoisyLeaf};

/// Adds the crossings of edges of one leaf with discs of another near its pieces that [`reaching`] gave;
/// the points they join, and those of the discs, are as probable as their clearest crossing. `motion` leads
/// from where the edges were measured to the frame of A, none those of A.
pub(in crate::search) fn add_edges_through_discs(
    motion: Option<&Motion>,
    (of_edges, near): (&mut NoisyLeaf<'_>, Pieces),
    of_discs: &mut NoisyLeaf<'_>,
    Memory { discs, ends: told }: &mut Memory,
    found: &mut Crossings,
) {
    let Some(edges) = of_edges.edges else { return };
    let edge_slab = motion.map_or(edges.slab, |motion| edges.slab.moved(motion));
    // Half of an edge is no longer than a disc of the pieces it is near to.
    let reach = DISC_SPACINGS * of_edges.ball.spacing;
    discs.clear();
    discs.extend(of_discs.surfels.iter().enumerate().filter_map(|(at, disc)| {
        let near = NearDisc::of(disc, at)?;
        let is_near = edge_slab.may_hold_disc_of(disc)
            && of_edges.ball.is_within(&near.middle, reach + near.radius);
        is_near.then_some(near)
    }));
    if discs.is_empty() {
        return;
    }
    let slab = of_discs.slab;
    let slab = motion.map_or(slab, |motion| slab.moved_back(motion));
    told.clear();
    told.extend(edges.ends().map(|(own, end)| {
        Told::new(slab.is_left_by(&end.place), own.is_some_and(|place| near.has(place)))
    }));
    for &joint in edges.joints() {
        let [from, to] = joint.places().map(|end| told[end]);
        if !from.may_pass(to) {
            continue;
        }
        // PERF: of most no more than the ends are asked.
        let ends = edges.ends_of(joint).map(|end| end.place);
        let ends = motion.map_or(ends, |motion| ends.map(|end| motion.point(&end)));
        let mut passed = discs.iter().filter(|disc| disc.parts(&ends)).peekable();
        if passed.peek().is_none() {
            continue;
        }
        let edge = edges.edge(joint);
        let middle = nalgebra::center(&ends[0], &ends[1]);
        let edge = &Edge { ends, ..edge };
        let past = Past::new(of_edges.cloud, edge, motion);
        let near = |disc: &&NearDisc| disc.is_within_reach(&middle, edge.half_length);
        for &NearDisc { at, .. } in passed.filter(near) {
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
    let Some(edges) = of_edges.edges else { return };
    let around = motion.map_or(facets.ball, |motion| facets.ball.moved_back(motion));
    for &joint in edges.joints() {
        if !near.meet(edges.pieces_of(joint)) {
            continue;
        }
        let edge = edges.edge(joint);
        if !around.is_within(&edge.middle(), edge.half_length) {
            continue;
        }
        let edge = &motion.map_or(edge, |motion| edge.moved(motion));
        let past = Past::new(of_edges.cloud, edge, motion);
        let is_a = motion.is_none();
        add_edge_through_facets(is_a, (of_edges, edge, &past), &facets.facets, found);
    }
}

/// Adds the crossings of one edge of a leaf, in the frame of A, with some facets.
pub(super) fn add_edge_through_facets(
    is_a: bool,
    (of_edge, edge, past): (&mut NoisyLeaf<'_>, &Edge, &Past<'_>),
    facets: &[Facet],
    found: &mut Crossings,
) {
    for facet in facets {
        let Some(crossing) = through_facet(edge, facet, |end| past.of(end)) else { continue };
        of_edge.raise_ends(edge, crossing.probability);
        found.add(Witness::edge(is_a, edge), &edge.middle(), &crossing);
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
        add_mesh_through_disc(is_a, (discs, k), (&outline, normal), around, found);
    }
}

/// The same for one disc that is passed: once, and by all of the mesh there, however its triangles are shared out
/// to leaves.
pub(super) fn add_mesh_through_disc(
    is_a: bool,
    (discs, k): (&mut NoisyLeaf<'_>, usize),
    (outline, normal): (&Outline, Vector3),
    around: &mut OfMesh<'_>,
    found: &mut Crossings,
) {
    let disc = &discs.surfels[k];
    let (middle, radius) = (disc.point.mean, DISC_SPACINGS * disc.spacing);
    let through = outline.through(around.near(&middle, std::f64::consts::SQRT_2 * radius));
    let crossing = of_mesh(disc, normal, &through);
    found.add(Witness::disc(is_a, disc), &middle, &crossing);
    discs.set_pierced(k);
    discs.raise(k, crossing.probability);
}
