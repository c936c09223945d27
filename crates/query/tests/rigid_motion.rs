//! Moving everything moves the contacts and changes nothing else.

use std::cell::Cell;

use crate::common::{Scan, ask, at, measured, prepare_each, uniform};
use cloudtouch::geom::{Covariance, Point3, Pose, Vector3};
use cloudtouch::{Mode, Report};
use cloudtouch_testkit::scene;
use proptest::prelude::*;

/// What the library promises: boxes turn along with the points, rounding may choose another of two
/// equally good planes.
const TOLERANCE: f64 = 1e-3;

/// Noise twice as large along x as across, so that turning the points alone would show.
fn lopsided() -> Covariance {
    Covariance::diagonal([0.004_f64.powi(2), 0.002_f64.powi(2), 0.002_f64.powi(2)])
}

fn placed(points: &[Point3], pose: &Pose) -> Scan {
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
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn each_cloud_in_a_frame_of_its_own(
        motion_a in motions(),
        motion_b in motions(),
        gap in -0.01_f64..0.012,
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
    }
}

/// The ball above the floor in their own frames, and with the floor's frame turned: what two
/// reports of the same pair must share.
fn still_and_turned(check: impl Fn(&Pose, &Report, &Report)) {
    let floor = measured(&scene::plane_patch(0.4), 0.015, 0.003, 1);
    let ball = placed(&measured(&scene::sphere(0.1, 3), 0.012, 0.003, 2), &Pose::identity());
    let motion = Pose::from_translation_rpy(Vector3::new(0.3, -0.2, 0.5), [0.4, -0.7, 1.9]);
    let (still_floor, turned_floor) = (placed(&floor, &Pose::identity()), placed(&floor, &motion));
    for gap in [-0.005, 0.0, 0.003, 0.006, 0.008, 0.012] {
        let pose = at(0.02, 0.01, 0.1 + gap);
        let still = ask(Mode::Calibrated, &still_floor, &ball, &pose);
        let turned = ask(Mode::Calibrated, &turned_floor, &ball, &motion.after(&pose));
        check(&motion, &still, &turned);
    }
}

#[test]
fn turning_the_frame_of_a_changes_no_probability() {
    still_and_turned(|_, still, turned| {
        let (p, q) = (still.collision_probability, turned.collision_probability);
        assert!((p - q).abs() < TOLERANCE, "{p} and {q}");
        assert_eq!(still.verdict, turned.verdict);
    });
}

/// Below the early stop the same places are looked at. As in swap: the surface is solved to far
/// less than a millimetre.
#[test]
fn contacts_turn_with_the_frame_of_a() {
    let compared = Cell::new(0);
    still_and_turned(|motion, still, turned| {
        let Some(contact) = still.contacts.first() else { return };
        if still.collision_probability > 0.99 {
            return;
        }
        compared.set(compared.get() + 1);
        let wanted = motion.transform_point(&contact.point);
        let off = |c: &&cloudtouch::Contact| (c.point - wanted).norm();
        let found = turned.contacts.iter().min_by(|c, d| off(c).total_cmp(&off(d)));
        let found = found.expect("a contact in one frame is one in any other");
        assert!(off(&found) < 1e-3, "{contact:?} became {found:?}, {} m off", off(&found));
        let cosine = found.normal_a_to_b.dot(&motion.transform_vector(&contact.normal_a_to_b));
        assert!(cosine > 0.99, "{contact:?} became {found:?}");
    });
    assert!(compared.get() >= 4, "{compared:?} of six");
}
