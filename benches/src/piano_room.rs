//! The piano in the room of the test kit, as noisy clouds, in poses of three classes.

use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, PaperCloud, PaperCloudSettings};
use cloudtouch_geom::{PointCloud, Pose, TriangleMesh};
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::poses::{LabelledPose, label};
use cloudtouch_testkit::{scene, surface};
use nalgebra::Matrix4;

/// Standard deviation of both clouds per axis, m.
pub const NOISE: f64 = 0.002;

/// The room, with `count` points.
pub fn room(count: usize) -> PointCloud {
    cloud(&scene::room(), count, 1)
}

/// The piano, with `count` points.
pub fn piano(count: usize) -> PointCloud {
    cloud(&scene::piano(), count, 2)
}

fn cloud(mesh: &TriangleMesh, count: usize, seed: u64) -> PointCloud {
    let samples = surface::sample_surface(mesh, count, seed);
    let points = surface::positions(&samples);
    PointCloud::from_points(add_noise(&points, NoiseKind::Gaussian, NOISE, seed))
}

/// The sensor that measured either cloud.
pub const SENSOR: SensorModel = SensorModel::Isotropic { std: NOISE };

/// A cloud of [`NOISE`] prepared for the default path.
///
/// # Panics
/// When it is no usable cloud.
pub fn prepared(cloud: &PointCloud) -> Cloud {
    Cloud::prepare(cloud, &CloudSettings::new(SENSOR)).expect("a usable cloud")
}

/// A cloud of [`NOISE`] prepared by the paper.
///
/// # Panics
/// When it is no usable cloud.
pub fn prepared_by_the_paper(cloud: &PointCloud) -> PaperCloud {
    PaperCloud::prepare(cloud, &PaperCloudSettings::new(SENSOR)).expect("a usable cloud")
}

/// A pose of the piano in the room, with what is true of the meshes there.
pub struct Class {
    /// `far`, `near` or `deep`.
    pub name: &'static str,
    /// The pose and its exact label.
    pub pose: LabelledPose,
}

/// One pose of each class: 26 cm apart, 1 cm apart, 12 cm of overlap.
///
/// # Panics
/// When a pose is not what its name says.
pub fn classes() -> [Class; 3] {
    let (room, piano) = (ExactMesh::new(&scene::room()), ExactMesh::new(&scene::piano()));
    [("far", FAR, 0.2..0.3), ("near", NEAR, 0.0..0.02), ("deep", DEEP, -0.2..-0.1)].map(
        |(name, rows, distances)| {
            let matrix = Matrix4::from_row_slice(&rows.concat());
            let scene_from_object = Pose::try_from_matrix(&matrix).expect("a rigid motion");
            let pose = label(&room, &piano, &scene_from_object);
            let distance = pose.signed_distance;
            assert!(distances.contains(&distance), "the pose `{name}` is at {distance} m");
            Class { name, pose }
        },
    )
}

/// Rows of a homogeneous matrix.
type Rows = [[f64; 4]; 4];

const FAR: Rows = [
    [0.062774484, 0.979946754, -0.189112991, 1.340623645],
    [0.787672847, 0.067717593, 0.612360853, -1.240487091],
    [0.612887306, -0.187399805, -0.767626513, 3.006828781],
    [0.0, 0.0, 0.0, 1.0],
];
const NEAR: Rows = [
    [0.750101617, 0.384731562, -0.537893288, 0.116330706],
    [0.307909571, 0.5166442, 0.79891831, -0.378961132],
    [0.585268537, -0.764892408, 0.26907312, 0.887572578],
    [0.0, 0.0, 0.0, 1.0],
];
const DEEP: Rows = [
    [0.586207884, 0.500133509, -0.637359232, 0.185970009],
    [0.595491788, 0.267421805, 0.75754545, -1.560941957],
    [0.54931762, -0.823621303, -0.141060627, 2.057789404],
    [0.0, 0.0, 0.0, 1.0],
];
