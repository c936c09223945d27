//! A closed cloud or mesh within a closed cloud: in a hollow space or within a solid, no surface tells which.

use crate::common::{assert_sound, at, measured};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mesh, Query, QuerySettings, Report, Undecided, Verdict};
use cloudtouch_testkit::scene;
use cloudtouch_testkit::surface::{positions, sample_surface};

/// Seen from a place, or from who knows where.
fn cloud(shape: &TriangleMesh, sensor: Option<Vector3>, seed: u64) -> Cloud {
    let points: Vec<Point3> = measured(shape, 0.01, 0.001, seed);
    let sensor_pose = sensor.map(Pose::from_translation);
    let cloud = PointCloud { sensor_pose, ..PointCloud::from_points(points) };
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    Cloud::prepare(&cloud, &settings).expect("a good cloud")
}

fn ask(a: &Cloud, b: &Cloud, pose: &Pose) -> Report {
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let report = query.run(a, b, pose).expect("a good pose");
    assert_sound(&report);
    report
}

#[test]
fn a_ball_within_a_ball_read_free() {
    let outer = cloud(&scene::sphere(0.2, 3), None, 1);
    let inner = cloud(&scene::sphere(0.05, 3), None, 2);
    for report in
        [ask(&outer, &inner, &at(0.0, 0.02, 0.0)), ask(&inner, &outer, &at(0.0, 0.02, 0.0))]
    {
        assert_eq!(report.verdict, Verdict::Undecided, "{report:?}");
        assert_eq!((report.undecided_by, report.bounds[1]), (Some(Undecided::Enclosed), 1.0));
    }
    let beside = ask(&outer, &inner, &at(0.0, 0.0, 0.4));
    assert_eq!((beside.verdict, beside.undecided_by), (Verdict::Free, None));
}

/// Of a wall nearby too few of the points that were looked at lay in each direction.
#[test]
fn a_body_within_a_wall_read_free() {
    let inner = Mesh::prepare(&scene::cuboid([0.03; 3])).expect("a good mesh");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    for sides in [[1.8, 0.15, 1.2], [1.2, 0.8, 0.08], [0.6, 0.4, 1.8]] {
        let wall = cloud(&scene::cuboid(sides), None, 1);
        for draw in 0..20 {
            // The nearest side is no nearer than a corner reaches, and two spacings.
            let aside = |axis: u64| {
                let most = 0.5 * sides[axis as usize] - 0.027 - 0.01;
                2.0 * most * (seed::unit(seed::derive(7, draw, axis)) - 0.5)
            };
            let pose = at(aside(0), aside(1), aside(2));
            let report = query.run(&wall, &inner, &pose).expect("a good pose");
            assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{sides:?}: {report:?}");
        }
    }
}

/// Nothing said so: a cloud in its place was undecided.
#[test]
fn a_closed_mesh_within_a_closed_cloud_read_free() {
    let outer = cloud(&scene::sphere(0.2, 3), None, 1);
    let inner = Mesh::prepare(&scene::cuboid([0.05; 3])).expect("a good mesh");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    for report in [
        query.run(&outer, &inner, &at(0.0, 0.02, 0.0)).expect("a good pose"),
        query.run(&inner, &outer, &at(0.0, 0.02, 0.0)).expect("a good pose"),
    ] {
        assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{report:?}");
        assert_eq!((report.verdict, report.bounds[1]), (Verdict::Undecided, 1.0));
    }
    let beside = query.run(&outer, &inner, &at(0.0, 0.0, 0.4)).expect("a good pose");
    assert_eq!((beside.verdict, beside.undecided_by), (Verdict::Free, None));
    let hollow = cloud(&scene::sphere(0.2, 3), Some(Vector3::new(0.12, 0.0, 0.0)), 1);
    let free = query.run(&hollow, &inner, &at(0.0, 0.02, 0.0)).expect("a good pose");
    assert_eq!(free.verdict, Verdict::Free, "{free:?}");
}

