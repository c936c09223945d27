//! What a hard case is, and the two pairs of clouds that most of them vary.

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::{scene, surface::sample_surface};

/// Two clouds in one frame with a covariance per point, raw: it may be what no type lets through.
#[derive(Debug, Clone, PartialEq)]
pub struct HardCase {
    /// A short name, unique in the catalogue.
    pub name: &'static str,
    /// Why it is hard.
    pub reason: &'static str,
    /// Positions, m.
    pub cloud_a: Vec<Point3>,
    /// Positions, m.
    pub cloud_b: Vec<Point3>,
    /// One matrix per point of `cloud_a`, m².
    pub covariance_a: Vec<Matrix3>,
    /// One matrix per point of `cloud_b`, m².
    pub covariance_b: Vec<Matrix3>,
    /// Whether every number is one a caller may pass, and the noise of no whole cloud is larger than
    /// it. Where not, a typed error is the right answer,
    /// or a filter that says what it dropped; never a panic, and never "free" for no reason.
    pub valid: bool,
    /// Whether the surfaces behind the clouds have a point in common, where that is beyond doubt.
    pub collides: Option<bool>,
}

impl HardCase {
    /// A valid case with the same isotropic noise on all points.
    pub(super) fn new(
        name: &'static str,
        reason: &'static str,
        cloud_a: Vec<Point3>,
        cloud_b: Vec<Point3>,
    ) -> Self {
        let covariance = |cloud: &[Point3]| vec![isotropic(0.002); cloud.len()];
        let (covariance_a, covariance_b) = (covariance(&cloud_a), covariance(&cloud_b));
        Self {
            name,
            reason,
            cloud_a,
            cloud_b,
            covariance_a,
            covariance_b,
            valid: true,
            collides: None,
        }
    }

    pub(super) fn collides(mut self, collides: bool) -> Self {
        self.collides = Some(collides);
        self
    }

    pub(super) fn invalid(mut self) -> Self {
        self.valid = false;
        self
    }

    /// The same covariance on every point of both clouds.
    pub(super) fn with_covariance(mut self, covariance: Matrix3) -> Self {
        self.covariance_a.fill(covariance);
        self.covariance_b.fill(covariance);
        self
    }

    /// Coordinates times `factor`, then moved by `offset`; covariances scale along.
    pub(super) fn placed(mut self, factor: f64, offset: Vector3) -> Self {
        for p in self.cloud_a.iter_mut().chain(&mut self.cloud_b) {
            *p = Point3::from(p.coords * factor + offset);
        }
        for c in self.covariance_a.iter_mut().chain(&mut self.covariance_b) {
            *c *= factor * factor;
        }
        self
    }
}

/// A cloud of `count` points of a square of 0.2 m at height `z`.
pub(super) fn patch(z: f64, count: usize, seed: u64) -> Vec<Point3> {
    let samples = sample_surface(&scene::plane_patch(0.2), count, seed);
    samples.iter().map(|s| s.position + Vector3::z() * z).collect()
}

/// Two parallel patches 5 cm apart, far beyond their noise of 2 mm: free beyond doubt.
pub(super) fn apart(name: &'static str, reason: &'static str) -> HardCase {
    HardCase::new(name, reason, patch(0.0, 100, 1), patch(0.05, 100, 2)).collides(false)
}

/// Two patches that cross at a small angle of slope 1/4: in collision beyond doubt.
pub(super) fn crossing(name: &'static str, reason: &'static str) -> HardCase {
    let tilted = patch(0.0, 400, 4).iter().map(|p| Point3::new(p.x, p.y, 0.25 * p.x)).collect();
    HardCase::new(name, reason, patch(0.0, 400, 3), tilted).collides(true)
}

pub(super) fn isotropic(std: f64) -> Matrix3 {
    Matrix3::identity() * (std * std)
}
