//! Many bodies: the answer is that of all pairs asked one by one, and most are ruled out by their boxes.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::sync::Arc;

use crate::common::scenes::{cloud, mesh, names, query};
use crate::common::{at, measured, timeless, uniform};
use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Body, Checked, Cloud, CloudSettings, PairAnswer, Query, QueryError, QuerySettings, Report,
    Safeguards, Scene, Undecided, Verdict, Warning,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;
use cloudtouch_testkit::workshop::{self, Workshop, workshop};
use proptest::prelude::*;

/// A wall two metres ahead, as a camera sees it.
fn image() -> Body {
    let wall = ExactMesh::new(&scene::moved(&scene::plane_patch(4.0), &at(0.0, 0.0, 2.0)));
    let camera = DepthCamera { width: 60, height: 45, focal_px: 50.0, ..DepthCamera::default() };
    let seen = camera.scan(&[&wall], &Pose::identity(), 1);
    Cloud::prepare(&seen, &CloudSettings::new(SensorModel::Kinect)).unwrap().into()
}

/// Beside a rod, whose box is smaller and which is longer than samples are apart, a ball that is smaller than that
/// was ruled out by its box.
#[test]
fn a_cloud_that_is_too_coarse_for_one_body_is_so_whatever_others_there_are() {
    let place = |k: usize| 0.12 * k as f64 - 1.2;
    let wall = (0..400).map(|i| Point3::new(place(i % 20), place(i / 20), 0.0)).collect();
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.005 });
    let wall = Cloud::prepare(&PointCloud::from_points(wall), &settings).unwrap();
    let mut scene = Scene::default();
    scene.add("wall", wall, Pose::identity()).unwrap();
    scene.add("ball", mesh(&scene::sphere(0.05, 2)), at(0.0, 0.0, 1.0)).unwrap();
    scene.add("rod", mesh(&scene::cuboid([0.14, 0.02, 0.02])), at(0.5, 0.0, 1.0)).unwrap();
    let checked = assert_same(&scene, &query());
    assert_eq!(names(&checked), [["wall", "ball"]]);
    let by = checked.pairs[0].answer.as_ref().unwrap().undecided_by;
    assert_eq!(by, Some(Undecided::Sparse));
}

/// A scan without the rows and columns of its camera: what that did not see counts as empty.
fn without_layout() -> Cloud {
    let points =
        measured(&scene::moved(&scene::plane_patch(1.0), &at(0.0, 0.0, 2.0)), 0.02, 0.004, 1);
    Cloud::prepare(&PointCloud::from_points(points), &CloudSettings::new(SensorModel::Kinect))
        .unwrap()
}

/// A query of the pair warned of it, whatever its verdict; of a scene only pairs that are not free were told.
#[test]
fn what_is_to_be_said_of_a_scan_was_left_out_where_all_is_free() {
    let mut scene = Scene::default();
    scene.add("scan", without_layout(), Pose::identity()).unwrap();
    scene.add("ball", mesh(&scene::sphere(0.05, 2)), at(0.0, 0.0, 1.5)).unwrap();
    let checked = scene.check(&query());
    assert_eq!(checked.verdict(), Verdict::Free, "{checked:?}");
    let [told] = &checked.warnings[..] else { panic!("{checked:?}") };
    assert!(told.name == "scan" && matches!(told.warning, Warning::NoImage { .. }), "{told}");
    assert!(told.to_string().starts_with("`scan`: the scene has no rows and columns"), "{told}");
}

#[test]
fn boxes_are_where_the_poses_put_the_bodies() {
    let mut scene = Scene::default();
    scene.add("hand", mesh(&scene::cuboid([0.2, 0.1, 0.4])), at(1.0, 0.0, 0.0)).unwrap();
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned = Pose::from_translation_rpy(Vector3::new(0.0, 0.0, 1.0), [0.0, 0.0, quarter]);
    scene.add("cup", mesh(&scene::cuboid([0.2, 0.1, 0.4])), turned).unwrap();
    scene.attach("cup", "hand", turned).unwrap();
    let [low, high] = scene.boxes()["cup"];
    let expected = [Point3::new(0.95, -0.1, 0.8), Point3::new(1.05, 0.1, 1.2)];
    assert!(
        (low - expected[0]).norm() < 1e-9 && (high - expected[1]).norm() < 1e-9,
        "{low} {high}"
    );
}

