//! What the bodies look like to a sensor.

use cloudtouch_geom::{PointCloud, TriangleMesh, seed};

use super::{FamilyScene, depth_view::DepthView};
use crate::{
    exact::ExactMesh,
    noise::{NoiseKind, add_noise},
    surface::{SurfaceSample, area, positions, sample_surface},
};

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The body that stays.
    A,
    /// The body that moves.
    B,
}

/// A noisy cloud and what it was drawn from.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The cloud in its body's frame.
    ///
    /// A depth image is organised, with NaN rows, and brings the covariances that its noise has
    /// (the error is along the ray, with a share of the depth that is known); the body's frame is
    /// then the camera's optical one. Other clouds have isotropic noise and no covariances.
    pub cloud: PointCloud,
    /// For each row of the cloud the point without noise, with its true normal; its triangle counts
    /// within what is seen, not within the body's mesh.
    ///
    /// `None` for a row without a return, and for a point of a veil, which is on no surface.
    pub truth: Vec<Option<SurfaceSample>>,
    /// The standard deviation along each axis, of a depth image that of the depth at 1 m; zero when
    /// the body is known exactly, whatever was asked for; m.
    pub std: f64,
}

/// How a body is observed.
pub(super) enum Seen {
    /// Samples of this part of the surface, with noise.
    Surface(Box<ExactMesh>),
    /// Samples of this surface; the body is known, so there is no noise.
    Known(TriangleMesh),
    /// From one side, by a camera.
    Image(DepthView),
}

impl FamilyScene {
    /// A fresh cloud of one body: new places on its surface and new errors for each seed, the two
    /// drawn independently, so that clouds of one seed and different noise show the same places.
    ///
    /// To average over what a sensor could have seen at a pose, observe with many seeds. `std` is
    /// the standard deviation along each axis, m. Of a depth image it is that of the depth at 1 m,
    /// growing with the square of the depth, `points` is about the number of returns, and there are
    /// points of veils at depth edges even without noise.
    pub fn observe(
        &self,
        side: Side,
        points: usize,
        noise: NoiseKind,
        std: f64,
        seed: u64,
    ) -> Observation {
        let stream = |use_of_it| seed::derive(seed, side as u64, use_of_it);
        let (samples, std) = match &self.seen[side as usize] {
            Seen::Surface(seen) => (sample_surface(seen.mesh(), points, stream(0)), std),
            Seen::Known(mesh) => (sample_surface(mesh, points, stream(0)), 0.0),
            Seen::Image(view) => {
                return view.observe(&self.a, points, noise, std, [stream(0), stream(1)]);
            }
        };
        let noisy = add_noise(&positions(&samples), noise, std, stream(1));
        Observation {
            cloud: PointCloud::from_points(noisy),
            truth: samples.into_iter().map(Some).collect(),
            std,
        }
    }

    /// About how far apart neighbouring points of such a cloud are, m: the root of the area each
    /// has to itself; of a depth image the distance of neighbouring rays in the middle of the scene.
    pub fn spacing(&self, side: Side, points: usize) -> f64 {
        match &self.seen[side as usize] {
            Seen::Surface(seen) => (area(seen.mesh()) / points as f64).sqrt(),
            Seen::Known(mesh) => (area(mesh) / points as f64).sqrt(),
            Seen::Image(view) => view.spacing(points),
        }
    }
}
