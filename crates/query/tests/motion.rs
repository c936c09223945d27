//! Continuous collision: nothing between the poses of a path is missed, and bounds hold.

use crate::common::{at, measured};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Body, Cloud, CloudSettings, Detail, Mesh, Path, Query, QueryError, QuerySettings, Swept,
    Verdict,
};
use cloudtouch_testkit::scene;

fn query() -> Query {
    Query::new(QuerySettings::default()).expect("good settings")
}

fn cloud(shape: &TriangleMesh, spacing: f64, std: f64, seed: u64) -> Body {
    let points: Vec<Point3> = measured(shape, spacing, std, seed);
    let mut settings = CloudSettings::new(SensorModel::Isotropic { std });
    settings.tree.max_leaf_points = 32;
    settings.tree.min_leaf_points = 8;
    let cloud = Cloud::prepare(&PointCloud::from_points(points), &settings);
    Body::Cloud(cloud.expect("a good cloud"))
}

/// The shape as a cloud or as itself.
fn body(is_mesh: bool, shape: &TriangleMesh, spacing: f64, std: f64, seed: u64) -> Body {
    match is_mesh {
        true => Body::from(Mesh::prepare(shape).expect("a good mesh")),
        false => cloud(shape, spacing, std, seed),
    }
}

const KINDS: [[bool; 2]; 4] = [[false, false], [false, true], [true, false], [true, true]];

fn sweep(a: &Body, b: &Body, path: &Path, tolerance: f64) -> Swept {
    query().sweep(a, b, path, tolerance).expect("a good path")
}

fn probability(a: &Body, b: &Body, pose: &Pose) -> f64 {
    query().run(a, b, pose).expect("a good pose").collision_probability
}

#[test]
fn a_blade_moved_through_a_sheet_in_one_step_is_found() {
    let (sheet, blade) = (scene::cuboid([0.4, 0.4, 0.004]), scene::cuboid([0.002, 0.1, 0.1]));
    let ends = [at(0.03, 0.0, 0.3), at(0.03, 0.0, -0.3)];
    for kinds in KINDS {
        let a = body(kinds[0], &sheet, 0.012, 0.001, 1);
        let b = body(kinds[1], &blade, 0.008, 0.001, 2);
        for end in &ends {
            assert!(probability(&a, &b, end) < 0.1, "{kinds:?}");
        }
        let path = Path::linear(&ends[0], &ends[1]).expect("two poses");
        let swept = sweep(&a, &b, &path, 0.01);
        assert_eq!(swept.verdict, Verdict::InCollision, "{kinds:?}");
        let first = swept.first.expect("it passes");
        // Its lower edge is at the sheet after 25 of 60 cm, all of it after 35 and a half.
        assert!((0.40..0.47).contains(&first.at.share), "{kinds:?} {}", first.at.share);
        assert!(first.not_before < first.at.share && first.not_before > 0.38, "{kinds:?}");
        // What is open before it is bounded as one: no less is known of where it begins.
        assert!(first.at.share - first.not_before < 0.01, "{kinds:?} {first:?}");
        assert!((0.35..0.42).contains(&swept.certified_free_until), "{kinds:?}");
        assert!(!first.at.report.contacts.is_empty() || kinds == [true, true]);
    }
}

#[test]
fn a_rod_moved_past_a_corner_touches_it_on_the_way() {
    let (block, rod) = (scene::cuboid([0.3; 3]), scene::cuboid([0.01, 0.5, 0.01]));
    // Beside one face, then beside the next, with the corner between.
    for kinds in KINDS {
        let a = body(kinds[0], &block, 0.012, 0.001, 3);
        let b = body(kinds[1], &rod, 0.006, 0.001, 4);
        let past = |off: f64| {
            let far = 0.15 + off + 0.05;
            let ends = [at(far, 0.0, 0.1 + off), at(0.1 + off, 0.0, far)];
            for end in &ends {
                assert!(probability(&a, &b, end) < 0.1, "{kinds:?} {off}");
            }
            sweep(&a, &b, &Path::linear(&ends[0], &ends[1]).expect("two poses"), 0.01)
        };
        let (through, clear) = (past(-0.01), past(0.06));
        assert_eq!(through.verdict, Verdict::InCollision, "{kinds:?}");
        let share = through.first.expect("it touches").at.share;
        assert!((0.2..0.6).contains(&share), "{kinds:?} {share}");
        assert_eq!(clear.verdict, Verdict::Free, "{kinds:?} {:?}", clear.bounds);
        assert_eq!(clear.certified_free_until, 1.0);
    }
}

