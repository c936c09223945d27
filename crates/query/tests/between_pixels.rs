//! What lies between the pixels of an image: there a surface is where it goes on to, and not as far away as the farther of
//! two pixels.

use cloudtouch::{Cloud, CloudSettings, Mode, Verdict};
use cloudtouch_geom::{PointCloud, Pose, Vector3, seed};
use cloudtouch_noise::SensorModel;
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

use crate::common::{at, mesh, query};

/// A floor and a wall, from a camera so high over the floor, m, that looks down by an angle, rad.
fn image([width, height]: [usize; 2], above: f64, camera_pose: &Pose) -> PointCloud {
    let camera = DepthCamera {
        width,
        height,
        focal_px: width as f64 / 1.155,
        depth_std_growth: 0.0007,
        ..DepthCamera::default()
    };
    let floor = scene::moved(&scene::cuboid([12.0, 0.1, 12.0]), &at(0.0, above + 0.05, 6.5));
    let wall = scene::moved(&scene::cuboid([12.0, 6.0, 0.1]), &at(0.0, 0.0, 6.0));
    let [floor, wall] = [floor, wall].map(|part| ExactMesh::new(&part));
    camera.scan(&[&floor, &wall], camera_pose, 3)
}

/// Of bodies wholly or nearly in the floor, and over it, how many are free.
fn free_in_and_over(step: usize, size: [usize; 2], body: [f64; 3], deep: f64) -> [usize; 2] {
    let mut free = [0; 2];
    let body_mesh = mesh(&scene::cuboid(body));
    for (above, down) in [(0.3, 0.09), (0.6, 0.26), (1.2, 0.6)] {
        let camera_pose = Pose::from_translation_rpy(Vector3::zeros(), [-down, 0.0, 0.0]);
        let image = image(size, above, &camera_pose).every(1, step).expect("an image");
        let sensor = SensorModel::TimeOfFlight { std: 0.001, per_metre: 0.001 };
        let cloud = Cloud::prepare(&image, &CloudSettings::new(sensor)).expect("a usable image");
        for index in 0..20 {
            let unit = |k: u64| seed::unit(seed::derive(7, index, k));
            let z = 1.0 + 3.0 * unit(0);
            let x = 0.6 * z * (unit(1) - 0.5);
            for (free, y) in free.iter_mut().zip([deep, -0.5 * body[1] - 0.02 - 0.1 * unit(2)]) {
                let pose = camera_pose.inverse().after(&at(x, above + y, z));
                let report =
                    query(Mode::Calibrated).run(&cloud, &body_mesh, &pose).expect("an answer");
                *free += usize::from(report.verdict == Verdict::Free);
            }
        }
    }
    free
}

/// Of 234 rods 54 were free, and 10 of other bodies with rows left out.
#[test]
fn what_lies_in_a_floor_between_two_rows_was_free() {
    let rod = [0.3, 0.01, 0.01];
    for (step, size, body, deep) in [
        (1, [128, 96], rod, 0.02),
        (1, [160, 120], rod, 0.02),
        (3, [320, 240], rod, 0.02),
        (3, [320, 240], [0.015; 3], 0.005),
        (2, [320, 240], [0.06; 3], 0.02),
    ] {
        let [sunk, over] = free_in_and_over(step, size, body, deep);
        assert_eq!(sunk, 0, "{step} {size:?} {body:?}");
        assert!(over >= 48, "{step} {size:?} {body:?}: {over} of 60");
    }
}

/// Columns a third as far apart as rows were columns that no camera has, and all was undecided.
#[test]
fn every_third_row_of_an_image_is_an_image() {
    let [sunk, over] = free_in_and_over(3, [480, 360], [0.06; 3], 0.02);
    assert_eq!([sunk, over], [0, 60]);
}
