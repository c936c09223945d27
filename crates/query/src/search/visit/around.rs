//! The triangles of a mesh about places that a search comes by.

use std::rc::Rc;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Motion, Point3};

use crate::body::BodyRef;
use crate::mesh::Mesh;
use crate::stats::Stats;

use super::leaf::{ExactLeaf, Leaf, facets_of};
use super::leaves::Leaves;
use super::side::Side;
use crate::search::compare::facet::Facet;

/// Facets of the mesh of a pair in the frame of A, by the leaves of its tree: many discs pass the same
/// leaves, and each is moved once.
#[derive(Debug, Default)]
pub(in crate::search) struct Around(Leaves<Rc<Vec<Facet>>>);

impl Around {
    /// A leaf of a body, moved to the frame of A.
    pub(in crate::search) fn load<'a>(
        &mut self,
        body: BodyRef<'a>,
        id: NodeId,
        side: &mut Side,
        stats: &mut Stats,
    ) -> Leaf<'a> {
        match body {
            BodyRef::Cloud(_) => Leaf::load(body, id, side, stats),
            BodyRef::Mesh(mesh) => {
                let place = self.place(mesh, id, side.motion.as_ref());
                Leaf::Exact(ExactLeaf::of(Rc::clone(self.0.at(place))))
            }
        }
    }

    /// The facets of a leaf of the mesh.
    pub(super) fn facets(&mut self, mesh: &Mesh, id: NodeId, motion: Option<&Motion>) -> &[Facet] {
        let place = self.place(mesh, id, motion);
        self.0.at(place)
    }

    /// Where the facets of a leaf are, which are moved here where they are not.
    fn place(&mut self, mesh: &Mesh, id: NodeId, motion: Option<&Motion>) -> usize {
        self.0.place(id, || Rc::new(facets_of(mesh, id, motion)))
    }
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
        let Self { known, body, a_from_mesh } = self;
        let mut near = Vec::new();
        if let BodyRef::Mesh(mesh) = body {
            let local = a_from_mesh.map_or(*place, |motion| motion.point_back(place));
            mesh.visit_leaves_near(&local, radius, |leaf| {
                near.push(known.place(mesh, leaf.id(), *a_from_mesh));
            });
        }
        let Around(leaves) = &**known;
        near.into_iter().flat_map(|place| leaves.at(place).iter())
    }
}
