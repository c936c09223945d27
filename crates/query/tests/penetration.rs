//! How far an object has to move to be out of a collision.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Penetration, Query, QueryError, QuerySettings};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};

const SIZE: f64 = 0.2;
/// Two spacings of the samples below, m: so near to each other surfaces are still likelier than a tenth to
/// meet between their samples.
const SPACINGS: f64 = 0.016;

fn body(mesh: &TriangleMesh, is_mesh: bool, std: f64, seed: u64) -> Body {
    if is_mesh {
        return Body::from(Mesh::prepare(mesh).unwrap());
    }
    let samples = surface::positions(&surface::sample_surface(mesh, 4000, seed));
    let points: Vec<Point3> = add_noise(&samples, NoiseKind::Gaussian, std, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    Body::Cloud(Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap())
}

fn query() -> Query {
    Query::new(QuerySettings::default()).unwrap()
}

fn out_of(kinds: [bool; 2], pose: &Pose, probability: f64) -> Penetration {
    out_of_draw(0, kinds, pose, probability)
}

fn out_of_draw(draw: u64, kinds: [bool; 2], pose: &Pose, probability: f64) -> Penetration {
    let cube = scene::cuboid([SIZE; 3]);
    let seeds = [2 * draw + 1, 2 * draw + 2];
    let (a, b) = (body(&cube, kinds[0], 0.002, seeds[0]), body(&cube, kinds[1], 0.002, seeds[1]));
    let (report, out) = query().penetration(&a, &b, pose, probability).unwrap();
    assert!(report.collision_probability > 0.5);
    let out = out.unwrap();
    let there = Pose::from_translation(out.direction * out.distance_m).after(pose);
    let freed = query().run(&a, &b, &there).unwrap();
    assert!(freed.bounds[1] < probability, "{out:?} {:?}", freed.bounds);
    out
}

const KINDS: [[bool; 2]; 4] = [[false, false], [false, true], [true, false], [true, true]];

#[test]
fn a_box_in_a_box_leaves_across_the_nearest_face_and_is_free_there() {
    // Turned about the way out, so that no axis of either is the only one to tell it.
    let turned = |offset| Pose::from_translation_rpy(offset, [0.0, 0.0, 0.4]);
    for kinds in KINDS {
        for depth in [0.02, 0.05] {
            let pose = turned(Vector3::new(0.02, -0.01, depth - SIZE));
            let mut upward: Vec<f64> = (0..11)
                .map(|draw| {
                    let out = out_of_draw(draw, kinds, &pose, 0.1);
                    let error = out.distance_m - depth;
                    let most = if kinds == [true, true] { 0.001 } else { SPACINGS };
                    assert!((-0.001..most).contains(&error), "{kinds:?} {depth} {out:?}");
                    assert!((out.depth_m - depth).abs() < 0.5 * most, "{kinds:?} {depth} {out:?}");
                    assert!((0.0..0.01).contains(&out.std_m), "{kinds:?} {out:?}");
                    assert_eq!(out.std_m == 0.0, kinds == [true, true], "{kinds:?} {out:?}");
                    -out.direction.z
                })
                .collect();
            upward.sort_by(f64::total_cmp);
            // Mostly within 18 degrees: near an edge of the boxes a way aside of the normal is likely enough out a
            // little sooner, by less than the samples tell.
            assert!(upward[5] > 0.95 && upward[0] > 0.77, "{kinds:?} {depth} {upward:?}");
        }
    }
}

#[test]
fn to_be_out_more_likely_takes_no_less() {
    let pose = Pose::from_translation(Vector3::new(0.01, 0.02, 0.03 - SIZE));
    let of = |probability| out_of([false, false], &pose, probability).distance_m;
    assert!(of(0.02) >= of(0.1) && of(0.1) >= of(0.4));
}

/// It was told along the way that is shortest until a collision is less likely than a tenth.
#[test]
fn the_depth_is_that_of_its_own_shortest_way() {
    let cube = scene::cuboid([SIZE; 3]);
    // About as deep across two faces.
    for (seed, deeper) in (1..=6).zip([0.0, 0.002, -0.002, 0.004, -0.004, 0.006]) {
        let (a, b) = (body(&cube, false, 0.01, seed), body(&cube, false, 0.01, !seed));
        let offset = Vector3::new(0.05 + deeper - SIZE, 0.01, 0.05 - SIZE);
        let pose = Pose::from_translation(offset);
        let (_, out) = query().penetration(&a, &b, &pose, 0.1).unwrap();
        let depth = out.unwrap().depth_m;
        for direction in [-Vector3::x(), -Vector3::z()] {
            let nearer = Pose::from_translation(direction * (0.95 * depth)).after(&pose);
            let probability = query().run(&a, &b, &nearer).unwrap().collision_probability;
            assert!(probability > 0.5, "{seed} {direction}: {probability} at {depth}");
        }
    }
}

/// It was .62 m, along another way, though the depth had been sought along this one and was .50 m.
#[test]
fn the_way_that_the_depth_is_along_was_not_told_where_it_is_out_sooner() {
    let piano = body(&scene::piano(), true, 0.0, 0);
    let pose = Pose::from_translation(Vector3::new(0.0, 0.0, 0.5));
    let (_, out) = query().penetration(&piano, &piano, &pose, 0.1).unwrap();
    let out = out.unwrap();
    // Exact bodies are out where they are no longer in, as far as ways are told: to a hundredth.
    assert!(out.distance_m < 1.03 * out.depth_m, "{out:?}");
    let there = Pose::from_translation(out.direction * out.distance_m).after(&pose);
    let freed = query().run(&piano, &piano, &there).unwrap();
    assert_eq!(freed.collision_probability, 0.0, "{out:?}");
}

/// It read as in by .1 mm, the finest that ways are told to.
#[test]
fn what_is_likelier_out_than_in_is_in_by_nothing() {
    let cube = scene::cuboid([SIZE; 3]);
    let (a, b) = (body(&cube, false, 0.002, 1), body(&cube, false, 0.002, 2));
    let aside =
        (0..20).map(|k| Pose::from_translation(Vector3::x() * (SIZE + 0.001 * f64::from(k))));
    let is_doubtful = |pose: &Pose| {
        let probability = query().run(&a, &b, pose).unwrap().collision_probability;
        0.1 < probability && probability < 0.5
    };
    let pose = aside.into_iter().find(is_doubtful).unwrap();
    let (_, out) = query().penetration(&a, &b, &pose, 0.1).unwrap();
    let out = out.unwrap();
    assert!(out.depth_m == 0.0 && out.distance_m > 0.0, "{out:?}");
}

#[test]
fn what_is_out_need_not_move() {
    let cube = scene::cuboid([SIZE; 3]);
    let (a, b) = (body(&cube, false, 0.002, 1), body(&cube, true, 0.0, 2));
    let away = Pose::from_translation(Vector3::new(0.0, 0.0, 2.0 * SIZE));
    let (_, out) = query().penetration(&a, &b, &away, 0.1).unwrap();
    let out = out.unwrap();
    assert_eq!(out.direction, Vector3::zeros());
    assert_eq!([out.distance_m, out.depth_m, out.std_m], [0.0; 3]);
}

#[test]
fn no_probability_is_out_of_its_range() {
    let cube = body(&scene::cuboid([SIZE; 3]), true, 0.0, 1);
    for value in [0.0, 1.0, -0.1, f64::NAN] {
        let error = query().penetration(&cube, &cube, &Pose::identity(), value).unwrap_err();
        assert!(matches!(error, QueryError::Probability { .. }), "{error}");
        assert!(error.to_string().contains("give a number between 0 and 1"), "{error}");
    }
    let pose = Pose::from_translation(Vector3::new(f64::NAN, 0.0, 0.0));
    assert!(matches!(query().penetration(&cube, &cube, &pose, 0.1), Err(QueryError::Pose { .. })));
}
