//! What is true of two meshes: intersection, distance, inside tests, penetration depth.
//!
//! Fast answers come from parry in double precision; [`brute`] has slow ones of our own, against
//! which the tests hold them.

pub mod brute;
mod component;
mod contains;
mod distance;
mod penetration;
mod touch;

use cloudtouch_geom::{Pose, TriangleMesh, Vector3};
use parry3d_f64::{
    math::{self, Vector},
    query,
    shape::TriMesh,
};

use component::{Component, components};

pub use touch::{Touch, WayOut};

/// A mesh prepared for exact questions; surfaces are what counts unless a name says solid.
pub struct ExactMesh {
    mesh: TriangleMesh,
    shape: TriMesh,
    components: Vec<Component>,
}

impl ExactMesh {
    /// Builds the search tree and finds the connected components.
    pub fn new(mesh: &TriangleMesh) -> Self {
        Self { mesh: mesh.clone(), shape: trimesh(mesh), components: components(mesh) }
    }

    /// The mesh it was made of.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    pub(crate) fn shape(&self) -> &TriMesh {
        &self.shape
    }

    /// Whether the two surfaces have a point in common.
    ///
    /// `self_from_other` places the other mesh. One solid wholly inside another does not count:
    /// see [`Self::solids_overlap`]. May go either way when they touch within about 1e-9 m.
    pub fn intersects(&self, other: &Self, self_from_other: &Pose) -> bool {
        let placed = parry_pose(self_from_other);
        query::intersection_test(&math::Pose::IDENTITY, &self.shape, &placed, &other.shape)
            .expect("parry intersects triangle meshes")
            .intersecting
    }

    /// Whether the two solids have a point in common: surfaces that intersect, or a component of
    /// one inside the other. Both meshes must be closed for the latter.
    pub fn solids_overlap(&self, other: &Self, self_from_other: &Pose) -> bool {
        // Without a common surface point a component is inside as a whole or not at all.
        let inside = |outer: &Self, inner: &Self, outer_from_inner: &Pose| {
            let place = |c: &Component| outer_from_inner.transform_point(&c.vertex);
            inner.components.iter().any(|c| outer.contains(&place(c)))
        };
        self.intersects(other, self_from_other)
            || inside(self, other, self_from_other)
            || inside(other, self, &self_from_other.inverse())
    }
}

/// The mesh as parry has it.
pub fn trimesh(mesh: &TriangleMesh) -> TriMesh {
    let vertices = mesh.vertices().iter().map(|p| parry_vector(&p.coords)).collect();
    TriMesh::new(vertices, mesh.triangles().to_vec()).expect("a triangle mesh has triangles")
}

/// A vector as parry has it.
pub fn parry_vector(v: &Vector3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

/// A pose as parry has it.
pub fn parry_pose(pose: &Pose) -> math::Pose {
    let q = pose.rotation();
    math::Pose::from_parts(
        parry_vector(&pose.translation()),
        math::Rotation::from_xyzw(q.i, q.j, q.k, q.w),
    )
}
