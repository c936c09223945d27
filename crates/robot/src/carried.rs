//! What moves with the links of a robot: their shapes, and what they hold.

use std::sync::Arc;

use cloudtouch::geom::{Point3, Pose};
use cloudtouch::{Body, BodyRef};

use crate::robot::Robot;

/// A body that moves with a link.
#[derive(Debug, Clone)]
pub(crate) struct Carried {
    /// In the scene.
    pub name: String,
    /// By its place among the links.
    pub link: usize,
    pub link_from_body: Pose,
    pub body: Arc<Body>,
    /// No point of it is farther from the origin of the link, m.
    pub radius: f64,
    /// Whether it is a part of the link, and not held by it.
    pub is_shape: bool,
}

/// A ball that holds all of an exact body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    middle: Point3,
    /// m.
    radius: f64,
}

/// Poses and sums may misplace a ball by this part of its coordinates at most.
const ROUNDING: f64 = 1e-9;

impl Ball {
    /// Whether nothing of one meets anything of the other, however they go this way (m) altogether.
    pub(crate) fn is_beyond(&self, other: &Self, way: f64) -> bool {
        let coordinates = self.middle.coords.norm() + other.middle.coords.norm();
        let reach = self.radius + other.radius + way;
        (self.middle - other.middle).norm() > reach + ROUNDING * (reach + coordinates)
    }
}

/// Surface is expected this part of a size beyond the points that were measured at most.
const BEYOND_POINTS: f64 = 0.01;

impl Carried {
    pub(crate) fn shapes_of(robot: &Robot) -> Vec<Self> {
        let carried = robot.body_names().into_iter().zip(&robot.shapes).map(|(name, shape)| Self {
            name,
            link: shape.link,
            link_from_body: Pose::identity(),
            body: Arc::clone(&shape.body),
            radius: shape.radius,
            is_shape: true,
        });
        carried.collect()
    }

    /// What a link holds at a pose from its file frame into that of the link.
    pub(crate) fn held(name: String, link: usize, link_from_body: Pose, body: Arc<Body>) -> Self {
        let [low, high] = BodyRef::from(&*body).corners();
        let corner = |i: usize| {
            let [x, y, z] = [0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
            link_from_body.transform_point(&Point3::new(x, y, z)).coords.norm()
        };
        let farthest = (0..8).map(corner).fold(0.0, f64::max);
        let radius = farthest + BEYOND_POINTS * (high - low).norm();
        Self { name, link, link_from_body, body, radius, is_shape: false }
    }

    /// About the box of a mesh that is at a pose; none of a cloud, whose surface is not known to end with its points.
    pub(crate) fn ball(&self, pose: &Pose) -> Option<Ball> {
        let [low, high] = match &*self.body {
            Body::Mesh(mesh) => BodyRef::from(mesh).corners(),
            Body::Cloud(_) => return None,
        };
        let middle = pose.transform_point(&(low + 0.5 * (high - low)));
        Some(Ball { middle, radius: 0.5 * (high - low).norm() })
    }

    /// From its file frame into that of the base, given the poses of all links.
    pub(crate) fn pose(&self, links: &[Pose]) -> Pose {
        links[self.link].after(&self.link_from_body)
    }
}
