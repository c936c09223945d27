//! A cloud whose points may be inside of a mesh.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::cloud::Cloud;
use crate::mesh::Mesh;

/// Of two bodies the cloud and the mesh, and where they are.
pub(super) struct InMesh<'a> {
    pub cloud: &'a Cloud,
    pub mesh: &'a Mesh,
    pub mesh_is_a: bool,
    pub a_from_cloud: Pose,
    pub a_from_mesh: Pose,
    pub mesh_from_cloud: Pose,
}

impl<'a> InMesh<'a> {
    /// `None` of two clouds, two meshes, and a mesh that has no inside.
    pub(super) fn of((a, b): (BodyRef<'a>, BodyRef<'a>), a_from_b: &Pose) -> Option<Self> {
        let [here, there] = [Pose::identity(), *a_from_b];
        let of = match (a, b) {
            (BodyRef::Cloud(cloud), BodyRef::Mesh(mesh)) => Self {
                cloud,
                mesh,
                mesh_is_a: false,
                a_from_cloud: here,
                a_from_mesh: there,
                mesh_from_cloud: there.inverse(),
            },
            (BodyRef::Mesh(mesh), BodyRef::Cloud(cloud)) => Self {
                cloud,
                mesh,
                mesh_is_a: true,
                a_from_cloud: there,
                a_from_mesh: here,
                mesh_from_cloud: there,
            },
            _ => return None,
        };
        of.mesh.has_solids().then_some(of)
    }
}