/// All pairs that may not touch and are not free, each asked by itself, in the order that the scene asked it
/// in: in the other one sums are rounded otherwise.
fn one_by_one(scene: &Scene, query: &Query, of_scene: &Checked) -> Vec<Key> {
    let names: Vec<&str> = scene.names().collect();
    let mut answers = Vec::new();
    for (k, first) in names.iter().enumerate() {
        for second in &names[k + 1..] {
            if scene.is_allowed(first, second).unwrap() {
                continue;
            }
            let is_turned = |pair: &PairAnswer| pair.a == *second && pair.b == *first;
            let [a, b] = if of_scene.pairs.iter().any(is_turned) {
                [*second, *first]
            } else {
                [*first, *second]
            };
            let a_from_b = scene.between(a, b).unwrap();
            let (a_body, b_body) = (scene.body(a).unwrap(), scene.body(b).unwrap());
            let answer = query.among_many().run(a_body, b_body, &a_from_b);
            if !matches!(&answer, Ok(report) if report.verdict == Verdict::Free) {
                answers.push(key(a, b, &answer));
            }
        }
    }
    answers
}

/// What does not depend on the frame that contacts are told in: probability and bounds by their bits.
type Told = Result<(u64, [u64; 2], Verdict), QueryError>;

/// Names of two bodies, and what is told of them.
type Key = (String, String, Told);

fn key(a: &str, b: &str, answer: &Result<Report, QueryError>) -> Key {
    let answer = answer.as_ref().map_err(Clone::clone).map(|report| {
        let bounds = report.bounds.map(f64::to_bits);
        (report.collision_probability.to_bits(), bounds, report.verdict)
    });
    (a.to_owned(), b.to_owned(), answer)
}

fn assert_same(scene: &Scene, query: &Query) -> Checked {
    let checked = scene.check(query);
    let mut expected = one_by_one(scene, query, &checked);
    let key_of = |pair: &PairAnswer| key(&pair.a, &pair.b, &pair.answer);
    let mut found: Vec<_> = checked.pairs.iter().map(key_of).collect();
    expected.sort_by(|p, q| (&p.0, &p.1).cmp(&(&q.0, &q.1)));
    found.sort_by(|p, q| (&p.0, &p.1).cmp(&(&q.0, &q.1)));
    assert_eq!(found, expected);
    let bodies = scene.names().count();
    assert_eq!(checked.count, bodies * (bodies - 1) / 2);
    assert_eq!(checked.count, checked.allowed + checked.ruled_out + checked.asked);
    let first = scene.check_first(query);
    assert_eq!(first.is_none(), checked.pairs.is_empty());
    assert_eq!(scene.is_free(query), checked.verdict() == Verdict::Free);
    if let Some(first) = first {
        assert!(checked.pairs.iter().any(|pair| key_of(pair) == key_of(&first)));
    }
    checked
}

fn random_pose(seed: u64, k: u64, size: f64) -> Pose {
    let unit = |n: u64| 2.0 * uniform(seed, 8 * k + n) - 1.0;
    let offset = Vector3::new(unit(0), unit(1), unit(2)) * size;
    Pose::from_translation_rpy(offset, [3.0 * unit(3), 1.5 * unit(4), 3.0 * unit(5)])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_scene_answers_what_all_pairs_answer_one_by_one(
        seed in any::<u64>(),
        size in 0.05..1.5_f64,
        std in 0.0005..0.02_f64,
        prior in prop::sample::select(vec![0.01, 0.5, 0.9]),
        has_image in any::<bool>(),
        max_unseen in prop::sample::select(vec![0.05, 1.0]),
    ) {
        let shapes = [scene::cuboid([0.2, 0.1, 0.15]), scene::sphere(0.08, 2), scene::plane_patch(0.4)];
        let mut scene = Scene::default();
        for k in 0..9 {
            let shape = &shapes[k % 3];
            let body = if k % 2 == 0 { mesh(shape) } else { cloud(shape, 0.02, std, seed ^ k as u64) };
            scene.add(format!("body {k}"), body, random_pose(seed, k as u64, size)).unwrap();
        }
        if has_image {
            scene.add("image", image(), random_pose(seed, 20, size)).unwrap();
        }
        scene.allow("body 1", "body 4").unwrap();
        let usual = QuerySettings::default();
        let safeguards = Safeguards { max_unseen, ..usual.safeguards };
        assert_same(&scene, &Query::new(QuerySettings { prior, safeguards, ..usual }).unwrap());
    }
}

