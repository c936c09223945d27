//! A scanned shelf, a gripper, and a path that sags into the lower board.

use std::f64::consts::PI;

use anyhow::Result;
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mesh};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::scene::{assemble, cuboid, moved, union_of_boxes};
use cloudtouch_testkit::surface;

type Corners = [[f64; 3]; 2];

/// Two boards 22 cm apart and a back, open toward −y, m.
pub(crate) const SHELF: [Corners; 3] = [
    [[-0.3, -0.15, -0.01], [0.3, 0.15, 0.01]],
    [[-0.3, -0.15, 0.23], [0.3, 0.15, 0.25]],
    [[-0.3, 0.15, -0.01], [0.3, 0.17, 0.25]],
];
/// A palm with two fingers ahead of it, toward +y, m.
pub(crate) const GRIPPER: [Corners; 3] = [
    [[-0.06, -0.05, -0.03], [0.06, 0.0, 0.03]],
    [[-0.06, 0.0, -0.01], [-0.04, 0.08, 0.01]],
    [[0.04, 0.0, -0.01], [0.06, 0.08, 0.01]],
];
/// How many poses the path has.
pub(crate) const POSES: usize = 20;

const POINTS: usize = 12_000;
/// Of the noise along each axis, m.
const STD: f64 = 0.002;

/// The surfaces, as they are and as they are known.
pub(crate) struct Bodies {
    pub(crate) shelf: TriangleMesh,
    pub(crate) gripper: TriangleMesh,
    pub(crate) scan: Cloud,
    pub(crate) hand: Mesh,
}

impl Bodies {
    pub(crate) fn prepare(seed: u64) -> Result<Self> {
        let block = |[low, high]: &Corners| {
            let [low, high] = [low, high].map(|corner| Vector3::from(*corner));
            moved(&cuboid((high - low).into()), &Pose::from_translation(0.5 * (low + high)))
        };
        let shelf = assemble(SHELF.iter().map(block));
        let samples = surface::positions(&surface::sample_surface(&shelf, POINTS, seed));
        let points: Vec<Point3> = add_noise(&samples, NoiseKind::Gaussian, STD, seed);
        let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
        let scan = Cloud::prepare(&PointCloud::from_points(points), &settings)?;
        let gripper = union_of_boxes(&GRIPPER);
        let hand = Mesh::prepare(&gripper)?;
        Ok(Self { shelf, gripper, scan, hand })
    }
}

/// From free to free, through the board between.
pub(crate) fn sagging() -> Vec<Pose> {
    let height = |share: f64| 0.12 - 0.11 * (PI * share).sin();
    (0..POSES)
        .map(|k| k as f64 / (POSES - 1) as f64)
        .map(|share| Vector3::new(0.02, -0.35 + 0.35 * share, height(share)))
        .map(|place| Pose::from_translation_rpy(place, [0.0, 0.0, 0.1]))
        .collect()
}