/// A solid that lacks a triangle has no inside, and what was deep in it read free.
#[test]
fn a_body_within_a_mesh_with_a_hole_read_free() {
    let ball = scene::sphere(0.2, 3);
    let faces = |count: usize| ball.triangles()[..count].to_vec();
    let holed = |count| TriangleMesh::new(ball.vertices().to_vec(), faces(count)).expect("a mesh");
    let all = ball.triangles().len();
    let outer = Mesh::prepare(&holed(all - 1)).expect("a good mesh");
    let small = cloud(&scene::sphere(0.05, 3), None, 2);
    let small_mesh = Mesh::prepare(&scene::cuboid([0.05; 3])).expect("a good mesh");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let within = at(0.0, 0.02, 0.0);
    let of_mesh = query.run(&outer, &small_mesh, &within).expect("a good pose");
    let of_cloud = query.run(&outer, &small, &within).expect("a good pose");
    let swapped = query.run(&small, &outer, &within.inverse()).expect("a good pose");
    for report in [of_mesh, of_cloud, swapped] {
        assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{report:?}");
        assert_eq!((report.verdict, report.bounds[1]), (Verdict::Undecided, 1.0));
    }
    let beside = query.run(&outer, &small, &at(0.0, 0.0, 0.4)).expect("a good pose");
    assert_eq!((beside.verdict, beside.undecided_by), (Verdict::Free, None));
    // A bowl is no hull.
    let bowl = Mesh::prepare(&holed(all * 9 / 10)).expect("a good mesh");
    let in_bowl = query.run(&bowl, &small, &within).expect("a good pose");
    assert_eq!((in_bowl.verdict, in_bowl.undecided_by), (Verdict::Free, None), "{in_bowl:?}");
}

/// A twelfth of all directions is open then, more than were taken for a hole.
#[test]
fn a_body_within_a_box_that_lacks_a_triangle_read_free() {
    let whole = scene::cuboid([0.4, 0.3, 0.2]);
    let without = |lost: &[usize]| {
        let kept = |(t, of): (usize, &[u32; 3])| (!lost.contains(&t)).then_some(*of);
        let faces = whole.triangles().iter().enumerate().filter_map(kept).collect();
        let mesh = TriangleMesh::new(whole.vertices().to_vec(), faces).expect("a mesh");
        Mesh::prepare(&mesh).expect("a good mesh")
    };
    let small = cloud(&scene::sphere(0.05, 3), None, 2);
    let query = Query::new(QuerySettings::default()).expect("good settings");
    for lost in 0..whole.triangles().len() {
        let report =
            query.run(&without(&[lost]), &small, &at(0.05, 0.02, 0.0)).expect("a good pose");
        assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{lost}: {report:?}");
    }
    // Both of a face are a tote's open top.
    let normal = |t: usize| {
        let [a, b, c] = whole.corners(t);
        (b - a).cross(&(c - a)).normalize()
    };
    let same = (1..whole.triangles().len()).find(|&t| (normal(t) - normal(0)).norm() < 1e-9);
    let tote = without(&[0, same.expect("a face of two")]);
    let within = query.run(&tote, &small, &at(0.0, 0.0, 0.0)).expect("a good pose");
    assert_eq!((within.verdict, within.undecided_by), (Verdict::Free, None), "{within:?}");
}

#[test]
fn a_sensor_within_the_hollow_tells_that_it_is_one() {
    let inner = cloud(&scene::sphere(0.05, 3), None, 2);
    // At the origin too, which counted as not said.
    for place in [Vector3::new(0.12, 0.0, 0.0), Vector3::zeros()] {
        let hollow = cloud(&scene::sphere(0.2, 3), Some(place), 1);
        let free = ask(&hollow, &inner, &at(0.0, 0.02, 0.0));
        assert_eq!(free.verdict, Verdict::Free, "{place}: {free:?}");
    }
    // From outside the surface is before everything within.
    let solid = cloud(&scene::sphere(0.2, 3), Some(Vector3::new(0.5, 0.0, 0.0)), 1);
    let within = ask(&solid, &inner, &at(0.0, 0.02, 0.0));
    assert_eq!(within.undecided_by, Some(Undecided::Enclosed), "{within:?}");
}