#[test]
fn contacts_are_told_in_the_frame_of_the_scene() {
    let wall = cloud(&scene::cuboid([0.4, 0.4, 0.1]), 0.01, 0.001, 1);
    let mut scene = Scene::default();
    let base = Pose::from_translation_rpy(Vector3::new(5.0, -3.0, 1.0), [0.4, -1.0, 2.0]);
    let above = base.after(&at(0.0, 0.0, 0.1));
    scene.add("wall", wall, base).unwrap();
    scene.add("cube", mesh(&scene::cuboid([0.1; 3])), above).unwrap();
    let found = scene.check(&query());
    let report = found.pairs[0].answer.as_ref().unwrap();
    assert!(!report.contacts.is_empty());
    for contact in &report.contacts {
        // The upper face of the wall, as the wall has it.
        let place = base.inverse().transform_point(&contact.point);
        assert!(place.x.abs() < 0.08 && place.y.abs() < 0.08, "{place}");
        assert!((place.z - 0.05).abs() < 0.02, "{place}");
    }
}

#[test]
fn the_worst_comes_first_whatever_the_number_of_threads() {
    let mut scene = Scene::default();
    scene
        .add("floor", cloud(&scene::cuboid([1.0, 1.0, 0.02]), 0.02, 0.002, 1), at(0.0, 0.0, 0.0))
        .unwrap();
    let ball = Arc::new(cloud(&scene::sphere(0.05, 2), 0.01, 0.002, 2));
    for (k, height) in [0.3, 0.062, 0.02, 0.045, 0.07].into_iter().enumerate() {
        let place = at(0.2 * k as f64 - 0.4, 0.0, height);
        scene.add(format!("ball {k}"), Arc::clone(&ball), place).unwrap();
    }
    let alone = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut checked = pool.install(|| scene.check(&query()));
        for pair in &mut checked.pairs {
            pair.answer = pair.answer.as_ref().map(timeless).map_err(Clone::clone);
        }
        checked
    };
    let checked = alone(1);
    assert_eq!(checked, alone(3));
    assert_eq!(checked.verdict(), Verdict::InCollision);
    let rank = |pair: &PairAnswer| match pair.verdict() {
        Verdict::InCollision => 0,
        Verdict::Undecided => 1,
        _ => 2,
    };
    let probability = |pair: &PairAnswer| pair.answer.as_ref().unwrap().collision_probability;
    for pair in checked.pairs.windows(2) {
        let [worse, better] = [&pair[0], &pair[1]];
        assert!(rank(worse) <= rank(better));
        assert!(rank(worse) < rank(better) || probability(worse) >= probability(better));
    }
    assert!(checked.pairs.len() >= 2, "{:?}", names(&checked));
}

/// Boxes say nothing of space that no camera saw.
#[test]
fn a_body_far_behind_the_camera_is_undecided_though_boxes_rule_it_out() {
    let mut scene = Scene::default();
    scene.add("image", image(), Pose::identity()).unwrap();
    scene.add("seen", mesh(&scene::sphere(0.05, 2)), at(0.0, 0.0, 1.0)).unwrap();
    scene.add("hidden", mesh(&scene::sphere(0.05, 2)), at(0.0, 0.0, -1.0)).unwrap();
    let found = assert_same(&scene, &query());
    assert_eq!(names(&found), [["image", "hidden"]]);
    let report = found.pairs[0].answer.as_ref().unwrap();
    assert_eq!(report.undecided_by, Some(Undecided::Unseen));
    assert_eq!((found.verdict(), found.ruled_out), (Verdict::Undecided, 2));
}

