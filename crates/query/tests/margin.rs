//! How likely two bodies are within a margin of each other.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Query, QueryError, QuerySettings};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};
use proptest::prelude::*;

fn cloud(mesh: &TriangleMesh, count: usize, std: f64, seed: u64) -> Body {
    let samples = surface::positions(&surface::sample_surface(mesh, count, seed));
    let points: Vec<Point3> = add_noise(&samples, NoiseKind::Gaussian, std, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    Body::Cloud(Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap())
}

fn box_mesh() -> TriangleMesh {
    scene::cuboid([0.2; 3])
}

/// A cloud or a mesh of the same box.
fn body(is_mesh: bool, count: usize, std: f64, seed: u64) -> Body {
    match is_mesh {
        true => Body::from(Mesh::prepare(&box_mesh()).unwrap()),
        false => cloud(&box_mesh(), count, std, seed),
    }
}

/// The way to a far corner of a large triangle, which is nearer in deviations, counted as the way to it: a ball
/// 20 mm from a box of 12 triangles was told to be 55 mm from it at least.
#[test]
fn a_box_of_few_triangles_is_as_near_as_one_of_many() {
    let box_mesh = scene::cuboid([0.15, 0.1, 0.2]);
    let meshes = [box_mesh.clone(), scene::subdivide_to_max_edge(&box_mesh, 0.01)]
        .map(|mesh| Mesh::prepare(&mesh).unwrap());
    let query = Query::new(QuerySettings::default()).unwrap();
    for (count, std) in [(1000, 0.0), (3000, 0.0005)] {
        let ball = cloud(&scene::sphere(0.1, 3), count, std, 7);
        let turned = Pose::from_translation_rpy(Vector3::new(0.19, 0.15, 0.08), [0.5, 0.6, 0.7]);
        for pose in [Pose::from_translation(Vector3::new(0.195, 0.0, 0.0)), turned] {
            let of = |mesh: &Mesh| query.clearance_interval(&ball, mesh, &pose, 0.9).unwrap();
            let [few, many] = [of(&meshes[0]), of(&meshes[1])];
            for (few, many) in few.into_iter().zip(many) {
                assert!((few - many).abs() < 0.002, "{count}: {few} and {many}");
            }
        }
    }
}

/// The pieces likeliest to meet were far aside of one another, and told a piano 7 mm over the floor to be 51 mm
/// from it, though margins knew better.
#[test]
fn a_clearance_does_not_contradict_the_margins() {
    let query = Query::new(QuerySettings::default()).unwrap();
    let piano = Body::from(Mesh::prepare(&scene::piano()).unwrap());
    let mut told = 0;
    for seed in 1..4 {
        let samples = surface::positions(&surface::sample_surface(&scene::room(), 30_000, seed));
        let points = add_noise(&samples, NoiseKind::Gaussian, 0.002, seed);
        let sensor = SensorModel::Lidar { range_std: 0.02, beam_rad: 0.003 };
        let settings = CloudSettings::new(sensor);
        let room = Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap();
        for gap in [0.004, 0.007, 0.008, 0.009, 0.01, 0.02] {
            let pose = Pose::from_translation(Vector3::new(0.0, 0.0, gap));
            let (report, _, [_, high]) = query.nearness(&room, &piano, &pose, gap, 0.98).unwrap();
            let Some(clearance) = report.clearance_m else { continue };
            told += 1;
            let least = clearance.mean - 3.0 * clearance.std;
            assert!(least < high, "{gap}: {clearance:?}, nearer than {high}");
        }
    }
    assert!(told > 3, "{told}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(40) })]

    #[test]
    fn a_larger_margin_is_never_less_likely_and_none_is_the_collision(
        kinds in any::<[bool; 2]>(),
        std in 0.0005_f64..0.01,
        offset in prop::array::uniform3(-0.3..0.3_f64),
        turn in -3.0..3.0_f64,
        margins in prop::array::uniform3(0.0..0.3_f64),
        seed in any::<u64>(),
    ) {
        let (a, b) = (body(kinds[0], 1000, std, seed), body(kinds[1], 1000, std, !seed));
        let pose = Pose::from_translation_rpy(Vector3::from(offset), [turn, 0.2, 0.0]);
        let query = Query::new(QuerySettings::default()).unwrap();
        let (report, none) = query.within(&a, &b, &pose, 0.0).unwrap();
        prop_assert_eq!(none.probability.to_bits(), report.collision_probability.to_bits());
        prop_assert_eq!(none.bounds, report.bounds);
        let mut margins = margins;
        margins.sort_by(f64::total_cmp);
        let mut known = none;
        for margin in margins {
            let (_, within) = query.within(&a, &b, &pose, margin).unwrap();
            let [low, high] = within.bounds;
            prop_assert!(low <= within.probability && within.probability <= high, "{within:?}");
            prop_assert!(within.probability >= known.probability, "{known:?} {within:?}");
            known = within;
        }
    }
}

/// Half a spacing of the samples below, m: of many pieces that face each other the least apart are nearer
/// than the surfaces by a part of that.
const ENDS: f64 = 0.0032;

/// Three spacings of the samples below, m: where a surface ends is known to about one.
const SPACINGS: f64 = 0.019;

#[test]
fn a_gap_is_within_margins_that_are_clearly_wider_and_not_within_narrower_ones() {
    let query = Query::new(QuerySettings::default()).unwrap();
    for kinds in [[false, false], [false, true], [true, false], [true, true]] {
        let (a, b) = (body(kinds[0], 6000, 0.001, 1), body(kinds[1], 6000, 0.001, 2));
        for gap in [0.03, 0.06, 0.1] {
            let pose = Pose::from_translation(Vector3::new(0.01, -0.02, 0.2 + gap));
            let of = |margin: f64| query.within(&a, &b, &pose, margin).unwrap().1.probability;
            let (narrower, wider) = (of(gap - SPACINGS), of(gap + SPACINGS));
            assert!(narrower < 0.1 && wider > 0.9, "{kinds:?} {gap}: {narrower} {wider}");
        }
    }
}

/// Both ends were the upper ones of what they are told to, so that the first was beyond the gap.
#[test]
fn an_interval_of_exact_meshes_began_beyond_their_gap() {
    let query = Query::new(QuerySettings::default()).unwrap();
    let cube = Mesh::prepare(&box_mesh()).unwrap();
    for gap in [1e-6, 1e-4, 0.01, 0.3, 4.8] {
        let pose = Pose::from_translation(Vector3::x() * (0.2 + gap));
        let [low, high] = query.clearance_interval(&cube, &cube, &pose, 0.9).unwrap();
        // The pose rounds.
        assert!(low <= gap + 1e-12 && gap <= high + 1e-12, "{gap} {low} {high}");
        assert!(high - low <= 2e-3 * gap + 2e-5, "{gap} {low} {high}");
    }
}

#[test]
fn an_interval_holds_the_gap_and_starts_at_nothing_in_a_collision() {
    let query = Query::new(QuerySettings::default()).unwrap();
    for kinds in [[false, false], [false, true], [true, true]] {
        let (a, b) = (body(kinds[0], 6000, 0.001, 1), body(kinds[1], 6000, 0.001, 2));
        let at = |gap: f64| Pose::from_translation(Vector3::new(0.01, -0.02, 0.2 + gap));
        let [low, high] = query.clearance_interval(&a, &b, &at(0.06), 0.9).unwrap();
        assert!(
            low <= 0.06 + ENDS && high >= 0.06 - ENDS && high - low < 2.0 * SPACINGS,
            "{kinds:?} {low} {high}"
        );
        assert_eq!(query.clearance_interval(&a, &b, &at(-0.05), 0.9).unwrap(), [0.0; 2]);
        // One query tells the same as one for each.
        let (_, within, interval) = query.nearness(&a, &b, &at(0.06), 0.05, 0.9).unwrap();
        assert_eq!(interval, [low, high]);
        assert_eq!(within, query.within(&a, &b, &at(0.06), 0.05).unwrap().1);
        assert!(matches!(
            query.clearance_interval(&a, &b, &at(0.0), 1.0),
            Err(QueryError::Share { .. })
        ));
    }
}

#[test]
fn no_margin_is_negative_or_unknown() {
    let query = Query::new(QuerySettings::default()).unwrap();
    let a = body(true, 0, 0.0, 1);
    for value in [-0.01, f64::NAN, f64::INFINITY] {
        let error = query.within(&a, &a, &Pose::identity(), value).unwrap_err();
        assert!(matches!(error, QueryError::Margin { .. }), "{error}");
        assert!(error.to_string().contains("give a length in metres"), "{error}");
    }
}
