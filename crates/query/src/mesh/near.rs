//! Which triangles are near a place.

use cloudtouch_bvh::{Node, Visit};
use cloudtouch_geom::Point3;

use super::prepare::Mesh;

impl Mesh {
    /// Calls `visit` for every triangle that may come within `radius` metres of a place in the local
    /// frame, with its corners; each comes once.
    pub(crate) fn visit_triangles_near(
        &self,
        place: &Point3,
        radius: f64,
        mut visit: impl FnMut(u32, [Point3; 3]),
    ) {
        self.visit_leaves_near(place, radius, |leaf| {
            for &triangle in leaf.primitive_indices() {
                visit(triangle, self.corners(triangle as usize));
            }
        });
    }

    /// Calls `visit` for every leaf whose triangles may come so near.
    pub(crate) fn visit_leaves_near(
        &self,
        place: &Point3,
        radius: f64,
        mut visit: impl FnMut(Node<'_>),
    ) {
        self.tree().visit_nodes(|node| {
            let obb = node.obb();
            let beyond = (obb.to_local(place).abs() - obb.half_extents).map(|d| d.max(0.0));
            if beyond.norm() > radius {
                return Visit::Prune;
            }
            if node.is_leaf() {
                visit(node);
            }
            Visit::Descend
        });
    }
}