/// Nor of sizes: one that is in millimetres beside the others is doubted with each, wherever they are, and
/// so is one with nothing but a line of points.
#[test]
fn a_size_that_only_the_smaller_of_two_is_doubted_for_counts_too() {
    let mut scene = Scene::default();
    scene.add("a hall", mesh(&scene::cuboid([170.0; 3])), at(0.0, 0.0, 0.0)).unwrap();
    scene.add("b house", mesh(&scene::cuboid([80.0; 3])), at(0.0, 150.0, 0.0)).unwrap();
    scene.add("crate", mesh(&scene::cuboid([2.5; 3])), at(150.0, 0.0, 0.0)).unwrap();
    let found = assert_same(&scene, &query());
    let by = found.pairs[0].answer.as_ref().unwrap().undecided_by;
    assert_eq!((names(&found), by), (vec![["a hall", "b house"]], Some(Undecided::Units)));
}

/// A gripper in millimetres was the larger body, and so the surroundings of what the camera saw, in which it was free.
#[test]
fn a_mesh_in_millimetres_beside_a_scan_was_taken_for_its_surroundings() {
    let mut scene = Scene::default();
    let table = PointCloud::from_points(measured(&scene::plane_patch(1.0), 0.02, 0.002, 1));
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    scene.add("scan", Cloud::prepare(&table, &settings).unwrap(), Pose::identity()).unwrap();
    scene.add("cup", mesh(&scene::cuboid([0.1; 3])), at(0.0, 0.0, 0.3)).unwrap();
    for z in [200.0, 31.0] {
        let mut scene = scene.clone();
        let gripper = mesh(&scene::cuboid([40.0, 80.0, 60.0]));
        scene.add("gripper", gripper, at(0.0, 0.0, z)).unwrap();
        let found = assert_same(&scene, &query());
        let of_scan = found.pairs.iter().find(|pair| [&pair.a, &pair.b].contains(&&"scan".into()));
        let by = of_scan.and_then(|pair| pair.answer.as_ref().ok()?.undecided_by);
        assert_eq!(by, Some(Undecided::Units), "{found:?}");
        assert!(!scene.is_free(&query()));
    }
    // What the floor of a hall is.
    scene.add("a floor", mesh(&scene::cuboid([60.0, 60.0, 0.1])), at(0.0, 0.0, -1.0)).unwrap();
    assert_eq!(assert_same(&scene, &query()).verdict(), Verdict::Free);
}

#[test]
fn what_is_wrong_with_a_body_itself_counts_however_far_away_it_is() {
    let mut scene = Scene::default();
    scene.add("cube", mesh(&scene::cuboid([0.1; 3])), at(0.0, 0.0, 0.0)).unwrap();
    scene.add("far", mesh(&scene::cuboid([0.1; 3])), at(3.0, 0.0, 0.0)).unwrap();
    let found = assert_same(&scene, &query());
    assert_eq!((found.ruled_out, found.pairs.len()), (1, 0));
    scene.add("millimetres", mesh(&scene::cuboid([180.0; 3])), at(0.0, 150.0, 0.0)).unwrap();
    let found = assert_same(&scene, &query());
    assert_eq!((found.ruled_out, found.pairs.len()), (1, 2));
    scene.remove("millimetres").unwrap();
    let line = (0..50).map(|k| [0.01 * f64::from(k), 0.0, 0.0].into()).collect();
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    let line = Cloud::prepare(&PointCloud::from_points(line), &settings).unwrap();
    scene.add("line", Body::from(line), at(0.0, 1.0, 0.0)).unwrap();
    let found = assert_same(&scene, &query());
    assert_eq!((found.ruled_out, found.pairs.len()), (1, 2));
    let noisy = cloud(&scene::cuboid([0.1; 3]), 0.01, 0.3, 1);
    scene.replace("line", noisy).unwrap();
    let found = assert_same(&scene, &query());
    assert_eq!((found.ruled_out, found.pairs.len()), (1, 2));
}

