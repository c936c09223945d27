//! Many bodies of which few are near one another: balls in rows, and an arm over the first of these.

use std::f64::consts::PI;

use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3};

use crate::measured::measured;
use crate::scene;

/// Standard deviation of the noise of the balls, m.
pub const STD: f64 = 0.001;

const RADIUS: f64 = 0.05;
/// Of each ball.
const POINTS: f64 = 1000.0;

/// A hundred balls and an arm of twelve links.
#[derive(Debug, Clone)]
pub struct Workshop {
    /// Of each ball its name, a thousand points as measured with a noise of [`STD`], and its place.
    pub balls: Vec<(String, Vec<Point3>, Pose)>,
    /// The shape of each link.
    pub link: TriangleMesh,
    /// Of each link its name and its place, along the arm: every link touches the next.
    pub links: Vec<(String, Pose)>,
}

/// Always the same. The arm of 2.4 m passes 1 cm above nine balls of the first row, each below one or two of its
/// links.
pub fn workshop() -> Workshop {
    let spacing = (4.0 * PI * RADIUS.powi(2) / POINTS).sqrt();
    let ball = |k: u32| {
        let points = measured(&scene::sphere(RADIUS, 3), spacing, STD, u64::from(k));
        let place = at(0.3 * f64::from(k % 10), 0.3 * f64::from(k / 10), 0.0);
        (format!("ball {k}"), points, place)
    };
    let link = |k: u32| (format!("link {k}"), at(0.15 + 0.2 * f64::from(k), 0.0, 0.08));
    Workshop {
        balls: (0..100).map(ball).collect(),
        link: scene::cuboid([0.2, 0.04, 0.04]),
        links: (0..12).map(link).collect(),
    }
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::from_translation(Vector3::new(x, y, z))
}