#[test]
fn a_turn_about_a_far_axis_is_followed_along_its_arc() {
    let (post, object) = (scene::cuboid([0.04, 0.04, 0.3]), scene::cuboid([0.06; 3]));
    // Both ends are 2 m from the axis, a quarter of a turn apart; the post is on the arc between them,
    // far from the straight line.
    let arm = |angle: f64| {
        let turn = Pose::from_translation_rpy(Vector3::zeros(), [0.0, 0.0, angle]);
        Pose::from_translation(Vector3::new(-2.0, 0.0, 0.0))
            .after(&turn)
            .after(&Pose::from_translation(Vector3::new(2.0, 0.0, 0.0)))
    };
    let ends = [arm(-0.785), arm(0.785)];
    for kinds in KINDS {
        let a = body(kinds[0], &post, 0.01, 0.001, 5);
        let b = body(kinds[1], &object, 0.01, 0.001, 6);
        let screw = Path::screw(&ends[0], &ends[1]).expect("two poses");
        let swept = sweep(&a, &b, &screw, 0.005);
        let share = swept.first.expect("it meets the post").at.share;
        // Half the sum of the sizes, about 6 cm, before the middle of 3.1 m.
        assert!((0.46..0.5).contains(&share), "{kinds:?} {share}");
        let line = Path::linear(&ends[0], &ends[1]).expect("two poses");
        assert_eq!(sweep(&a, &b, &line, 0.005).verdict, Verdict::Free, "{kinds:?}");
    }
}

#[test]
fn a_path_through_poses_says_in_which_segment() {
    let table = body(false, &scene::cuboid([0.4, 0.4, 0.02]), 0.012, 0.001, 7);
    let cup = body(false, &scene::sphere(0.04, 2), 0.008, 0.001, 8);
    let poses = [at(0.0, 0.0, 0.2), at(0.1, 0.0, 0.2), at(0.1, 0.0, 0.2), at(0.1, 0.0, 0.0)];
    let path = Path::through(&poses).expect("four poses");
    let swept = sweep(&table, &cup, &path, 0.002);
    let first = swept.first.expect("into the table").at;
    assert_eq!((path.segments(), first.segment), (3, 2));
    assert!((first.share - (2.0 + first.t) / 3.0).abs() < 1e-12);
    // Its lower end is at the upper side of the table after 15 of 20 cm.
    assert!((0.73..0.85).contains(&first.t), "{}", first.t);
    assert_eq!(path.pose(first.share), first.pose);
    assert!((0.85..0.93).contains(&swept.certified_free_until), "{}", swept.certified_free_until);
}

/// An arm reaches into a closed box, or flies inside of it: never free.
/// Halving stretches never comes by where two of them meet: a pose that alone was in collision made a path uncertain.
#[test]
fn the_poses_of_a_path_were_not_asked_about() {
    let floor = body(false, &scene::plane_patch(0.4), 0.012, 0.001, 1);
    let ball = body(true, &scene::sphere(0.05, 3), 0.008, 0.001, 2);
    let mut collisions = 0;
    for depth in 0..12 {
        let low = at(0.01, 0.0, 0.056 - 0.001 * f64::from(depth));
        let ends = [at(-0.1, 0.0, 0.3), at(0.13, 0.0, 0.3)];
        let alone = query().run(&floor, &ball, &low).expect("a good pose");
        let path = Path::through(&[ends[0], low, ends[1]]).expect("three poses");
        let swept = sweep(&floor, &ball, &path, 0.01);
        if alone.verdict != Verdict::Free {
            assert!(swept.bounds[0] >= alone.bounds[0], "{depth}: {swept:?}");
        }
        if alone.verdict == Verdict::InCollision {
            collisions += 1;
            assert_eq!(swept.verdict, Verdict::InCollision, "{depth}: {swept:?}");
        }
    }
    assert!(collisions > 2, "{collisions}");
}

