//! The triangles of a mesh about places that a search comes by.

use std::collections::BTreeMap;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Motion, Point3};

use crate::body::BodyRef;

use super::facet::Facet;
use super::leaf::facets_of;

/// Facets of the mesh of a pair in the frame of A, by the leaves of its tree: many discs pass the same
/// leaves, and each is moved once.
#[derive(Debug, Default)]
pub(super) struct Around {
    leaves: BTreeMap<NodeId, Vec<Facet>>,
}

impl Around {
    /// Those of the leaves within a distance (m) of a place in the frame of A; none of a cloud.
    pub(super) fn facets(
        &mut self,
        body: BodyRef<'_>,
        a_from_mesh: Option<&Motion>,
        place: &Point3,
        radius: f64,
    ) -> Vec<Facet> {
        let BodyRef::Mesh(mesh) = body else { return Vec::new() };
        let local = a_from_mesh.map_or(*place, |motion| motion.point_back(place));
        let mut facets = Vec::new();
        mesh.visit_leaves_near(&local, radius, |leaf| {
            let moved = || facets_of(mesh, leaf.id(), a_from_mesh);
            facets.extend_from_slice(self.leaves.entry(leaf.id()).or_insert_with(moved));
        });
        facets
    }
}
