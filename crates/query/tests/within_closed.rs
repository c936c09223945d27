//! A small body within a closed cloud, a few spacings from its surface: there samples are too few to lie in all
//! directions. And beside clouds that are open, as near.

use crate::common::{at, measured};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mesh, Query, QuerySettings, Report, Undecided, Verdict};
use cloudtouch_testkit::scene;

const STD: f64 = 0.001;

/// In [0, 1).
fn draw(stream: u64, index: u64, axis: usize) -> f64 {
    seed::unit(seed::derive(stream, index, axis as u64))
}

fn turn(stream: u64, index: u64) -> Pose {
    let angles = [3, 4, 5].map(|k| 6.3 * draw(stream, index, k));
    Pose::from_translation_rpy(Vector3::zeros(), angles)
}

/// A surface that was measured from everywhere, from who knows where, or from a known place.
fn cloud(shape: &TriangleMesh, spacing: f64, sensor: Option<Vector3>, seed: u64) -> Cloud {
    let sensor_pose = sensor.map(Pose::from_translation);
    let points: Vec<Point3> = measured(shape, spacing, STD, seed);
    let points = PointCloud { sensor_pose, ..PointCloud::from_points(points) };
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    Cloud::prepare(&points, &settings).expect("a good cloud")
}

fn cube(edge: f64) -> Mesh {
    Mesh::prepare(&scene::cuboid([edge; 3])).expect("a good mesh")
}

/// What is said of a body at so many places of a box about the origin, turned anyhow.
fn ask_within(outer: &Cloud, inner: &Mesh, half: Vector3, count: u64, stream: u64) -> Vec<Report> {
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let place =
        |index| Vector3::from_fn(|axis, _| half[axis] * (2.0 * draw(stream, index, axis) - 1.0));
    let pose = |index| Pose::from_translation(place(index)).after(&turn(stream, index));
    (0..count).map(|index| query.run(outer, inner, &pose(index)).expect("a good pose")).collect()
}

/// How many are free, and how many undecided for what is around.
fn free_and_enclosed(reports: &[Report]) -> [usize; 2] {
    let free = reports.iter().filter(|report| report.verdict == Verdict::Free);
    let is_enclosed = |report: &&Report| report.undecided_by == Some(Undecided::Enclosed);
    [free.count(), reports.iter().filter(is_enclosed).count()]
}

/// Without noise no place about a point was asked whether it is inside, and no point was looked at: free.
#[test]
fn an_exact_cloud_within_a_mesh_read_free() {
    let ball = PointCloud::from_points(measured(&scene::sphere(0.025, 4), 0.003, 0.0, 1));
    let query = Query::new(QuerySettings::default()).unwrap();
    for sensor in [SensorModel::Exact, SensorModel::Isotropic { std: 0.0 }] {
        let fresh = Cloud::prepare(&ball, &CloudSettings::new(sensor)).unwrap();
        for pose in [at(0.0, 0.0, 0.0), at(0.3, -0.2, 0.45)] {
            let report = query.run(&fresh, &cube(1.0), &pose.inverse()).unwrap();
            assert_eq!(report.verdict, Verdict::InCollision, "{pose:?} {report:?}");
        }
        let report = query.run(&fresh, &cube(1.0), &at(0.6, 0.0, 0.0)).unwrap();
        assert_eq!(report.verdict, Verdict::Free, "{report:?}");
    }
}

/// Of a large top 57 of 100 places read free, of a small one 72.
#[test]
fn a_body_within_a_table_top_read_free() {
    let inner = cube(0.03);
    for (sides, seed) in [([0.6, 0.5, 0.08], 0), ([1.2, 0.8, 0.08], 1), ([0.6, 0.5, 0.08], 2)] {
        let top = cloud(&scene::cuboid(sides), 0.016, None, seed);
        let half = 0.5 * Vector3::from(sides) - Vector3::repeat(0.027);
        let reports = ask_within(&top, &inner, half, 100, seed);
        assert_eq!(free_and_enclosed(&reports), [0, 100], "{sides:?}");
    }
}

