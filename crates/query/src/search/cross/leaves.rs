//! Adds the crossings of two leaves, whatever they are of.

use cloudtouch_geom::Motion;

use crate::body::BodyRef;
use crate::search::visit::around::{Around, OfMesh};
use crate::search::visit::leaf::{Leaf, NoisyLeaf};
use crate::search::visit::side::Side;

use super::crossings::Crossings;
use super::gather::{add_edges_through_discs, add_edges_through_facets, add_mesh_through_discs};
use super::near::{may_cross_a_disc, may_cross_a_facet, reaching, reaching_facets};
use super::near_discs::Memory;

pub(in crate::search) fn cross<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Motion,
    leaves: (&mut Leaf<'a>, &mut Leaf<'a>),
    [of_a, of_b]: &mut [Side; 2],
    (crossings, known, memory): (&mut Crossings, &mut Around, &mut Memory),
) {
    match leaves {
        (Leaf::Noisy(on_a), Leaf::Noisy(on_b)) => {
            let near = reaching(on_a, on_b);
            let may_cross = |on_a: &NoisyLeaf<'a>| may_cross_a_disc(on_a, on_b);
            if !near.is_none() && on_a.has_edges_or(may_cross, of_a) {
                add_edges_through_discs(None, (on_a, near), on_b, memory, crossings);
            }
            let near = reaching(on_b, on_a);
            let may_cross = |on_b: &NoisyLeaf<'a>| may_cross_a_disc(on_b, on_a);
            if !near.is_none() && on_b.has_edges_or(may_cross, of_b) {
                add_edges_through_discs(Some(a_from_b), (on_b, near), on_a, memory, crossings);
            }
        }
        (Leaf::Noisy(noisy), Leaf::Exact(exact)) => {
            let near = reaching_facets(noisy, exact);
            if !near.is_none() {
                if noisy.has_edges_or(|noisy| may_cross_a_facet(noisy, exact), of_a) {
                    add_edges_through_facets(None, (noisy, near), exact, crossings);
                }
                let mut around = OfMesh { known, body: b, a_from_mesh: Some(a_from_b) };
                add_mesh_through_discs(true, noisy, exact, &mut around, crossings);
            }
        }
        (Leaf::Exact(exact), Leaf::Noisy(noisy)) => {
            let near = reaching_facets(noisy, exact);
            if !near.is_none() {
                if noisy.has_edges_or(|noisy| may_cross_a_facet(noisy, exact), of_b) {
                    add_edges_through_facets(Some(a_from_b), (noisy, near), exact, crossings);
                }
                let mut around = OfMesh { known, body: a, a_from_mesh: None };
                add_mesh_through_discs(false, noisy, exact, &mut around, crossings);
            }
        }
        // Two meshes are tested exactly and never come here.
        (Leaf::Exact(_), Leaf::Exact(_)) => {}
    }
}
