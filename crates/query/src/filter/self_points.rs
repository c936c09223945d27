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

/// Of points that were removed, each with its standard deviation, m, the share that is farther from every link
/// than its noise can tell.
pub(crate) fn beyond_noise<'a>(
    removed: impl Iterator<Item = (&'a Point3, f64)>,
    robot: &[SelfMesh],
) -> f64 {
    /// Standard deviations that no noise reaches.
    const DEVIATIONS: f64 = 6.0;
    let links: Vec<_> = robot.iter().map(|link| (link.nearness(), link.padding)).collect();
    let (mut all, mut beyond) = (0_usize, 0_usize);
    for (point, std) in removed {
        all += 1;
        let reach = DEVIATIONS * std;
        let is_near =
            links.iter().any(|(is_within, padding)| is_within(point, reach.min(*padding)));
        beyond += usize::from(!is_near);
    }
    beyond as f64 / all.max(1) as f64
}