#[test]
fn a_body_within_a_slab_read_free() {
    for (k, thick) in [0.04, 0.06, 0.08, 0.1].into_iter().enumerate() {
        // As large as fits in, turned anyhow, three deviations from the faces.
        let inner = cube(0.4 * thick);
        let away = 0.5 * 3.0_f64.sqrt() * 0.4 * thick + 3.0 * STD;
        for spacing in [0.005, 0.01, 0.02] {
            let sides = Vector3::new(0.5, 0.3, thick);
            let slab = cloud(&scene::cuboid(sides.into()), spacing, None, k as u64);
            let half = 0.5 * sides - Vector3::repeat(away);
            let [free, _] = free_and_enclosed(&ask_within(&slab, &inner, half, 50, k as u64));
            assert_eq!(free, 0, "{thick} m, samples {spacing} m apart");
        }
    }
}

#[test]
fn a_body_within_a_ball_or_a_pipe_near_its_surface_read_free() {
    let inner = cube(0.03);
    for spacing in [0.008, 0.016, 0.024] {
        let ball = cloud(&scene::sphere(0.12, 3), spacing, None, 3);
        let within = ask_within(&ball, &inner, Vector3::repeat(0.05), 60, 3);
        assert_eq!(free_and_enclosed(&within)[0], 0, "ball, {spacing}");
        let pipe = cloud(&scene::cylinder(0.06, 0.5, 32), spacing, None, 4);
        let within = ask_within(&pipe, &inner, Vector3::new(0.02, 0.02, 0.2), 60, 4);
        assert_eq!(free_and_enclosed(&within)[0], 0, "pipe, {spacing}");
    }
}

/// In contact too: half of all directions are open.
#[test]
fn nothing_on_a_floor_or_in_a_corner_is_enclosed() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let sheet = |place: [f64; 3], rpy| {
        scene::moved(&scene::plane_patch(0.8), &Pose::from_translation_rpy(place.into(), rpy))
    };
    // The corner is at the origin.
    let floor = sheet([0.35, 0.35, 0.0], [0.0; 3]);
    let walls = [
        sheet([0.0, 0.35, 0.35], [0.0, quarter, 0.0]),
        sheet([0.35, 0.0, 0.35], [quarter, 0.0, 0.0]),
    ];
    for standing in 0..=walls.len() {
        let walls = walls[..standing].iter().cloned();
        let shape = scene::assemble(std::iter::once(floor.clone()).chain(walls));
        for spacing in [0.008, 0.016, 0.03] {
            let corner = cloud(&shape, spacing, None, 5);
            let reports = ask_within(&corner, &cube(0.03), Vector3::repeat(0.08), 100, 5);
            let [free, enclosed] = free_and_enclosed(&reports);
            assert_eq!(enclosed, 0, "{standing} walls, {spacing}");
            assert!((15..100).contains(&free), "{standing} walls, {spacing}: {free}");
        }
    }
}

/// The middle of each is within the other.
#[test]
fn a_ring_through_a_ring_is_free() {
    let ring = scene::torus(0.3, 0.06, 48);
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let across = Pose::from_translation_rpy(
        Vector3::new(0.3, 0.0, 0.0),
        [std::f64::consts::FRAC_PI_2, 0.0, 0.0],
    );
    for seed in 0..5 {
        let outer = cloud(&ring, 0.03, None, seed);
        let mesh = Mesh::prepare(&ring).expect("a good mesh");
        let reports = [
            query.run(&outer, &cloud(&ring, 0.03, None, 10 + seed), &across),
            query.run(&outer, &mesh, &across),
        ];
        for report in reports {
            let report = report.expect("a good pose");
            assert_eq!(report.verdict, Verdict::Free, "{report:?}");
        }
    }
}

/// Along a wall a sensor looks past its samples however near they are.
#[test]
fn a_body_near_a_wall_was_seen_by_a_sensor_within_the_room() {
    let room = scene::cuboid([1.0, 0.8, 0.6]);
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let inner = cube(0.03);
    let near = |axis: usize| {
        let mut place = Vector3::new(0.1, -0.05, 0.08);
        place[axis] = 0.5 * [1.0, 0.8, 0.6][axis] - 0.03;
        at(place.x, place.y, place.z)
    };
    let known = cloud(&room, 0.016, Some(Vector3::new(0.2, 0.1, -0.1)), 6);
    let unknown = cloud(&room, 0.016, None, 6);
    for axis in 0..3 {
        let report = query.run(&known, &inner, &near(axis)).expect("a good pose");
        assert_eq!(report.verdict, Verdict::Free, "{axis}: {report:?}");
        let report = query.run(&unknown, &inner, &near(axis)).expect("a good pose");
        assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{axis}: {report:?}");
    }
}
