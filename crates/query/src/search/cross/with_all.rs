//! Adds the crossings of a leaf of a cloud with all of a mesh: each disc and each edge is taken down its tree alone.

use std::f64::consts::SQRT_2;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::Motion;

use crate::cloud::DISC_SPACINGS;
use crate::search::visit::around::OfMesh;
use crate::search::visit::leaf::NoisyLeaf;
use crate::search::visit::side::Side;
use crate::search::visit::within::Passing;

use super::crossings::Crossings;
use super::gather::{add_edge_through_facets, add_mesh_through_disc};
use super::near::may_reach_through;
use super::past::Past;
use super::through_mesh::Outline;

/// `looked_at`: the leaves of the mesh whose crossings with it were added before.
pub(in crate::search) fn cross_with_all(
    noisy: &mut NoisyLeaf<'_>,
    looked_at: &[NodeId],
    mesh: &mut OfMesh<'_>,
    side: &mut Side,
    found: &mut Crossings,
) {
    let is_a = side.motion.is_none();
    if noisy.has_edges_or(|noisy| may_reach_through_any(noisy, mesh), side) {
        add_edges(noisy, looked_at, mesh, side.motion.as_ref(), found);
    }
    for k in 0..noisy.surfels.len() {
        let disc = &noisy.surfels[k];
        let Some(normal) = disc.normal.filter(|_| !noisy.is_pierced(k)) else { continue };
        let (middle, radius) = (disc.point.mean, DISC_SPACINGS * disc.spacing);
        let outline = Outline::new(middle, normal, radius);
        let mut is_passed = false;
        mesh.visit_passed(Passing::Disc { middle, normal, radius }, |_, facets| {
            is_passed = is_passed || outline.is_passed_by(facets);
        });
        if is_passed {
            add_mesh_through_disc(is_a, (noisy, k), (&outline, normal), mesh, found);
        }
    }
}

fn may_reach_through_any(noisy: &NoisyLeaf<'_>, mesh: &mut OfMesh<'_>) -> bool {
    noisy.surfels.iter().filter(|from| from.normal.is_some()).any(|from| {
        let around = SQRT_2 * DISC_SPACINGS * from.spacing;
        mesh.near(&from.point.mean, around).any(|facet| may_reach_through(from, facet))
    })
}

fn add_edges(
    noisy: &mut NoisyLeaf<'_>,
    looked_at: &[NodeId],
    mesh: &mut OfMesh<'_>,
    motion: Option<&Motion>,
    found: &mut Crossings,
) {
    let Some(edges) = noisy.edges else { return };
    for &joint in edges.joints() {
        let edge = edges.edge(joint);
        let edge = motion.map_or(edge, |motion| edge.moved(motion));
        let past = Past::new(noisy.cloud, &edge, motion);
        mesh.visit_passed(Passing::Line { ends: edge.ends }, |id, facets| {
            if !looked_at.contains(&id) {
                let is_a = motion.is_none();
                add_edge_through_facets(is_a, (noisy, &edge, &past), facets, found);
            }
        });
    }
}
