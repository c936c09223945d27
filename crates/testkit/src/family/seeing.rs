//! How a body is observed.

use cloudtouch_geom::PointCloud;

use super::{depth_view::DepthView, observation::Observation};
use crate::{
    exact::ExactMesh,
    noise::{NoiseKind, add_noise},
    surface::{area, positions, sample_surface},
};

/// How a body is observed.
pub(super) enum Seen {
    /// Samples of this part of the surface, with noise.
    Surface(Box<ExactMesh>),
    /// From one side, by a camera.
    Image(DepthView),
}

impl Seen {
    /// A cloud of the body; the seeds are of the places on its surface and of the errors.
    pub(super) fn observe(
        &self,
        body: &ExactMesh,
        points: usize,
        noise: NoiseKind,
        std: f64,
        seeds: [u64; 2],
    ) -> Observation {
        let seen = match self {
            Self::Surface(seen) => seen.mesh(),
            Self::Image(view) => return view.observe(body, points, noise, std, seeds),
        };
        let samples = sample_surface(seen, points, seeds[0]);
        let noisy = add_noise(&positions(&samples), noise, std, seeds[1]);
        Observation {
            cloud: PointCloud::from_points(noisy),
            truth: samples.into_iter().map(Some).collect(),
            std,
        }
    }

    /// About how far apart neighbours in a cloud of so many points are, m.
    pub(super) fn spacing(&self, points: usize) -> f64 {
        match self {
            Self::Surface(seen) => (area(seen.mesh()) / points as f64).sqrt(),
            Self::Image(view) => view.spacing(points),
        }
    }
}
