//! Noise that all points near one another share: none of many is near by chance, however dense they are.

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mesh, Query, QuerySettings, Report, Verdict};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::scene;

const STATED: f64 = 0.005;

fn over_floor(gap: f64, spacing: f64, scatter: f64) -> Report {
    over_floor_of(STATED, gap, spacing, scatter)
}

/// A box of 10 cm so far above what was measured of a floor with such a noise, whose samples are so far apart and
/// scatter by so much.
fn over_floor_of(stated: f64, gap: f64, spacing: f64, scatter: f64) -> Report {
    let across = (0.4 / spacing) as u32;
    let sample = |i: u32| {
        let place = |k: u32| spacing * f64::from(k) - 0.2;
        Point3::new(place(i % across), place(i / across), 0.0)
    };
    let floor: Vec<Point3> = (0..across * across).map(sample).collect();
    let floor = add_noise(&floor, NoiseKind::Gaussian, scatter, 5);
    let settings = CloudSettings::new(SensorModel::Isotropic { std: stated });
    let floor = Cloud::prepare(&PointCloud::from_points(floor), &settings).expect("a good cloud");
    let cube = Mesh::prepare(&scene::cuboid([0.1; 3])).expect("a good mesh");
    let pose = Pose::from_translation(Vector3::new(0.0003, 0.0004, 0.05 + gap));
    let query = Query::new(QuerySettings::default()).expect("good settings");
    query.run(&floor, &cube, &pose).expect("an answer")
}

/// A floor of which all is measured a deviation too low is as likely as not to be in the way: the denser it was
/// sampled, the freer it read, down to half a deviation in it.
#[test]
fn a_floor_that_is_off_as_a_whole_is_not_free_within_a_deviation() {
    for spacing in [0.002, 0.003, 0.005] {
        for scatter in [0.0, 0.0002, 0.001] {
            for gap in [-0.001, 0.0, 0.002, 0.004] {
                let report = over_floor(gap, spacing, scatter);
                let told = (spacing, scatter, gap, report.collision_probability, report.verdict);
                assert_ne!(report.verdict, Verdict::Free, "{told:?}");
            }
            let report = over_floor(0.015, spacing, scatter);
            assert_eq!(report.verdict, Verdict::Free, "{spacing} {scatter}: {report:?}");
        }
    }
}

/// Datasheets state how far off a camera is, of which half may scatter: the rest is .87 of a deviation that all points
/// have in common, and reaches a quarter of one in four of ten floors. P was .08 to .16 there in
/// floors of samples at random, 5 mm apart, and most of these `free`.
#[test]
fn noise_that_shows_by_half_is_an_error_in_common_for_the_rest() {
    for (spacing, stated) in [(0.005, 0.0005), (0.005, 0.001), (0.005, 0.002), (0.01, 0.002)] {
        let over = |deviations: f64| {
            over_floor_of(stated, deviations * stated, spacing, 0.5 * stated).collision_probability
        };
        let p = [0.25, 2.0, 3.0].map(over);
        assert!(p[0] > 0.2 && p[1] < 0.1 && p[2] < 0.05, "{spacing} {stated}: {p:?}");
    }
}

/// What is apart by much less than a deviation is about as likely in collision as not, and a deviation apart a sixth as
/// often.
#[test]
fn how_likely_it_is_follows_from_the_deviations() {
    for spacing in [0.002, 0.003, 0.005] {
        let p = [0.0005, 0.005].map(|gap| over_floor(gap, spacing, 0.0).collision_probability);
        assert!((0.2..0.6).contains(&p[0]) && (0.08..0.3).contains(&p[1]), "{spacing}: {p:?}");
    }
}
