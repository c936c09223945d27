//! Several scans of one frame, each with its sensor and where that stood, in one map.

use crate::common::{Asked, MODES, Scan, ask, at, mesh};
use cloudtouch::geom::seed::{derive, unit};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Mode, PaperCloud, PaperCloudSettings, PrepareError, Report, Undecided,
    Verdict, Warning,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;
use std::f64::consts::PI;

/// A block of half a metre between two cameras that look at each other, walls behind both.
fn views() -> [PointCloud; 2] {
    let place = |mesh: TriangleMesh, z| ExactMesh::new(&scene::moved(&mesh, &at(0.0, 0.0, z)));
    let block = place(scene::cuboid([0.5; 3]), 1.5);
    let walls = [place(scene::plane_patch(6.0), -0.5), place(scene::plane_patch(6.0), 3.5)];
    let from =
        [Pose::identity(), Pose::from_translation_rpy(Vector3::new(0.0, 0.0, 3.0), [0.0, PI, 0.0])];
    from.map(|pose| {
        DepthCamera::default().scan(&[&block, &walls[0], &walls[1]], &pose, 1).transformed(&pose)
    })
}

fn scans(clouds: &[PointCloud]) -> [Scan; 2] {
    let by = CloudSettings::new(SensorModel::Kinect);
    let scans: Vec<_> = clouds.iter().map(|cloud| (cloud, &by)).collect();
    let by_paper = PaperCloudSettings::amended(SensorModel::Kinect);
    let of_paper: Vec<_> = clouds.iter().map(|cloud| (cloud, &by_paper)).collect();
    [
        Scan::Calibrated(Cloud::merge(&scans).expect("good scans")),
        Scan::Paper(PaperCloud::merge(&of_paper).expect("good scans")),
    ]
}

/// Discs and edges ended at the clumps that scans of the same rays leave, and a cube deep in the floor between
/// them read free.
#[test]
fn many_scans_of_the_same_rays_are_told() {
    let scan = |seed: u64| {
        let place = |i: u64| {
            let off = |k| 2e-4 * (unit(derive(seed, i, k)) - 0.5);
            let [x, y] = [i % 60, i / 60].map(|k| 0.01 * k as f64 - 0.3);
            Point3::new(x + off(0), y + off(1), off(2))
        };
        PointCloud::from_points((0..3600).map(place).collect())
    };
    let by = CloudSettings::new(SensorModel::Isotropic { std: 1e-4 });
    let cube = mesh(&scene::cuboid([0.2; 3]));
    for (count, told) in [(1, false), (7, true), (20, true)] {
        let scans: Vec<PointCloud> = (0..count).map(scan).collect();
        let scans: Vec<_> = scans.iter().map(|scan| (scan, &by)).collect();
        let floor = Scan::Calibrated(Cloud::merge(&scans).expect("good scans"));
        let above = ask(Mode::Calibrated, &floor, &cube, &at(0.0, 0.0, 0.3));
        let is_told = above.warnings.iter().any(|w| matches!(w, Warning::Clumps { .. }));
        assert_eq!(is_told, told, "{count}: {above:?}");
        assert_eq!(above.verdict == Verdict::Undecided, told, "{count}: {above:?}");
        let open = TriangleMesh::new(
            scene::cuboid([0.2; 3]).vertices().to_vec(),
            scene::cuboid([0.2; 3]).triangles()[1..].to_vec(),
        );
        let open = mesh(&open.expect("a mesh"));
        let through = ask(Mode::Calibrated, &floor, &open, &at(0.0, 0.0, 0.04));
        assert_ne!(through.verdict, Verdict::Free, "{count}: {through:?}");
    }
}