#[test]
fn what_is_inside_a_closed_mesh_all_the_way_collides_all_the_way() {
    let ball = scene::sphere(0.03, 2);
    let hall = Body::from(Mesh::prepare(&scene::cuboid([0.6; 3])).expect("a mesh"));
    for is_mesh in [false, true] {
        let object = body(is_mesh, &ball, 0.01, 0.001, 9);
        let path = Path::linear(&at(-0.1, 0.0, 0.0), &at(0.1, 0.0, 0.0)).expect("two poses");
        for (a, b) in [(&hall, &object), (&object, &hall)] {
            let swept = sweep(a, b, &path, 0.01);
            assert_eq!(swept.first.expect("inside").at.share, 0.0);
            assert_eq!(swept.certified_free_until, 0.0);
        }
    }
}

#[test]
fn a_doubt_about_any_pose_keeps_the_path_from_being_free() {
    // A small cloud flies into a large hollow one through its wall where there is a door: inside,
    // nobody knows whether it is hollow.
    let room = cloud(&scene::sphere(0.5, 3), 0.03, 0.001, 10);
    let object = cloud(&scene::sphere(0.03, 2), 0.01, 0.001, 11);
    let path = Path::linear(&at(0.0, 0.0, 0.0), &at(0.1, 0.0, 0.0)).expect("two poses");
    let swept = sweep(&room, &object, &path, 0.01);
    assert_eq!(swept.verdict, Verdict::Undecided);
    assert_eq!((swept.certified_free_until, swept.bounds[1]), (0.0, 1.0));
}

/// What the samples of a path say against its bounds; how many stretches were bounded.
fn check_random_motion(index: u64, samples: u32) -> usize {
    let draw = |axis: u64| seed::unit(seed::derive(21, index, axis));
    let shapes = [scene::cuboid([0.1, 0.08, 0.05]), scene::sphere(0.05, 2), scene::peg(0.02, 0.12)];
    let kinds = KINDS[(index % 4) as usize];
    // Meshes are exact, and leave nothing to noise.
    let of = |which: usize, axis: u64| {
        let shape = &shapes[(3.0 * draw(axis)) as usize];
        let std = 10.0_f64.powf(-3.3 + 1.0 * draw(axis + 1));
        body(kinds[which], shape, 0.012 + 0.012 * draw(axis + 2), std, index + axis)
    };
    let (a, b) = (of(0, 100), of(1, 200));
    let centred = |axis: u64, size: f64| size * (2.0 * draw(axis) - 1.0);
    let pose = |axis: u64, size: f64, turn: f64| {
        let offset = [0, 1, 2].map(|k| centred(axis + k, size));
        let rpy = [3, 4, 5].map(|k| centred(axis + k, turn));
        Pose::from_translation_rpy(Vector3::from(offset), rpy)
    };
    let from = pose(1, 0.12, 3.0);
    let step = 0.08 * draw(30);
    let to = pose(11, step, 2.0 * draw(31)).after(&from);
    let path = match draw(32) < 0.5 {
        true => Path::linear(&from, &to),
        false => Path::screw(&from, &to),
    };
    let path = path.expect("two poses");
    // Coarse ones leave the bounds of long stretches.
    let tolerance = [0.6, 0.3, 0.1, 0.02][(4.0 * draw(33)) as usize];
    let swept = sweep(&a, &b, &path, tolerance);
    let [low, high] = swept.bounds;
    let mut largest: f64 = 0.0;
    for i in 0..=samples {
        let share = f64::from(i) / f64::from(samples);
        let sampled = probability(&a, &b, &path.pose(share));
        assert!(sampled <= high, "{index} {kinds:?} at {share}: {sampled} above {high}");
        if share < swept.certified_free_until {
            assert!(sampled < 0.1, "{index} at {share}: {sampled} was certified as free");
        }
        if swept.first.as_ref().is_none_or(|first| share < first.not_before) {
            assert!(sampled <= 0.9 || swept.first.is_none() && high > 0.9, "{index} at {share}");
        }
        largest = largest.max(sampled);
    }
    let best = &swept.most_probable;
    assert_eq!(probability(&a, &b, &best.pose), best.report.collision_probability);
    assert!(low <= best.report.collision_probability && low <= high, "{index}");
    assert!(best.report.collision_probability <= largest + 0.15, "{index}: {low} and {largest}");
    if let Some(first) = &swept.first {
        assert!(first.at.report.collision_probability > 0.9);
        assert!(first.not_before <= first.at.share);
        assert!(swept.certified_free_until <= first.at.share);
    }
    // Asked for no more it says no less of whether the path is free.
    for detail in [Detail::Free, Detail::Verdict] {
        let only = QuerySettings { detail, ..QuerySettings::default() };
        let only = Query::new(only).expect("good settings");
        let only = only.sweep(&a, &b, &path, tolerance).expect("a good path");
        let are_free = [only.verdict, swept.verdict].map(|verdict| verdict == Verdict::Free);
        assert_eq!(are_free[0], are_free[1], "{index} {kinds:?} {detail:?}");
    }
    swept.stats.stretches
}

