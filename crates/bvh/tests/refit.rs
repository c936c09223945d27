//! Refit: the same partition with new positions answers as a rebuilt tree does.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use crate::common;
use crate::common::{bumpy_sheet, flat_answer, held, is_kept, noisy, small_leaves};
use cloudtouch_bvh::{Flow, LeafBounds, Primitive, TraversalSettings, Tree, TreeError, traverse};
use cloudtouch_geom::{Point3, Pose, Vector3, seed};
use proptest::prelude::*;

/// Every point moved by up to `distance` along each axis.
fn shaken(cloud: &[Primitive], stream: u64, distance: f64) -> Vec<Primitive> {
    cloud
        .iter()
        .enumerate()
        .map(|(i, primitive)| {
            let draw = |k| 2.0 * seed::unit(seed::derive(stream, i as u64, k)) - 1.0;
            let offset = Vector3::new(draw(0), draw(1), draw(2)) * distance;
            common::moved(&[*primitive], &offset)[0]
        })
        .collect()
}

/// Interval of the largest pair probability.
fn interval(a: &Tree, b: &Tree) -> (f64, f64) {
    let mut found = 0.0_f64;
    let outcome = traverse(a, b, &Pose::identity(), &TraversalSettings::default(), 0, |pair| {
        found = found.max(flat_answer(&held(a, pair.a), &held(b, pair.b)));
        Flow::Continue
    })
    .unwrap();
    (found, found.max(outcome.culled_bound))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn refit_answers_as_a_rebuild(
        count in 1..300_usize,
        stream in 0..1000_u64,
        distance in prop_oneof![Just(0.0), 0.0..0.02_f64, 0.0..2.0_f64],
        height in -0.2..0.4_f64,
    ) {
        let cloud = bumpy_sheet(stream, count, Vector3::zeros());
        let after = shaken(&cloud, stream + 1, distance);
        let other = small_leaves(bumpy_sheet(stream + 2, 150, Vector3::new(0.0, 0.0, height)));
        let mut refitted = small_leaves(cloud);
        refitted.refit(&after).unwrap();
        prop_assert_eq!(refitted.validate(), Ok(()));
        let mut rebuilt = refitted.clone();
        rebuilt.rebuild();
        prop_assert_eq!(rebuilt.validate(), Ok(()));
        prop_assert_eq!(rebuilt.quality(), 1.0);
        let flat = flat_answer(&after, &(0..150).map(|i| other.primitive(i).unwrap()).collect::<Vec<_>>());
        for tree in [&refitted, &rebuilt] {
            let (lower, upper) = interval(tree, &other);
            prop_assert!(lower <= flat * (1.0 + 1e-9) && flat <= upper * (1.0 + 1e-6));
        }
        // Where the answer is not negligible both find exactly it.
        if flat > 1e-6 {
            prop_assert!((interval(&refitted, &other).0 / interval(&rebuilt, &other).0 - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn refit_without_motion_gives_the_built_tree() {
    let cloud = bumpy_sheet(5, 700, Vector3::new(5e6, 0.0, 0.0));
    let built = small_leaves(cloud.clone());
    let mut refitted = built.clone();
    refitted.refit(&cloud).unwrap();
    for (one, other) in built.leaves().zip(refitted.leaves()) {
        // Sums run in another order, and coordinates of 5e6 are rounded to 1e-9.
        assert!((one.obb().centre - other.obb().centre).norm() < 1e-8);
        assert!((one.obb().half_extents - other.obb().half_extents).amax() < 1e-8);
        assert!((one.obb().axes - other.obb().axes).amax() < 1e-6);
        assert!((one.coverage() - other.coverage()).abs() < 1e-6);
    }
    assert!((refitted.quality() - 1.0).abs() < 1e-6);
}

#[test]
fn a_rigid_refit_keeps_the_quality_and_a_shuffle_does_not() {
    let cloud = bumpy_sheet(5, 700, Vector3::zeros());
    let mut tree = small_leaves(cloud.clone());
    let pose = Pose::from_translation_rpy(Vector3::new(3.0, -1.0, 2.0), [0.4, 1.0, -2.0]);
    let turned: Vec<_> =
        cloud.iter().map(|p| noisy(pose.transform_point(&p.centroid()), 0.004)).collect();
    tree.refit(&turned).unwrap();
    assert!((tree.quality() - 1.0).abs() < 1e-6 && !tree.should_rebuild(1.5));
    let shuffled: Vec<_> = (0..700).map(|i| cloud[(i * 331) % 700]).collect();
    tree.refit(&shuffled).unwrap();
    tree.validate().unwrap();
    assert!(tree.quality() > 10.0 && tree.should_rebuild(2.0));
    tree.rebuild();
    assert!(!tree.should_rebuild(1.0 + 1e-12));
}

#[test]
fn bounds_stay_with_the_points() {
    let cloud = bumpy_sheet(5, 100, Vector3::zeros());
    let mut tree = small_leaves(cloud.clone());
    let special = tree.leaf_of(42).unwrap();
    tree.set_leaf_bounds(|leaf| {
        let std = if leaf.id() == special { 0.7 } else { 0.001 };
        LeafBounds { std, shift: 2.0 * std, reach: std }
    })
    .unwrap();
    tree.refit(&shaken(&cloud, 1, 0.5)).unwrap();
    tree.rebuild();
    tree.validate().unwrap();
    let leaf = tree.leaf(tree.leaf_of(42).unwrap()).unwrap();
    assert!(is_kept(leaf.max_std(), 0.7) && is_kept(leaf.shift(), 1.4));
}

#[test]
fn bad_refits_change_nothing() {
    let cloud = bumpy_sheet(5, 100, Vector3::zeros());
    let mut tree = small_leaves(cloud.clone());
    assert_eq!(tree.refit(&cloud[1..]), Err(TreeError::Count { expected: 100, found: 99 }));
    let mut broken = shaken(&cloud, 1, 0.1);
    broken[77] = noisy(Point3::new(0.0, 0.0, f64::NEG_INFINITY), 0.1);
    assert!(matches!(tree.refit(&broken), Err(TreeError::Coordinate { index: 77, .. })));
    assert_eq!(tree.primitive(0), Some(cloud[0]));
    // The slot of a removed primitive is not looked at.
    tree.remove(77).unwrap();
    tree.refit(&broken).unwrap();
    tree.validate().unwrap();
}