/// One cloud had one origin: what one camera could not see was unseen, whatever another saw there.
#[test]
fn what_is_hidden_from_one_sensor_is_free_where_another_looked() {
    let views = views();
    let ball = mesh(&scene::sphere(0.08, 2));
    // Behind the block for the first camera, before it for the second.
    let behind = at(0.0, 0.0, 2.3);
    let within = at(0.0, 0.0, 1.5);
    for ((one, both), mode) in scans(&views[..1]).iter().zip(&scans(&views)).zip(MODES) {
        let verdict =
            |scan: &Scan, pose: &Pose| -> Report { ask(mode, scan, Asked::from(&ball), pose) };
        assert_eq!(verdict(one, &behind).verdict, Verdict::Undecided);
        let seen = verdict(both, &behind);
        assert!(
            seen.collision_probability < 0.1
                && seen.undecided_by.is_none_or(|by| { by != Undecided::Unseen }),
            "{seen:?}"
        );
        // Inside the block neither looked.
        assert_eq!(verdict(both, &within).verdict, Verdict::Undecided);
        assert_eq!(both.len(), one.len() + scans(&views[1..])[0].len());
    }
}

/// What fits between the pixels of an image counted as seen by it where the cloud is finer than that by the pixels
/// of another: alone either is undecided.
#[test]
fn what_fits_between_the_pixels_of_a_coarse_image_is_not_seen_by_it_in_a_finer_cloud() {
    let block =
        ExactMesh::new(&scene::moved(&scene::cuboid([0.15, 0.15, 0.4]), &at(0.0, 0.0, 1.5)));
    let wall = ExactMesh::new(&scene::moved(&scene::plane_patch(8.0), &at(0.0, 0.0, 3.0)));
    let fine = DepthCamera { veil_probability: 0.0, ..DepthCamera::default() };
    let coarse = DepthCamera { width: 8, height: 6, focal_px: 7.0, ..fine };
    let from = [at(0.1, 0.05, 0.0), Pose::identity()];
    let views: Vec<PointCloud> = [fine, coarse]
        .iter()
        .zip(&from)
        .map(|(camera, pose)| camera.scan(&[&block, &wall], pose, 1).transformed(pose))
        .collect();
    let cube = mesh(&scene::cuboid([0.03; 3]));
    for (scan, mode) in scans(&views).iter().zip(MODES) {
        // In the block, which is between four pixels of the coarse one.
        for depth in [1.4, 1.5, 1.6] {
            let report = ask(mode, scan, &cube, &at(0.0, 0.0, depth));
            assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{depth}: {report:?}");
        }
        // Where the fine one looked all is as it was.
        let before = ask(mode, scan, &cube, &at(0.0, 0.0, 1.0));
        assert_eq!(before.verdict, Verdict::Free, "{before:?}");
    }
}

/// What is behind the returns of a camera by no more than its noise counted as seen, however deep it is in what another
/// one, near by, measured well: deep in a block 2 % read free, and none by either alone.
#[test]
fn what_one_camera_knows_to_be_hidden_is_not_seen_by_the_noise_of_another() {
    let block = ExactMesh::new(&scene::moved(&scene::cuboid([0.6; 3]), &at(0.0, 0.0, 0.8)));
    let wall = ExactMesh::new(&scene::moved(&scene::plane_patch(9.0), &at(0.0, 0.0, 2.8)));
    let sensor = SensorModel::Stereo { baseline: 0.05, focal_px: 140.0, disparity_std: 0.1 };
    let growth = 0.1 / (0.05 * 140.0);
    let camera = DepthCamera { depth_std: 0.0, depth_std_growth: growth, ..DepthCamera::default() };
    let scan = |pose: Pose, seed| camera.scan(&[&block, &wall], &pose, seed).transformed(&pose);
    let [near, far] = [scan(Pose::identity(), 1), scan(at(0.3, 0.1, -3.5), 2)];
    let by = CloudSettings::new(sensor);
    let both = Scan::Calibrated(Cloud::merge(&[(&near, &by), (&far, &by)]).expect("good scans"));
    let cube = mesh(&scene::cuboid([0.05; 3]));
    let steps = || (-4..=4).map(|k| 0.05 * f64::from(k));
    let places = steps().flat_map(|x| steps().map(move |y| [x, y]));
    for ([x, y], depth) in places.flat_map(|place| [0.1, 0.15, 0.2].map(|depth| (place, depth))) {
        let report = ask(Mode::Calibrated, &both, &cube, &at(x, y, 0.5 + depth));
        assert_ne!(report.verdict, Verdict::Free, "{x} {y} {depth}: {report:?}");
    }
}