/// Of a path through a sheet three poses tell that it is not free; bounds for all that is between them took a
/// hundred times as long.
#[test]
fn a_sweep_that_is_asked_for_the_verdict_alone_ends_with_the_first_pose_that_is_not_free() {
    let sheet = cloud(&scene::cuboid([0.4, 0.4, 0.004]), 0.012, 0.001, 1);
    let block = cloud(&scene::cuboid([0.1, 0.1, 0.1]), 0.012, 0.001, 2);
    let path = Path::linear(&at(0.0, 0.0, 0.3), &at(0.0, 0.0, -0.3)).expect("two poses");
    let settings = QuerySettings { detail: Detail::Verdict, ..QuerySettings::default() };
    let swept = Query::new(settings).expect("good settings").sweep(&sheet, &block, &path, 0.01);
    let swept = swept.expect("a good path");
    assert_eq!(swept.verdict, Verdict::InCollision);
    // Both ends and the middle.
    assert_eq!((swept.stats.poses, swept.stats.stretches), (3, 0));
    assert_eq!((swept.certified_free_until, swept.bounds[1]), (0.0, 1.0));
    assert!(swept.first.is_some_and(|first| first.at.share == 0.5 && first.not_before == 0.0));
}

/// Seventeen of its poses were asked about before one bound told that it is free.
#[test]
fn the_verdict_on_a_path_that_keeps_clear_takes_its_ends_its_middle_and_one_bound() {
    let sheet = cloud(&scene::cuboid([0.4, 0.4, 0.004]), 0.012, 0.001, 1);
    let block = cloud(&scene::cuboid([0.1, 0.1, 0.1]), 0.012, 0.001, 2);
    let path = Path::linear(&at(-0.1, 0.0, 0.3), &at(0.1, 0.0, 0.3)).expect("two poses");
    let settings = QuerySettings { detail: Detail::Verdict, ..QuerySettings::default() };
    let swept = Query::new(settings).expect("good settings").sweep(&sheet, &block, &path, 0.01);
    let swept = swept.expect("a good path");
    assert_eq!((swept.verdict, swept.certified_free_until), (Verdict::Free, 1.0));
    assert_eq!((swept.stats.poses, swept.stats.stretches), (3, 1));
}