#[test]
fn far_from_one_body_is_no_doubt_and_far_from_all_is() {
    let screw = Arc::new(mesh(&scene::sphere(0.005, 2)));
    let mut scene = Scene::default();
    scene.add("left", Arc::clone(&screw), at(0.0, 0.0, 0.0)).unwrap();
    scene.add("middle", Arc::clone(&screw), at(0.5, 0.0, 0.0)).unwrap();
    scene.add("right", Arc::clone(&screw), at(2.0, 0.0, 0.0)).unwrap();
    let outside = |scene: &Scene| {
        scene.check(&query()).outside.iter().map(|of| of.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(outside(&scene), ["right"]);
    let pair = scene.between("left", "right").unwrap();
    let alone = query().run(&*screw, &*screw, &pair).unwrap();
    assert_eq!(alone.undecided_by, Some(Undecided::Units));
    assert_eq!(scene.check(&query()).verdict(), Verdict::Free);
    // Metres taken for millimetres.
    scene.set_pose("right", at(2000.0, 0.0, 0.0)).unwrap();
    let found = scene.check(&query());
    assert_eq!((found.verdict(), found.pairs.len()), (Verdict::Undecided, 2));
    let names = found.pairs.iter().map(|pair| [&pair.a, &pair.b]);
    assert!(names.into_iter().all(|pair| pair.iter().any(|name| *name == "right")));
}

/// A prior or a threshold by which nothing found is not free rules nothing out.
#[test]
fn where_nothing_found_is_not_free_every_pair_is_in_the_answer() {
    let mut scene = Scene::default();
    scene.add("cloud", cloud(&scene::sphere(0.05, 2), 0.01, 0.001, 1), at(0.0, 0.0, 0.0)).unwrap();
    scene.add("cube", mesh(&scene::cuboid([0.1; 3])), at(1.0, 0.0, 0.0)).unwrap();
    for settings in [
        QuerySettings { prior: 0.9999, ..QuerySettings::default() },
        QuerySettings { reject: 1e-5, ..QuerySettings::default() },
    ] {
        let found = assert_same(&scene, &Query::new(settings).unwrap());
        assert_eq!((found.asked, found.pairs.len()), (1, 1));
    }
    assert_eq!(assert_same(&scene, &query()).ruled_out, 1);
}

#[test]
fn a_pair_that_cannot_be_asked_is_in_the_answer_and_not_free() {
    let cube = Arc::new(mesh(&scene::cuboid([0.1; 3])));
    let mut scene = Scene::default();
    scene.add("here", Arc::clone(&cube), at(-9e9, 0.0, 0.0)).unwrap();
    scene.add("there", cube, at(9e9, 0.0, 0.0)).unwrap();
    let found = scene.check(&query());
    assert_eq!((found.pairs.len(), found.verdict()), (1, Verdict::Undecided));
    assert!(matches!(found.pairs[0].answer, Err(QueryError::Pose { .. })));
    assert!(scene.check_first(&query()).unwrap().answer.is_err() && !scene.is_free(&query()));
}

#[test]
fn a_list_of_pairs_is_asked_up_to_the_first_that_is_not_free() {
    let cube = mesh(&scene::cuboid([0.1; 3]));
    let (free, touching, nowhere) = (at(0.3, 0.0, 0.0), at(0.05, 0.0, 0.0), at(f64::NAN, 0.0, 0.0));
    let first = |poses: &[Pose]| {
        let mut asked = 0;
        let pairs = poses.iter().map(|pose| (&cube, &cube, *pose)).inspect(|_| asked += 1);
        let found = query().any(pairs);
        (found.map(|found| (found.index, found.answer.map(|report| report.verdict))), asked)
    };
    assert_eq!(first(&[free, free]), (None, 2));
    let hit = Some((1, Ok(Verdict::InCollision)));
    assert_eq!(first(&[free, touching, nowhere]), (hit, 2));
    // What cannot be asked is not free.
    assert!(matches!(
        first(&[free, nowhere, touching]),
        (Some((1, Err(QueryError::Pose { .. }))), 2)
    ));
}

fn of_workshop() -> Scene {
    let Workshop { balls, link, links } = workshop();
    let mut scene = Scene::default();
    let settings = CloudSettings::new(SensorModel::Isotropic { std: workshop::STD });
    for (name, points, place) in balls {
        let ball = Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap();
        scene.add(name, ball, place).unwrap();
    }
    let link = Arc::new(mesh(&link));
    for (name, place) in &links {
        scene.add(name, Arc::clone(&link), *place).unwrap();
    }
    for ends in links.windows(2) {
        scene.allow(&ends[0].0, &ends[1].0).unwrap();
    }
    scene
}

#[test]
fn of_a_hundred_bodies_and_an_arm_few_pairs_are_asked() {
    let scene = of_workshop();
    let checked = assert_same(&scene, &query());
    assert_eq!((checked.count, checked.allowed), (112 * 111 / 2, 11));
    // Nine balls are near one or two links each.
    assert!((9..=20).contains(&checked.asked), "{checked:?}");
}