/// Each scan keeps the noise of its own sensor, and the rows are counted on.
#[test]
fn each_scan_has_the_noise_of_its_own_sensor() {
    let points = |z: f64| -> Vec<Point3> {
        (0..400)
            .map(|i| Point3::new(0.01 * f64::from(i % 20), 0.01 * f64::from(i / 20), z))
            .collect()
    };
    let [low, high] = [0.0, 0.5].map(|z| PointCloud::from_points(points(z)));
    let [sharp, blurred] =
        [0.001, 0.05].map(|std| CloudSettings::new(SensorModel::Isotropic { std }));
    let plate = Cloud::prepare(&low, &sharp).expect("a good cloud");
    let probability = |low_by: &CloudSettings, high_by: &CloudSettings, z| {
        let map = Cloud::merge(&[(&low, low_by), (&high, high_by)]).expect("good scans");
        assert_eq!(map.rows(), (0..800).collect::<Vec<_>>());
        let query = cloudtouch::Query::new(cloudtouch::QuerySettings::default()).expect("good");
        query.run(&map, &plate, &at(0.0, 0.0, z)).expect("a finite pose").collision_probability
    };
    for (z, is_low) in [(0.02, true), (0.52, false)] {
        let near_blurred = if is_low {
            probability(&blurred, &sharp, z)
        } else {
            probability(&sharp, &blurred, z)
        };
        let near_sharp = if is_low {
            probability(&sharp, &blurred, z)
        } else {
            probability(&blurred, &sharp, z)
        };
        assert!(near_blurred > near_sharp + 0.01, "{near_blurred} and {near_sharp} at {z}");
    }
}

#[test]
fn no_scan_is_no_map() {
    assert!(matches!(Cloud::merge(&[]), Err(PrepareError::NothingLeft { before: 0, .. })));
    assert!(matches!(PaperCloud::merge(&[]), Err(PrepareError::NothingLeft { before: 0, .. })));
}

/// Of several scans none was named, and rows were counted on from those before, which no file has.
#[test]
fn the_scan_that_is_at_fault_is_named() {
    let grid = |z: f64| {
        let at = |i: i32| Point3::new(0.01 * f64::from(i % 20), 0.01 * f64::from(i / 20), z);
        PointCloud::from_points((0..400).map(at).collect())
    };
    let [good, mut far] = [0.0, 0.5].map(grid);
    far.points[7].x = 1e12;
    let empty = PointCloud::from_points(vec![Point3::new(f64::NAN, 0.0, 0.0); 5]);
    let by = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let error = |scans: &[&PointCloud]| {
        let scans: Vec<_> = scans.iter().map(|&scan| (scan, &by)).collect();
        Cloud::merge(&scans).expect_err("one of them is at fault").to_string()
    };
    let told = error(&[&good, &empty]);
    assert!(told.starts_with("scan 2 of 2: no point is left of 5"), "{told}");
    assert!(error(&[&empty]).starts_with("no point is left of 5"));
    let told = error(&[&good, &far, &empty]);
    assert!(told.starts_with("scan 2 of 3: point 7 has the coordinate"), "{told}");
}

/// A scan given twice, by its name or as a copy, counted as two that agree: contact read .67 where it was .98.
#[test]
fn a_scan_that_is_given_twice_is_refused() {
    let [one, other] = views();
    let by = CloudSettings::new(SensorModel::Kinect);
    let twice = Cloud::merge(&[(&one, &by), (&other, &by), (&one.clone(), &by)]);
    assert_eq!(twice.expect_err("the first again"), PrepareError::RepeatedScan { scan: 2 });
    // What holds all of another is not that.
    let half = PointCloud::from_points(one.points.iter().copied().step_by(2).collect());
    let by = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    assert!(Cloud::merge(&[(&one, &by), (&half, &by)]).is_ok());
}
