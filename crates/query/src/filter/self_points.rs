//! Robot self points: what the camera sees of the robot that carries it.

use std::sync::Arc;

use cloudtouch_geom::{PointCloud, Pose};

use crate::mesh::Mesh;

/// A link of the robot in the frame of the cloud.
#[derive(Debug, Clone)]
pub struct SelfMesh {
    /// The link.
    pub mesh: Arc<Mesh>,
    /// Maps the frame of the link into the frame of the cloud.
    pub cloud_from_link: Pose,
    /// Points within this distance of the link's surface go too, m.
    pub padding: f64,
}

/// An open mesh has no inside: there only the padding removes points.
pub(super) fn keep_outside(cloud: &PointCloud, kept: &mut Vec<usize>, robot: &[SelfMesh]) {
    for link in robot {
        let link_from_cloud = link.cloud_from_link.inverse();
        kept.retain(|&i| {
            let point = link_from_cloud.transform_point(&cloud.points[i]);
            !link.mesh.is_within(&point, link.padding)
        });
    }
}
