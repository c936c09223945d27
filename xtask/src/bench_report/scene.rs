//! The piano and the room: meshes, noisy clouds, poses.

use anyhow::Result;
use cloudtouch::{Cloud, CloudSettings, Mode, noise::SensorModel};
use cloudtouch_geom::{PointCloud, TriangleMesh, seed};
use cloudtouch_testkit::{
    exact::ExactMesh,
    noise::{NoiseKind, add_noise},
    scene,
    surface::{positions, sample_surface},
};

use super::poses::{Posed, draw};

/// Points of a cloud where nothing else is said.
pub(super) const POINTS: usize = 10_000;
/// Standard deviation of the noise where nothing else is said, m.
pub(super) const STD: f64 = 0.002;

/// The edges that leave so many triangles, m: the room at 10,000 and the piano.
const ROOM_EDGE: f64 = 0.42;
const PIANO_EDGE: f64 = 0.13;

/// What is measured on.
pub(super) struct Scene {
    room: TriangleMesh,
    piano: TriangleMesh,
    /// The classes in turn.
    pub(super) poses: Vec<Posed>,
    seed: u64,
}

impl Scene {
    /// Draws the poses.
    ///
    /// # Errors
    /// When a class of poses cannot be had.
    pub(super) fn draw(poses: usize, seed: u64) -> Result<Self> {
        let (room, piano) = (scene::room(), scene::piano());
        let poses = draw(&ExactMesh::new(&room), &ExactMesh::new(&piano), poses, seed)?;
        Ok(Self { room, piano, poses, seed })
    }

    /// The room, with noise of this standard deviation (m).
    pub(super) fn room(&self, points: usize, std: f64) -> PointCloud {
        noisy(&self.room, points, std, seed::derive(self.seed, 2, 0))
    }

    /// The piano, with noise of this standard deviation (m).
    pub(super) fn piano(&self, std: f64) -> PointCloud {
        noisy(&self.piano, POINTS, std, seed::derive(self.seed, 2, 1))
    }

    /// The room's surface in about so many triangles.
    pub(super) fn room_mesh(&self, triangles: usize) -> TriangleMesh {
        let edge = ROOM_EDGE * (POINTS as f64 / triangles as f64).sqrt();
        scene::subdivide_to_max_edge(&self.room, edge)
    }

    /// The piano's surface in about ten thousand triangles.
    pub(super) fn piano_mesh(&self) -> TriangleMesh {
        scene::subdivide_to_max_edge(&self.piano, PIANO_EDGE)
    }
}

fn noisy(mesh: &TriangleMesh, points: usize, std: f64, stream: u64) -> PointCloud {
    let exact = positions(&sample_surface(mesh, points, stream));
    let errors = seed::derive(stream, 1, 0);
    PointCloud::from_points(add_noise(&exact, NoiseKind::Gaussian, std, errors))
}

/// The cloud as a query wants it.
pub(super) fn prepare(cloud: &PointCloud, std: f64) -> Result<Cloud> {
    let sensor = SensorModel::Isotropic { std };
    Ok(Cloud::prepare(cloud, &CloudSettings::new(sensor, Mode::Calibrated))?)
}
