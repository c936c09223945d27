//! The distance between two surfaces, both trees descended at once.

use std::cell::Cell;

use cloudtouch_geom::Pose;
use parry3d_f64::{
    bounding_volume::Aabb,
    math::Vector,
    query::{PointQuery, details::distance_support_map_support_map},
    shape::TriMesh,
};

use super::{ExactMesh, parry_pose, parry_vector};

/// Vertices from which a first bound is looked for.
const STARTS: usize = 16;

impl ExactMesh {
    /// The distance between the two surfaces, m; zero when they intersect.
    pub fn distance(&self, other: &Self, self_from_other: &Pose) -> f64 {
        if self.intersects(other, self_from_other) {
            return 0.0;
        }
        let placed = parry_pose(self_from_other);
        let (here, there) = (self.shape(), other.shape());
        let least = Cell::new(self.bound(other, self_from_other));
        let near = |box_here: Aabb, box_there: Aabb| {
            let box_there = box_there.transform_by(&placed);
            let apart = (box_there.mins - box_here.maxs).max(box_here.mins - box_there.maxs);
            apart.max(Vector::ZERO).length() < least.get()
        };
        let pairs = here.bvh().leaf_pairs(there.bvh(), |a, b| near(a.aabb(), b.aabb()));
        for (i, j) in pairs {
            let (s, t) = (here.triangle(i), there.triangle(j));
            least.set(least.get().min(distance_support_map_support_map(&placed, &s, &t)));
        }
        least.get()
    }

    /// A distance of two of their points: from vertices of the other to and fro.
    fn bound(&self, other: &Self, self_from_other: &Pose) -> f64 {
        let onto = |shape: &TriMesh, p: Vector| shape.project_local_point(p, false).point;
        let placed = parry_pose(self_from_other);
        let vertices = other.mesh().vertices();
        let starts = vertices.iter().step_by(vertices.len().div_ceil(STARTS));
        let ways = starts.map(|vertex| {
            let from = placed.transform_point(parry_vector(&vertex.coords));
            let to = onto(self.shape(), from);
            ((to - from).length(), to)
        });
        let (mut length, mut on_self) =
            ways.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a mesh has vertices");
        for _ in 0..4 {
            let local = placed.inverse_transform_point(on_self);
            let on_other = placed.transform_point(onto(other.shape(), local));
            on_self = onto(self.shape(), on_other);
            length = length.min((on_self - on_other).length());
        }
        length
    }
}
