//! A query that runs out of time tells the bounds it has reached, and nothing reads as free.

use std::time::Duration;

use crate::common::{AnyQuery, Asked, MODES, assert_sound, at, measured, mesh, scan};
use cloudtouch::geom::{PointCloud, Pose};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Mode, Path, PoseDistribution, Query, QuerySettings, Report, Scene,
    SweepStats, Undecided, Verdict,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

#[test]
fn without_time_nothing_is_free_and_the_bounds_hold_the_answer() {
    for mode in MODES {
        let floor = scan(&scene::plane_patch(0.4), 0.015, 0.002, 1, mode);
        let ball = scan(&scene::sphere(0.1, 3), 0.012, 0.002, 2, mode);
        let (solid, open) = (mesh(&scene::sphere(0.1, 3)), mesh(&scene::plane_patch(0.4)));
        let pairs: [(Asked<'_>, Asked<'_>); 3] = [
            ((&floor).into(), (&ball).into()),
            ((&floor).into(), (&solid).into()),
            ((&open).into(), (&ball).into()),
        ];
        for (a, b) in pairs {
            let ask = |deadline| {
                let query =
                    AnyQuery::with(mode, |s| s.deadline = deadline, |s| s.deadline = deadline);
                // 1 cm of overlap, where there is something to look at.
                let report = query.run(a, b, &at(0.0, 0.0, 0.09)).expect("a good pose");
                assert_sound(&report);
                report
            };
            let (whole, hasty) = (ask(None), ask(Some(Duration::ZERO)));
            assert_ne!(hasty.verdict, Verdict::Free, "{mode:?}");
            let [lower, upper] = hasty.bounds;
            let p = whole.collision_probability;
            if mode == Mode::Calibrated {
                assert!(
                    lower <= p + 1e-3 && p <= upper + 1e-3,
                    "{p} outside of {:?}",
                    hasty.bounds
                );
            }
            assert!(hasty.stats.leaf_pairs <= whole.stats.leaf_pairs);
            // Time enough changes nothing.
            assert_eq!(ask(Some(Duration::from_secs(600))).collision_probability, p);
        }
    }
}

/// What the camera did not see was still looked for, of each of thousands of poses, and a path was bounded.
#[test]
fn after_the_deadline_every_pose_still_cost_a_look_at_the_doubts() {
    let table = ExactMesh::new(&scene::moved(&scene::plane_patch(2.0), &at(0.0, 0.0, 1.5)));
    let image = DepthCamera::default().scan(&[&table], &Pose::identity(), 1);
    let settings = CloudSettings::new(SensorModel::Kinect);
    let cloud = Cloud::prepare(&image, &settings).expect("a good cloud");
    let hand = mesh(&scene::cuboid([0.1, 0.08, 0.15]));
    let settings = QuerySettings { deadline: Some(Duration::ZERO), ..QuerySettings::default() };
    let query = Query::new(settings).expect("good settings").begun_now();
    // Before the table, through it, and behind it where nothing was seen.
    let poses: Vec<Pose> = (0..40).map(|k| at(0.0, 0.0, 1.0 + 0.02 * f64::from(k))).collect();
    let is_open = |report: &Report| {
        assert_sound(report);
        assert_eq!(report.undecided_by, Some(Undecided::Bounds), "{report:?}");
        assert_eq!(report.bounds[1], 1.0);
        assert_eq!((report.unseen, report.warnings.len()), (None, 0), "{report:?}");
        assert!(report.contacts.is_empty() && report.clearance_at_least_m.is_none());
        assert_eq!((report.stats.nodes_visited, report.stats.leaf_pairs), (0, 0));
    };
    for report in query.run_batch(&cloud, &hand, &poses) {
        is_open(&report.expect("a good pose"));
    }
    // Two meshes too, which cross.
    is_open(&query.run(&hand, &hand, &at(0.01, 0.0, 0.0)).expect("a good pose"));
    is_open(&query.gradient(&cloud, &hand, &poses[9]).expect("a good pose").0);
    let path = Path::through(&poses).expect("a good path");
    let swept = query.sweep(&cloud, &hand, &path, 0.01).expect("a good path");
    assert_eq!((swept.verdict, swept.bounds[1]), (Verdict::Undecided, 1.0));
    let SweepStats { poses, stretches, nodes_visited, .. } = swept.stats;
    assert_eq!((poses, stretches, nodes_visited), (1, 0, 0));
    let mut scene = Scene::default();
    scene.add("cloud", cloud, Pose::identity()).expect("a new name");
    scene.add("hand", hand, at(0.0, 0.0, 1.9)).expect("a new name");
    let checked = scene.check(&query);
    assert_eq!(checked.pairs.len(), 1);
    is_open(checked.pairs[0].answer.as_ref().expect("a good pose"));
}

/// Each of some three hundred queries had a deadline of its own.
#[test]
fn a_way_out_and_uncertain_poses_had_the_time_of_all_their_queries() {
    let settings = QuerySettings { deadline: Some(Duration::ZERO), ..QuerySettings::default() };
    let query = Query::new(settings).expect("good settings");
    let usual = Query::new(QuerySettings::default()).expect("good settings");
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let floor = measured(&scene::plane_patch(0.4), 0.015, 0.002, 1);
    let floor = Cloud::prepare(&PointCloud::from_points(floor), &settings).expect("a good cloud");
    let ball = mesh(&scene::sphere(0.1, 3));
    let into = at(0.0, 0.0, 0.09);
    let (report, out) = query.penetration(&floor, &ball, &into, 0.1).expect("a good pose");
    assert_sound(&report);
    assert_eq!(out, None);
    assert!(usual.penetration(&floor, &ball, &into, 0.1).expect("a good pose").1.is_some());
    let poses = PoseDistribution::from_std(into, [0.005; 6]);
    let (_, hasty) = query.run_uncertain(&floor, &ball, &poses).expect("a good pose");
    let (_, whole) = usual.run_uncertain(&floor, &ball, &poses).expect("a good pose");
    assert!(
        hasty.bounds[0] <= whole.probability && whole.probability <= hasty.bounds[1],
        "{hasty:?}"
    );
    assert!(hasty.bounds[1] > 0.99, "{hasty:?}");
}
