//! The piano and the room: meshes, noisy clouds, and poses far from contact, near and deep.

use anyhow::{Context, Result};
use cloudtouch::Cloud;
use cloudtouch_geom::TriangleMesh;
use cloudtouch_geom::seed::derive;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::family::Observation;
use cloudtouch_testkit::poses::LabelledPose;
use cloudtouch_testkit::poses_by_class::poses_by_class;
use cloudtouch_testkit::scene;

use crate::SEED;
use crate::methods::{prepared, sampled};

/// Points of a cloud where nothing else is said.
pub(super) const POINTS: usize = 10_000;
/// Standard deviation of the noise where nothing else is said, m.
pub(super) const STD: f64 = 0.002;
/// The edges that leave so many triangles, m: the room at 10,000 and the piano.
const EDGES: [f64; 2] = [0.42, 0.13];
/// What is measured on.
pub(super) struct Scene {
    room: TriangleMesh,
    pub(super) piano: TriangleMesh,
    /// Far, near and deep ones in turn.
    pub(super) poses: Vec<LabelledPose>,
}

impl Scene {
    /// Draws so many poses; fails when a class of them cannot be had.
    pub(super) fn draw(count: usize) -> Result<Self> {
        let (room, piano) = (scene::room(), scene::piano());
        let exact = [&room, &piano].map(ExactMesh::new);
        let poses = poses_by_class(&exact[0], &exact[1], count, SEED);
        let poses = poses.context("too few far, near or deep poses")?;
        Ok(Self { room, piano, poses })
    }

    /// The room in so many points, with noise of this standard deviation (m).
    pub(super) fn room(&self, points: usize, std: f64) -> Observation {
        sampled(&self.room, points, std, seeds(derive(SEED, 2, 0)))
    }

    /// The piano in [`POINTS`] points.
    pub(super) fn piano(&self, std: f64) -> Observation {
        sampled(&self.piano, POINTS, std, seeds(derive(SEED, 2, 1)))
    }

    /// Room and piano in [`POINTS`] points each, refined.
    pub(super) fn refined(&self) -> Result<[Cloud; 2]> {
        let [room, piano] = [self.room(POINTS, STD), self.piano(STD)];
        Ok([prepared(&room)?.refined()?, prepared(&piano)?.refined()?])
    }

    /// The room's surface in about so many triangles, and the piano's in ten thousand.
    pub(super) fn meshes(&self, triangles: usize) -> [TriangleMesh; 2] {
        let edge = EDGES[0] * (POINTS as f64 / triangles as f64).sqrt();
        [(&self.room, edge), (&self.piano, EDGES[1])]
            .map(|(mesh, edge)| scene::subdivide_to_max_edge(mesh, edge))
    }
}

/// Those of places and of errors.
pub(super) fn seeds(stream: u64) -> [u64; 2] {
    [stream, derive(stream, 1, 0)]
}
