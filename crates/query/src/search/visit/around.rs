//! The triangles of a mesh about places that a search comes by.

use std::collections::BTreeMap;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Motion, Point3};

use crate::body::BodyRef;

use super::leaf::facets_of;
use crate::search::compare::facet::Facet;

/// Facets of the mesh of a pair in the frame of A, by the leaves of its tree: many discs pass the same
/// leaves, and each is moved once.
#[derive(Debug, Default)]
pub(in crate::search) struct Around {
    leaves: BTreeMap<NodeId, Vec<Facet>>,
}

/// These and where they come from.
pub(in crate::search) struct OfMesh<'a> {
    pub known: &'a mut Around,
    pub body: BodyRef<'a>,
    /// `None` where the mesh is A.
    pub a_from_mesh: Option<&'a Motion>,
}

impl OfMesh<'_> {
    /// Those of the leaves within a distance (m) of a place in the frame of A; none of a cloud.
    pub(in crate::search) fn near(
        &mut self,
        place: &Point3,
        radius: f64,
    ) -> impl Iterator<Item = &Facet> {
        let Self { known: Around { leaves }, body, a_from_mesh } = self;
        let mut near = Vec::new();
        if let BodyRef::Mesh(mesh) = body {
            let local = a_from_mesh.map_or(*place, |motion| motion.point_back(place));
            mesh.visit_leaves_near(&local, radius, |leaf| {
                leaves.entry(leaf.id()).or_insert_with(|| facets_of(mesh, leaf.id(), *a_from_mesh));
                near.push(leaf.id());
            });
        }
        near.into_iter().filter_map(|id| leaves.get(&id)).flatten()
    }
}
