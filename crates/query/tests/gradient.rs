//! What a small motion of the object changes, against what runs at poses a little aside say.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, PoseGradient, Query, QuerySettings, Report};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};
use nalgebra::{UnitQuaternion, Vector6};

/// What a radian counts beside a metre, m: about the size of the bodies.
const ARM: f64 = 0.1;
/// Steps of the differences, m and `1 / ARM` rad.
const STEPS: [f64; 2] = [4e-6, 1e-6];
/// Two differences that are farther apart, relative to their size, are of no smooth place.
const SMOOTH: f64 = 2e-3;
/// How far a gradient may be off, relative to its size.
const MOST_ERROR: f64 = 1e-2;
/// A slope below this is none: of log odds per metre, and of the clearance.
const FLAT: [f64; 2] = [1e-2, 1e-3];

/// Where the points of the objects are in their own frame: far from its origin, so that a turn about that
/// moves them far.
const PLACE: Vector3 = Vector3::new(0.3, -0.2, 0.1);

/// A cloud, or a mesh that is closed; of every third seed one that lacks a triangle.
fn body(mesh: &TriangleMesh, is_mesh: bool, std: f64, seed: u64) -> Body {
    if is_mesh {
        let faces = &mesh.triangles()[usize::from(seed.is_multiple_of(3))..];
        let mesh = TriangleMesh::new(mesh.vertices().to_vec(), faces.to_vec()).unwrap();
        return Body::from(Mesh::prepare(&mesh).unwrap());
    }
    let samples = surface::positions(&surface::sample_surface(mesh, 900, seed));
    let points: Vec<Point3> = add_noise(&samples, NoiseKind::Gaussian, std, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    Body::Cloud(Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap())
}

/// Never stops early, and separates the patches of a classifier to the last digit.
fn query() -> Query {
    let settings = QuerySettings { stop_above: 2.0, relative_gap: 1e-9, ..Default::default() };
    Query::new(settings).unwrap()
}

fn moved(pose: &Pose, axis: usize, step: f64) -> Pose {
    let (mut shift, mut turn) = (Vector3::zeros(), Vector3::zeros());
    if axis < 3 {
        shift[axis] = step
    } else {
        turn[axis - 3] = step / ARM
    }
    let turn = UnitQuaternion::from_scaled_axis(turn);
    pose.after(&Pose::from_translation_rotation(shift, turn))
}

fn log_odds(report: &Report) -> Option<f64> {
    report.log_likelihood_ratio
}

fn clearance(report: &Report) -> Option<f64> {
    report.clearance_m.map(|gap| gap.mean)
}

/// Central differences with both steps, rotations by the arm; `None` where these do not agree.
fn differences(
    (a, b): (&Body, &Body),
    pose: &Pose,
    of: fn(&Report) -> Option<f64>,
) -> Option<Vector6<f64>> {
    let query = query();
    let mut both = [Vector6::zeros(); 2];
    for (difference, step) in both.iter_mut().zip(STEPS) {
        for axis in 0..6 {
            let at = |step| of(&query.run(a, b, &moved(pose, axis, step)).unwrap());
            difference[axis] = (at(step)? - at(-step)?) / (2.0 * step);
        }
    }
    let [wide, narrow] = both;
    ((wide - narrow).norm() <= SMOOTH * narrow.norm()).then_some(narrow)
}

fn by_arm(gradient: [f64; 6]) -> Vector6<f64> {
    Vector6::from_fn(|k, _| if k < 3 { gradient[k] } else { gradient[k] / ARM })
}

/// How many gradients there were, of smooth places to compare, and how many of these were right; the
/// others are flat or have a step nearby.
#[derive(Debug, Default)]
struct Tally {
    compared: usize,
    right: usize,
    flat: usize,
    rough: usize,
}

impl Tally {
    fn add(&mut self, found: &Vector6<f64>, difference: Option<Vector6<f64>>, flat: f64) {
        let Some(difference) = difference else {
            self.rough += 1;
            return;
        };
        if difference.norm() <= flat {
            self.flat += 1;
            assert!(found.norm() <= 2.0 * flat, "{found}");
            return;
        }
        self.compared += 1;
        let error = (found - difference).norm() / difference.norm();
        self.right += usize::from(error <= MOST_ERROR);
        if error > MOST_ERROR {
            println!("off by {error:.3}: {:.4?} {:.4?}", found.as_slice(), difference.as_slice());
        }
    }
}

/// Poses of a ball and a box about contact: of the log odds by geometry, of those that a classifier
/// revised, and of the clearance.
fn measure(kinds: [bool; 2], poses: u64) -> [Tally; 3] {
    let shapes = [scene::cuboid([0.2; 3]), scene::sphere(0.07, 3)];
    let mut tallies = <[Tally; 3]>::default();
    for index in 0..poses {
        let unit = |stream: u64| seed::unit(seed::derive(stream, index, kinds.len() as u64));
        let std = 0.001 * 8.0_f64.powf(unit(0));
        let swapped = usize::from(unit(1) < 0.5);
        let a = body(&shapes[swapped], kinds[0], std, index);
        let object = scene::moved(&shapes[1 - swapped], &Pose::from_translation(PLACE));
        let b = body(&object, kinds[1], std, index + 1);
        let away = Vector3::new(unit(2) - 0.5, unit(3) - 0.5, unit(4) - 0.5).normalize();
        // The box reaches 10 cm along its axes: from 2 cm deep to 5 cm away.
        let distance = 0.07 + 0.1 / away.amax() - 0.02 + 0.07 * unit(5);
        // No edge is along a face: two places that are as near would each have a gradient.
        let most = if swapped == 0 { 6.0 } else { 0.1 };
        let turn = [6, 7, 8].map(|stream| most * unit(stream));
        let pose = Pose::from_translation_rpy(away * distance, turn)
            .after(&Pose::from_translation(-PLACE));
        let (report, PoseGradient { log_odds: found, clearance: gap, .. }) =
            query().gradient(&a, &b, &pose).unwrap();
        let asked = report.evidence.is_some_and(|evidence| evidence.misclassified.is_some());
        tallies[usize::from(asked)].add(
            &by_arm(found),
            differences((&a, &b), &pose, log_odds),
            FLAT[0],
        );
        if let (Some(gap), Some(false)) = (gap, report.clearance_m.map(|gap| gap.is_bound)) {
            tallies[2].add(&by_arm(gap), differences((&a, &b), &pose, clearance), FLAT[1]);
        }
    }
    tallies
}

fn check(kinds: [bool; 2], poses: u64, least: [usize; 3]) {
    let tallies = measure(kinds, poses);
    println!("{kinds:?}: {tallies:?}");
    for (tally, least) in tallies.iter().zip(least) {
        assert!(tally.compared >= least, "{tally:?}");
        assert!(tally.right as f64 >= 0.95 * tally.compared as f64, "{tally:?}");
    }
}

#[test]
fn two_meshes_have_a_clearance_and_no_doubt() {
    let [_, _, of_clearance] = measure([true, true], 60);
    println!("{of_clearance:?}");
    assert!(of_clearance.compared >= 20 && of_clearance.right == of_clearance.compared);
    let cube = body(&scene::cuboid([0.2; 3]), true, 0.0, 1);
    let (_, apart) = query().gradient(&cube, &cube, &Pose::from_translation(Vector3::z())).unwrap();
    assert_eq!((apart.probability, apart.log_odds), ([0.0; 6], [0.0; 6]));
    assert!((apart.clearance.unwrap()[2] - 1.0).abs() < 1e-9);
    let (_, inside) = query().gradient(&cube, &cube, &Pose::identity()).unwrap();
    assert_eq!(inside.clearance, None);
}

#[test]
fn the_report_is_that_of_a_query() {
    let (a, b) = (
        body(&scene::cuboid([0.2; 3]), false, 0.002, 1),
        body(&scene::sphere(0.07, 3), true, 0.0, 1),
    );
    for height in [0.3, 0.175, 0.17, 0.165] {
        let pose = Pose::from_translation(Vector3::new(0.0, 0.0, height));
        let (mut report, gradient) = query().gradient(&a, &b, &pose).unwrap();
        let plain = query().run(&a, &b, &pose).unwrap();
        report.stats = plain.stats;
        assert_eq!(report, plain);
        let p = report.collision_probability;
        let [of_p, of_odds] = [gradient.probability, gradient.log_odds].map(by_arm);
        assert!((of_p - of_odds * p * (1.0 - p)).norm() <= 1e-12 * of_odds.norm());
    }
}

#[test]
fn two_clouds() {
    check([false, false], 150, [10, 5, 10]);
}

#[test]
fn a_cloud_and_a_closed_mesh() {
    check([false, true], 200, [30, 2, 30]);
    check([true, false], 200, [30, 2, 30]);
}

/// The sum of the least deviations, 1.5 to 2, and of the window above them rounds. Where it rounded down the window
/// counted as cut short, and the gradient was off by up to a third.
#[test]
fn a_window_that_rounding_alone_makes_shorter_is_not_cut_short() {
    let ball = body(&scene::sphere(0.07, 3), false, 0.003, 1);
    let sheet = body(&scene::rectangle(0.3, 0.3), true, 0.003, 1);
    let mut tally = Tally::default();
    for k in 0..400 {
        let pose = Pose::from_translation(Vector3::new(0.01, 0.02, 0.072 + 2e-5 * f64::from(k)));
        let (report, gradient) = query().gradient(&ball, &sheet, &pose).unwrap();
        if report.evidence.is_some_and(|evidence| (1.5..2.0).contains(&evidence.deviations)) {
            let difference = differences((&ball, &sheet), &pose, log_odds);
            tally.add(&by_arm(gradient.log_odds), difference, FLAT[0]);
        }
    }
    assert!(tally.compared >= 15 && tally.right == tally.compared, "{tally:?}");
}