/// A floor, and high above it a ball in the air.
fn floor_and_ball() -> Cloud {
    let mut points: Vec<Point3> = measured(&scene::plane_patch(2.0), 0.015, 0.002, 3);
    let ball = scene::moved(&scene::sphere(0.05, 3), &at(0.0, 0.0, 0.6));
    points.extend(measured(&ball, 0.006, 0.002, 4));
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

/// It was looked for the object within the scene alone, and a scene has things that an object may be around.
#[test]
fn a_thing_of_the_scene_within_a_box_that_lacks_a_triangle_read_free() {
    let floor_and_ball = floor_and_ball();
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let without = |whole: &TriangleMesh, lost: usize| {
        let mut triangles = whole.triangles().to_vec();
        triangles.remove(lost);
        let open = TriangleMesh::new(whole.vertices().to_vec(), triangles).expect("a mesh");
        Mesh::prepare(&open).expect("a mesh with an area")
    };
    let (around, above) = (at(0.085, 0.0, 0.6), at(0.085, 0.0, 1.2));
    for open in [without(&scene::cuboid([0.3; 3]), 3), without(&scene::sphere(0.2, 4), 7)] {
        let report = query.run(&floor_and_ball, &open, &around).expect("a good pose");
        assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{report:?}");
        let back = query.run(&open, &floor_and_ball, &around.inverse()).expect("a good pose");
        assert_eq!(back.undecided_by, Some(Undecided::Enclosed), "{back:?}");
        let free = query.run(&floor_and_ball, &open, &above).expect("a good pose");
        assert_eq!(free.verdict, Verdict::Free, "{free:?}");
    }
}

/// Of objects that are clouds too.
#[test]
fn a_thing_of_the_scene_within_a_closed_cloud_read_free() {
    let floor_and_ball = floor_and_ball();
    for shape in [scene::cuboid([0.3; 3]), scene::sphere(0.2, 4)] {
        let closed = cloud(&shape, None, 5);
        let around = at(0.085, 0.0, 0.6);
        for report in [
            ask(&floor_and_ball, &closed, &around),
            ask(&closed, &floor_and_ball, &around.inverse()),
        ] {
            assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{report:?}");
            assert_eq!((report.verdict, report.bounds[1]), (Verdict::Undecided, 1.0));
        }
        let free = ask(&floor_and_ball, &closed, &at(0.085, 0.0, 1.2));
        assert_eq!(free.verdict, Verdict::Free, "{free:?}");
        // Its sensor within it saw that there is room.
        let hollow = cloud(&shape, Some(Vector3::new(0.0, 0.1, 0.1)), 5);
        let free = ask(&floor_and_ball, &hollow, &around);
        assert_eq!(free.verdict, Verdict::Free, "{free:?}");
    }
    // A bowl is open.
    let ball = scene::sphere(0.2, 4);
    let is_low = |of: &&[u32; 3]| of.iter().all(|&v| ball.vertices()[v as usize].z < 0.05);
    let faces = ball.triangles().iter().filter(is_low).copied().collect();
    let bowl = TriangleMesh::new(ball.vertices().to_vec(), faces).expect("a mesh");
    let free = ask(&floor_and_ball, &cloud(&bowl, None, 5), &at(0.085, 0.0, 0.6));
    assert_eq!(free.verdict, Verdict::Free, "{free:?}");
}

/// Half a ball with samples of 2 mm of noise, as a bowl that stands upside down.
fn dome(seed: u64) -> Cloud {
    let ball = scene::sphere(0.1, 4);
    let is_high = |of: &&[u32; 3]| of.iter().all(|&v| ball.vertices()[v as usize].z > -0.003);
    let faces = ball.triangles().iter().filter(is_high).copied().collect();
    let half = TriangleMesh::new(ball.vertices().to_vec(), faces).expect("a mesh");
    let cloud = PointCloud::from_points(measured(&half, 0.004, 0.002, seed));
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    Cloud::prepare(&cloud, &settings).expect("a good cloud")
}

/// Within the noise of a surface samples of it are all around, by chance: plates that touch a bowl, larger and
/// smaller than it, were within it.
#[test]
fn a_plate_on_a_bowl_was_enclosed() {
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let mut verdicts = [0; 2];
    for (seed, side) in [(1, 0.2), (2, 0.2), (1, 0.1), (2, 0.1)] {
        let (dome, plate) =
            (dome(seed), Mesh::prepare(&scene::plane_patch(side)).expect("a good mesh"));
        for step in 0..100 {
            let pose = at(0.0, 0.0, 0.09 + 0.0002 * f64::from(step));
            let report = query.run(&dome, &plate, &pose).expect("a good pose");
            assert_eq!(report.undecided_by, None, "{side}, step {step}");
            verdicts[0] += usize::from(report.verdict == Verdict::InCollision);
            verdicts[1] += usize::from(report.verdict == Verdict::Free);
        }
    }
    assert!(verdicts.iter().all(|&count| count > 20), "{verdicts:?}");
}

/// From each place something is seen through a gap between samples, where a single line is asked.
#[test]
fn a_body_in_a_carton_was_seen_through_its_wall_from_one_of_many_sides() {
    let carton = scene::cuboid([0.4, 0.3, 0.3]);
    let inner = Mesh::prepare(&scene::cuboid([0.05; 3])).expect("a good mesh");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    for draw in 0..10 {
        // What a turning table shows of it, each side from nearly across.
        let all = positions(&sample_surface(&carton, 5000, draw));
        let turn = |view: u32| f64::from(view) * std::f64::consts::TAU / 8.0 + 0.1;
        let scans: Vec<PointCloud> = (0..8)
            .map(|view| {
                let seen = all.iter().skip(view as usize).step_by(8);
                let (sin, cos) = turn(view).sin_cos();
                let sensor = Vector3::new(1.2 * cos, 1.2 * sin, 0.3);
                PointCloud {
                    sensor_pose: Some(Pose::from_translation(sensor)),
                    ..PointCloud::from_points(seen.copied().collect())
                }
            })
            .collect();
        let scans: Vec<_> = scans.iter().map(|scan| (scan, &settings)).collect();
        let outer = Cloud::merge(&scans).expect("points");
        for k in 0..5 {
            let aside = |axis| 0.1 * (seed::unit(seed::derive(draw, k, axis)) - 0.5);
            let report = query.run(&outer, &inner, &at(aside(0), aside(1), aside(2)));
            let report = report.expect("a good pose");
            assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{draw} {k}: {report:?}");
        }
    }
}

/// Five walls are a box with a way out.
#[test]
fn an_object_in_an_open_box_is_free() {
    let wall = |pose: &Pose| scene::moved(&scene::plane_patch(0.4), pose);
    let turned = |x: f64, y: f64, rpy| Pose::from_translation_rpy(Vector3::new(x, y, 0.2), rpy);
    let quarter = std::f64::consts::FRAC_PI_2;
    let walls = scene::assemble([
        wall(&Pose::identity()),
        wall(&turned(0.2, 0.0, [0.0, quarter, 0.0])),
        wall(&turned(-0.2, 0.0, [0.0, quarter, 0.0])),
        wall(&turned(0.0, 0.2, [quarter, 0.0, 0.0])),
        wall(&turned(0.0, -0.2, [quarter, 0.0, 0.0])),
    ]);
    let inner = cloud(&scene::sphere(0.05, 3), None, 2);
    let report = ask(&cloud(&walls, None, 3), &inner, &at(0.0, 0.0, 0.2));
    assert_eq!(report.verdict, Verdict::Free, "{report:?}");
}

/// Directions were told apart by squares along the axes of the file, of which a few have no point by chance: in 7 of
/// 200 frames it was not.
#[test]
fn a_closed_cloud_was_all_around_in_some_frames_only() {
    let hull = positions(&sample_surface(&scene::cuboid([0.5, 0.35, 0.3]), 700, 4));
    let inner = Mesh::prepare(&scene::cuboid([0.05; 3])).expect("a good mesh");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let mut enclosed = 0;
    for turn in 0..200 {
        let angle = |k| 6.3 * seed::unit(seed::derive(9, turn, k));
        let turned = Pose::from_translation_rpy(Vector3::zeros(), [angle(0), angle(1), angle(2)]);
        let points = hull.iter().map(|p| turned.transform_point(p)).collect();
        let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
        let outer = Cloud::prepare(&PointCloud::from_points(points), &settings).expect("points");
        let report = query.run(&outer, &inner, &turned.after(&at(0.05, 0.02, 0.0)));
        let report = report.expect("a good pose");
        enclosed += usize::from(report.undecided_by == Some(Undecided::Enclosed));
    }
    assert_eq!(enclosed, 200);
}

/// So were those of clouds that are open, or have too few points.
#[test]
fn a_thing_in_a_cloud_was_enclosed_in_some_frames_only() {
    let closed = scene::cuboid([0.5, 0.35, 0.3]);
    let is_top = |k: usize| closed.corners(k).iter().all(|corner| corner.z > 0.1);
    let sides =
        (0..closed.triangles().len()).filter(|&k| !is_top(k)).map(|k| closed.triangles()[k]);
    let open = TriangleMesh::new(closed.vertices().to_vec(), sides.collect());
    let open = open.expect("vertices that are there");
    let [mut enclosed, mut free] = [0, 0];
    for (shape, points, seed) in
        [(&closed, 700, 4), (&closed, 300, 4), (&open, 300, 4), (&open, 300, 5)]
    {
        let hull = positions(&sample_surface(shape, points, seed));
        let in_frames: Vec<[usize; 2]> = (0..12).map(|frame| within_turned(&hull, frame)).collect();
        assert!(in_frames.iter().all(|counts| *counts == in_frames[0]), "{in_frames:?}");
        enclosed += in_frames[0][0];
        free += in_frames[0][1];
    }
    assert!(enclosed >= 40 && free >= 40, "{enclosed} {free}");
}

/// Of small things all over a hull that is turned anyhow, how many are enclosed and how many free.
fn within_turned(hull: &[Point3], frame: u64) -> [usize; 2] {
    let draw = |stream, index, k| seed::unit(seed::derive(stream, index, k));
    let turned =
        Pose::from_translation_rpy(Vector3::zeros(), [0, 1, 2].map(|k| 6.3 * draw(9, frame, k)));
    let points = hull.iter().map(|p| turned.transform_point(p)).collect();
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    let outer = Cloud::prepare(&PointCloud::from_points(points), &settings).expect("points");
    let inner = Mesh::prepare(&scene::cuboid([0.04; 3])).expect("a good mesh");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let reports = (0..40).map(|index| {
        let at = [0.28, 0.19, 0.17]
            .into_iter()
            .zip(0..)
            .map(|(half, k)| half * (2.0 * draw(33, index, k) - 1.0));
        let at = Pose::from_translation(Vector3::from_iterator(at));
        query.run(&outer, &inner, &turned.after(&at)).expect("a good pose")
    });
    reports.fold([0, 0], |[enclosed, free], report| {
        let is_enclosed = report.undecided_by == Some(Undecided::Enclosed);
        [enclosed + usize::from(is_enclosed), free + usize::from(report.verdict == Verdict::Free)]
    })
}
