//! Robot self points: what the camera sees of the robot that carries it.

use std::sync::Arc;

use cloudtouch_geom::{Point3, PointCloud, Pose, Vector3};

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

impl SelfMesh {
    /// Whether the link was at a place in the frame of the cloud, or within its padding: no other body was
    /// there then. Places of its surface count, however they are rounded.
    pub(crate) fn held(&self, place: &Point3) -> bool {
        /// Of the size of the link; signed distances end within some 1e-7 of it.
        const ROUNDING: f64 = 1e-6;
        self.nearness()(place, self.padding + ROUNDING * self.mesh.size())
    }

    /// The same link in a frame that lies at `origin` in that of the cloud.
    pub(crate) fn seen_from(&self, origin: &Vector3) -> Self {
        let moved = Pose::from_translation(-origin).after(&self.cloud_from_link);
        Self { mesh: self.mesh.clone(), cloud_from_link: moved, padding: self.padding }
    }

    /// Places of its surface in the frame of the cloud.
    pub(crate) fn samples(&self) -> impl Iterator<Item = Point3> + '_ {
        let cloud_from_local =
            self.cloud_from_link.after(&Pose::from_translation(self.mesh.origin()));
        self.mesh.samples().iter().map(move |sample| cloud_from_local.transform_point(sample))
    }

    /// Tells how far a place in the frame of the cloud is from the link, m: negative inside of it, infinite beyond a
    /// distance.
    pub(super) fn distances(&self) -> impl Fn(&Point3, f64) -> f64 + '_ {
        let link_from_cloud = self.cloud_from_link.inverse();
        move |place, most| {
            let away = self.mesh.distance_within(&link_from_cloud.transform_point(place), most);
            away.unwrap_or(f64::INFINITY)
        }
    }

    /// Tells whether a place in the frame of the cloud is inside the link or so near to it, m; for many places.
    fn nearness(&self) -> impl Fn(&Point3, f64) -> bool + '_ {
        let link_from_cloud = self.cloud_from_link.inverse();
        move |place, distance| {
            self.mesh.is_within(&link_from_cloud.transform_point(place), distance)
        }
    }
}

/// Returns the rows that go. An open mesh has no inside: there only the padding removes points.
pub(super) fn keep_outside(
    cloud: &PointCloud,
    kept: &mut Vec<usize>,
    robot: &[SelfMesh],
) -> Vec<usize> {
    let links: Vec<_> = robot.iter().map(|link| (link.nearness(), link.padding)).collect();
    let is_robot = |i: &mut usize| {
        links.iter().any(|(is_within, padding)| is_within(&cloud.points[*i], *padding))
    };
    kept.extract_if(.., is_robot).collect()
}
