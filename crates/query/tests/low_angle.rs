//! Surfaces that a camera sees at a low angle.

use crate::common::{mesh, query};
use cloudtouch::geom::{PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, Verdict};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

/// A stereo camera of QVGA.
const FOCAL: f64 = 285.0;
const BASELINE: f64 = 0.055;
const DISPARITY_STD: f64 = 0.06;
const STEREO: SensorModel =
    SensorModel::Stereo { baseline: BASELINE, focal_px: FOCAL, disparity_std: DISPARITY_STD };

/// The camera so far above the board of a shelf, m, before the wall behind it; in the frame of the camera.
fn along_a_board(height: f64, seed: u64) -> PointCloud {
    let part = |size, y, z| {
        let at = Pose::from_translation(Vector3::new(0.0, y, z));
        ExactMesh::new(&scene::moved(&scene::cuboid(size), &at))
    };
    let board = part([1.6, 0.02, 0.6], height + 0.01, 0.85);
    let wall = part([3.0, 3.0, 0.02], 0.0, 1.16);
    let camera = DepthCamera {
        width: 320,
        height: 240,
        focal_px: FOCAL,
        depth_std: 0.0,
        depth_std_growth: DISPARITY_STD / (FOCAL * BASELINE),
        veil_probability: 0.3,
        ..DepthCamera::default()
    };
    camera.scan(&[&board, &wall], &Pose::identity(), seed)
}

/// Of a board at 4 to 9 degrees from half to two thirds of the returns were taken for veil, and whatever was pushed
/// through it was free.
#[test]
fn a_board_at_a_low_angle_was_taken_for_veil() {
    let finger = mesh(&scene::cuboid([0.02, 0.12, 0.02]));
    for (height, seed) in [(0.05, 1), (0.08, 2), (0.12, 3)] {
        let frame = along_a_board(height, seed);
        let cloud = Cloud::prepare(&frame, &CloudSettings::new(STEREO)).unwrap();
        let veil = cloud.filter_stages().iter().find(|stage| stage.stage == "veil").unwrap();
        assert!((veil.removed as f64) < 0.002 * veil.before as f64, "{height} m: {veil:?}");
        for along in 0..9 {
            let place = Vector3::new(-0.2 + 0.05 * f64::from(along), height - 0.06, 0.85);
            // The tip 1 cm under the board's top, then 3 cm above it.
            for (down, expected) in [(0.01, Verdict::InCollision), (-0.03, Verdict::Free)] {
                let pose = Pose::from_translation(place + Vector3::y() * down);
                let report = query(Mode::Calibrated).run(&cloud, &finger, &pose).unwrap();
                let p = report.collision_probability;
                let is_right = match expected {
                    Verdict::Free => report.verdict != Verdict::InCollision,
                    _ => report.verdict != Verdict::Free && p > 0.5,
                };
                assert!(is_right, "{height} m, {place:?}, {down}: {p} {:?}", report.verdict);
            }
        }
    }
}
