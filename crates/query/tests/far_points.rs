//! What is far from all else decides nothing about what is near.

use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};

const STD: f64 = 0.002;
/// What the library promises.
const TOLERANCE: f64 = 1e-3;
/// A pose of the piano about a centimetre from the room.
const NEAR: ([f64; 3], [f64; 3]) = ([0.116, -0.379, 0.888], [-1.231, -0.625, 0.389]);

fn cloud(mesh: &TriangleMesh, count: usize, far: &[Point3]) -> Cloud {
    let samples = surface::positions(&surface::sample_surface(mesh, count, 1));
    let mut points = add_noise(&samples, NoiseKind::Gaussian, STD, 1);
    points.extend(far);
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

/// A return from far away turned the cuts of the tree over the whole room, and with them what the lonely samples
/// stand for.
#[test]
fn a_far_return_moved_probabilities() {
    let returns: Vec<Point3> = (0..20)
        .map(|i| {
            let unit = |k| 2.0 * seed::unit(seed::derive(3, i, k)) - 1.0;
            Point3::from(
                Vector3::new(unit(0), unit(1), unit(2)).normalize() * (30.0 + 10.0 * unit(3)),
            )
        })
        .collect();
    let piano = cloud(&scene::piano(), 3000, &[]);
    let [plain, one, some] =
        [&[][..], &returns[..1], &returns[..]].map(|far| cloud(&scene::room(), 4000, far));
    let query = Query::new(QuerySettings::default()).expect("settings");
    let mut worst = 0.0_f64;
    for i in 0..60 {
        let unit = |k| 0.06 * (2.0 * seed::unit(seed::derive(4, i, k)) - 1.0);
        let moved = Vector3::from(NEAR.0) + Vector3::new(unit(0), unit(1), unit(2));
        let pose = Pose::from_translation_rpy(moved, NEAR.1);
        let ask = |room| query.run(room, &piano, &pose).expect("a good pose").collision_probability;
        let expected = ask(&plain);
        for room in [&one, &some] {
            worst = worst.max((ask(room) - expected).abs());
        }
    }
    assert!(worst <= TOLERANCE, "{worst}");
}
