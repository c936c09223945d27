//! A refined cloud answers as the same cloud does that computes its surface where it is asked.

use crate::common::{measured, mesh};
use cloudtouch::geom::{PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Verdict};
use cloudtouch_testkit::scene;
use proptest::prelude::*;

/// Above this a search ends, with as much as it has found by then.
const ENOUGH: f64 = 0.999;

fn are_same(p: f64, q: f64) -> bool {
    (p - q).abs() < 1e-6 || p.min(q) > ENOUGH
}

fn pair(spacing: f64, std: f64) -> [Cloud; 2] {
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    let scan = |mesh: &TriangleMesh, seed| {
        let points = PointCloud::from_points(measured(mesh, spacing, std, seed));
        Cloud::prepare(&points, &settings).expect("a good cloud")
    };
    [scan(&scene::plane_patch(0.2), 1), scan(&scene::sphere(0.05, 3), 2)]
}

fn refined(clouds: [Cloud; 2]) -> [Cloud; 2] {
    clouds.map(|cloud| cloud.refined().expect("an ordinary cloud"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn refining_changes_no_answer(
        spacing in 0.008..0.03_f64,
        std in prop_oneof![Just(0.0), 0.0005..0.01_f64],
        place in prop::array::uniform2(-0.1..0.1_f64),
        gap in -0.03..0.06_f64,
        rpy in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        let offset = Vector3::new(place[0], place[1], 0.05 + gap);
        let pose = Pose::from_translation_rpy(offset, rpy);
        let query = Query::new(QuerySettings::default()).unwrap();
        let clouds = pair(spacing, std);
        let lazy = query.run(&clouds[0], &clouds[1], &pose).unwrap();
        let clouds = refined(clouds);
        let eager = query.run(&clouds[0], &clouds[1], &pose).unwrap();
        let [p, q] = [&lazy, &eager].map(|report| report.collision_probability);
        prop_assert!(are_same(p, q), "{lazy:?}\n{eager:?}");
        prop_assert_eq!(lazy.verdict, eager.verdict);
        prop_assert_eq!(eager.stats.leaves_prepared, 0, "nothing was left to compute");
    }
}

#[test]
fn refining_twice_is_refining_once() {
    let query = Query::new(QuerySettings::default()).expect("default settings");
    let pose = Pose::from_translation(Vector3::new(0.0, 0.0, 0.055));
    let [once, twice] = [refined(pair(0.01, 0.002)), refined(refined(pair(0.01, 0.002)))]
        .map(|[a, b]| query.run(&a, &b, &pose).expect("finite poses").collision_probability);
    assert_eq!(once, twice);
}

#[test]
fn refined_clouds_meet_meshes_as_before() {
    let query = Query::new(QuerySettings::default()).unwrap();
    let ball = mesh(&scene::sphere(0.05, 3));
    for (gap, verdict) in [(0.03, Verdict::Free), (-0.02, Verdict::InCollision)] {
        let pose = Pose::from_translation(Vector3::new(0.01, 0.02, 0.05 + gap));
        let [floor, _] = pair(0.01, 0.001);
        let lazy = query.run(&floor, &ball, &pose).unwrap();
        let eager = query.run(&floor.refined().unwrap(), &ball, &pose).unwrap();
        assert_eq!((lazy.verdict, eager.verdict), (verdict, verdict));
        assert!(are_same(lazy.collision_probability, eager.collision_probability));
    }
}
