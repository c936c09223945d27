//! Which triangles are near a place.

use cloudtouch_bvh::{Node, Obb, Visit};
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
        visit: impl FnMut(Node<'_>),
    ) {
        let is_near = |obb: &Obb| {
            let beyond = (obb.to_local(place).abs() - obb.half_extents).map(|d| d.max(0.0));
            let is_beyond = beyond.norm() > radius;
            !is_beyond
        };
        self.visit_leaves_where(is_near, visit);
    }

    /// Calls `visit` for every leaf whose box, and those of all nodes above it, is wanted.
    pub(crate) fn visit_leaves_where(
        &self,
        is_wanted: impl Fn(&Obb) -> bool,
        mut visit: impl FnMut(Node<'_>),
    ) {
        self.tree().visit_nodes(|node| {
            if !is_wanted(&node.obb()) {
                return Visit::Prune;
            }
            if node.is_leaf() {
                visit(node);
            }
            Visit::Descend
        });
    }
}