/// 200 of them here; 10,000 with
/// `cargo test -p cloudtouch --test suite motion::ten_thousand -- --ignored`.
#[test]
fn no_sample_of_a_random_motion_exceeds_the_bounds() {
    for index in 0..200 {
        check_random_motion(index, 24);
    }
}

#[test]
#[ignore = "takes minutes"]
fn ten_thousand_random_motions_keep_to_their_bounds() {
    for index in 0..10_000 {
        check_random_motion(index, 48);
    }
}

/// With more segments than the tolerance goes into the path none was looked at closer, and no pose asked about.
#[test]
fn a_path_of_many_poses_through_a_wall_collides_as_one_of_few() {
    let wall = body(false, &scene::plane_patch(1.0), 0.01, 0.001, 1);
    let cube = body(true, &scene::cuboid([0.1; 3]), 0.0, 0.0, 0);
    for count in [50_u32, 101, 300] {
        let height = |k: u32| 0.3 - 0.6 * f64::from(k) / f64::from(count - 1);
        let poses: Vec<Pose> = (0..count).map(|k| at(0.0, 0.0, height(k))).collect();
        let path = Path::through(&poses).expect("a path");
        let swept = sweep(&wall, &cube, &path, 0.01);
        assert_eq!(swept.verdict, Verdict::InCollision, "{count}: {swept:?}");
        let first = swept.first.expect("a collision").at.share;
        assert!((0.35..0.45).contains(&first) && swept.stats.poses < 20, "{count}: {first}");
    }
}

#[test]
fn bad_paths_and_tolerances_are_refused_by_value() {
    let here = Pose::identity();
    let there = at(0.1, 0.0, 0.0);
    let unknown = at(f64::NAN, 0.0, 0.0);
    let errors = [
        (Path::through(&[]).unwrap_err(), "a path through no pose: give at least two"),
        (Path::through(&[here]).unwrap_err(), "a path through one pose"),
        (Path::linear(&here, &here).unwrap_err(), "all 2 poses of the path are the same"),
        (Path::screw(&here, &here).unwrap_err(), "all 2 poses"),
        (Path::through(&[here, there, unknown]).unwrap_err(), "pose 3 of the path contains NaN"),
        (Path::linear(&at(0.0, 2e10, 0.0), &here).unwrap_err(), "pose 1 of the path contains 2e10"),
    ];
    for (error, part) in errors {
        assert!(error.to_string().starts_with(part), "{error}");
    }
    let error = Path::through(&[here, unknown]).unwrap_err();
    assert!(matches!(error, QueryError::PathPose { index: 1, .. }), "an index from 0: {error:?}");
    let a = body(true, &scene::cuboid([0.1; 3]), 0.0, 0.0, 1);
    let path = Path::linear(&here, &there).expect("two poses");
    // Of 1e-9, a path near contact was cut into pieces without end.
    for value in [0.0, 1e-9, 1.01, -0.1, f64::NAN, f64::INFINITY] {
        let error = query().sweep(&a, &a, &path, value).unwrap_err();
        assert!(matches!(error, QueryError::Tolerance { .. }), "{error}");
        assert!(error.to_string().contains("give a share of the path"), "{error}");
    }
}

#[test]
fn answers_are_the_same_bits_on_any_number_of_threads() {
    let a = body(false, &scene::cuboid([0.3, 0.3, 0.02]), 0.012, 0.002, 12);
    let b = body(false, &scene::sphere(0.05, 2), 0.008, 0.002, 13);
    let path = Path::linear(&at(0.0, 0.0, 0.15), &at(0.1, 0.0, 0.0)).expect("two poses");
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let swept = pool.install(|| sweep(&a, &b, &path, 0.01));
        let first = swept.first.expect("into the sheet");
        (swept.bounds.map(f64::to_bits), first.at.share.to_bits(), swept.stats.leaf_pairs)
    };
    assert_eq!(of(1), of(4));
}
