//! Contacts in any pose: unit normals between the bodies, the same seen from the other side.

use std::sync::LazyLock;

use crate::common::{AnyQuery, Scan, assert_sound, scan};
use cloudtouch::bvh::Traversal;
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{Contact, Mode, Report};
use cloudtouch_testkit::scene;
use proptest::prelude::*;

const SPACING: f64 = 0.015;

/// A floor and a ball of 5 cm.
fn clouds(mode: Mode) -> [Scan; 2] {
    let floor = scan(&scene::plane_patch(0.2), SPACING, 0.002, 1, mode);
    [floor, scan(&scene::sphere(0.05, 3), SPACING, 0.002, 2, mode)]
}

static CALIBRATED: LazyLock<[Scan; 2]> = LazyLock::new(|| clouds(Mode::Calibrated));
static PAPER: LazyLock<[Scan; 2]> = LazyLock::new(|| clouds(Mode::Paper));

fn clouds_of(mode: Mode) -> &'static [Scan; 2] {
    match mode {
        Mode::Calibrated => &CALIBRATED,
        Mode::Paper => &PAPER,
    }
}

/// Classifiers wherever there is something to classify, all of them, and to so tight a tolerance
/// that what is compared does not hang on it.
fn thorough(mode: Mode) -> AnyQuery {
    AnyQuery::with(
        mode,
        |s| (s.relative_gap, s.stop_above) = (1e-7, 1.0),
        |s| (s.traversal, s.relative_gap, s.stop_above) = (Traversal::Certified, 1e-7, 1.0),
    )
}

fn both_ways(mode: Mode, a_from_b: &Pose) -> [Report; 2] {
    let [floor, ball] = clouds_of(mode);
    let query = thorough(mode);
    let reports = [query.run(floor, ball, a_from_b), query.run(ball, floor, &a_from_b.inverse())];
    reports.map(|report| report.expect("a finite pose"))
}

/// A ball over the floor at any place, turned any way, from overlap to clear.
fn poses() -> impl Strategy<Value = Pose> {
    (-0.05..0.05_f64, -0.05..0.05_f64, -0.008..0.008_f64, prop::array::uniform3(-3.0..3.0_f64))
        .prop_map(|(x, y, gap, rpy)| {
            Pose::from_translation_rpy(Vector3::new(x, y, 0.05 + gap), rpy)
        })
}

fn check(mode: Mode, a_from_b: &Pose) -> Result<(), TestCaseError> {
    let [forth, back] = both_ways(mode, a_from_b);
    for report in [&forth, &back] {
        assert_sound(report);
        let order =
            report.contacts.windows(2).all(|pair| pair[0].probability >= pair[1].probability);
        prop_assert!(order, "not the most probable first: {:?}", report.contacts);
    }
    let [floor, ball] = clouds_of(mode);
    for contact in &forth.contacts {
        let of_floor = (0..floor.len()).map(|i| floor.point(i));
        let of_ball = (0..ball.len()).map(|i| a_from_b.transform_point(&ball.point(i)));
        let distances = of_floor.chain(of_ball).map(|p| (p - contact.point).norm());
        let away = distances.fold(f64::INFINITY, f64::min);
        prop_assert!(away < 3.0 * SPACING, "{away} m from the nearest sample: {contact:?}");
    }
    let Some(contact) = forth.contacts.first() else {
        prop_assert!(back.contacts.is_empty());
        return Ok(());
    };
    let seen_back = |c: &Contact| {
        let mut seen = *c;
        seen.point = a_from_b.transform_point(&c.point);
        seen.normal_a_to_b = -a_from_b.transform_vector(&c.normal_a_to_b);
        seen
    };
    let off = |c: &Contact| (c.point - contact.point).norm();
    let others = back.contacts.iter().map(seen_back);
    let nearest = others.min_by(|c, d| off(c).total_cmp(&off(d)));
    let nearest = nearest.expect("a contact one way is a contact the other way");
    prop_assert!(off(&nearest) < 1e-3, "{} m off: {contact:?}, {nearest:?}", off(&nearest));
    let cosine = nearest.normal_a_to_b.dot(&contact.normal_a_to_b);
    prop_assert!(cosine > 0.999, "cosine {cosine}: {contact:?}, {nearest:?}");
    Ok(())
}

#[test]
fn the_order_of_the_sides_chose_among_points_as_far_from_their_middle() {
    let poses = [
        ([-0.039, -0.044, 0.0473], [-2.65, 2.06, -1.36]),
        ([-0.010, -0.041, 0.0488], [1.43, 1.43, 0.74]),
        ([0.011, 0.022, 0.0471], [-2.15, 0.68, 1.40]),
        ([-0.037, -0.021, 0.0454], [2.69, -2.92, 0.35]),
    ];
    for (translation, rpy) in poses {
        let pose = Pose::from_translation_rpy(Vector3::from(translation), rpy);
        let same = check(Mode::Paper, &pose);
        assert!(same.is_ok(), "{translation:?}, {rpy:?}: {same:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn two_clouds_by_classifiers_on_patches(a_from_b in poses()) {
        check(Mode::Calibrated, &a_from_b)?;
    }

    #[test]
    fn two_clouds_by_classifiers_on_pairs_of_leaves(a_from_b in poses()) {
        check(Mode::Paper, &a_from_b)?;
    }
}
