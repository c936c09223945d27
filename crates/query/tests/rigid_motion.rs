//! Moving everything moves the contacts and changes nothing else.

mod common;

use cloudtouch::geom::{Covariance, Point3, Pose, Vector3};
use cloudtouch::{Cloud, Mode};
use cloudtouch_testkit::scene;
use common::{ask, at, measured, prepare_each, uniform};
use proptest::prelude::*;

/// What the library promises: boxes turn along with the points, rounding may choose another of two
/// equally good planes.
const TOLERANCE: f64 = 1e-3;

/// Noise twice as large along x as across, so that turning the points alone would show.
fn lopsided() -> Covariance {
    Covariance::diagonal([0.004_f64.powi(2), 0.002_f64.powi(2), 0.002_f64.powi(2)])
}

fn placed(points: &[Point3], pose: &Pose) -> Cloud {
    let moved = points.iter().map(|p| pose.transform_point(p)).collect();
    let covariance = lopsided().rotated(pose.rotation());
    prepare_each(moved, vec![covariance; points.len()], Mode::Calibrated)
}

fn motions() -> impl Strategy<Value = Pose> {
    (prop::array::uniform3(-2.0_f64..2.0), prop::array::uniform3(-3.1_f64..3.1))
        .prop_map(|(t, rpy)| Pose::from_translation_rpy(Vector3::from(t), rpy))
}

proptest! {
    // Four preparations and two queries a case.
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn each_cloud_in_a_frame_of_its_own(
        motion_a in motions(),
        motion_b in motions(),
        gap in -0.01_f64..0.02,
        seed in any::<u64>(),
    ) {
        let floor = measured(&scene::plane_patch(0.3), 0.02, 0.002, seed);
        let ball = measured(&scene::sphere(0.08, 3), 0.016, 0.002, !seed);
        let lateral = 0.02 * uniform(seed, 1);
        let a_from_b = at(lateral, 0.0, 0.08 + gap);
        let still = ask(
            Mode::Calibrated,
            &placed(&floor, &Pose::identity()),
            &placed(&ball, &Pose::identity()),
            &a_from_b,
        );
        let moved_pose = motion_a.after(&a_from_b).after(&motion_b.inverse());
        let moved =
            ask(Mode::Calibrated, &placed(&floor, &motion_a), &placed(&ball, &motion_b), &moved_pose);
        let (p, q) = (still.collision_probability, moved.collision_probability);
        prop_assert!((p - q).abs() < TOLERANCE, "{} and {}", p, q);
        prop_assert_eq!(still.verdict, moved.verdict);
        // Below the early stop the same places are looked at.
        if p < 0.99 && !still.contacts.is_empty() {
            let wanted = motion_a.transform_point(&still.contacts[0].point);
            let normal = motion_a.transform_vector(&still.contacts[0].normal_a_to_b);
            let nearest = moved.contacts.iter().min_by(|c, d| {
                (c.point - wanted).norm().total_cmp(&(d.point - wanted).norm())
            });
            let found = nearest.expect("a contact in one frame is one in any other");
            // As in swap: the surface is solved to a thousandth.
            prop_assert!((found.point - wanted).norm() < 1e-3, "{:?} not {}", found, wanted);
            prop_assert!(found.normal_a_to_b.dot(&normal) > 0.99, "{:?} not {}", found, normal);
        }
    }
}
