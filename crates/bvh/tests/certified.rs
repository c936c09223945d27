//! `Certified`: the interval of the outcome holds the answer of brute force over all points.

use crate::common;
use crate::common::{bumpy_sheet, degenerate_clouds, flat_answer, held, noisy, small_leaves};
use cloudtouch_bvh::{
    Flow, LeafBounds, Outcome, Traversal, TraversalSettings, Tree, TreeError, TreeSettings,
    traverse,
};
use cloudtouch_geom::{Covariance, Point3, Pose, Vector3};
use proptest::prelude::*;

/// The largest pair probability in the leaf pairs visited, and the outcome.
fn search(a: &Tree, b: &Tree, pose: &Pose, settings: &TraversalSettings) -> (f64, Outcome) {
    let mut found = 0.0_f64;
    let outcome = traverse(a, b, pose, settings, 1, |pair| {
        let in_b = held(b, pair.b);
        let in_b = common::moved(&in_b, &pose.translation());
        let here = flat_answer(&held(a, pair.a), &in_b);
        assert!(
            here <= pair.bound * (1.0 + 1e-6),
            "{here} exceeds the pair's bound {}",
            pair.bound
        );
        found = found.max(here);
        Flow::Continue
    })
    .expect("usable settings");
    (found, outcome)
}

fn all_of(tree: &Tree) -> Vec<cloudtouch_bvh::Primitive> {
    (0..tree.index_count()).filter_map(|i| tree.primitive(i)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn interval_holds_the_flat_answer(
        streams in (0..1000_u64, 0..1000_u64),
        counts in (1..250_usize, 1..250_usize),
        offset in prop::array::uniform3(-0.6..0.6_f64),
        kind in prop_oneof![
            Just(Traversal::Certified), Just(Traversal::Paper), Just(Traversal::GapAware)
        ],
    ) {
        let a = small_leaves(bumpy_sheet(streams.0, counts.0, Vector3::zeros()));
        let b = small_leaves(bumpy_sheet(streams.1 + 1000, counts.1, Vector3::zeros()));
        let pose = Pose::from_translation(Vector3::from(offset));
        let settings = TraversalSettings { kind, ..Default::default() };
        let (found, outcome) = search(&a, &b, &pose, &settings);
        let flat = flat_answer(&all_of(&a), &common::moved(&all_of(&b), &pose.translation()));
        prop_assert!(found <= flat * (1.0 + 1e-9));
        prop_assert!(flat <= found.max(outcome.culled_bound) * (1.0 + 1e-6));
        if kind == Traversal::Certified {
            prop_assert!(outcome.culled_bound <= 1e-6);
        }
    }

    #[test]
    fn a_rigid_motion_of_both_changes_nothing(
        offset in prop::array::uniform3(-0.3..0.3_f64),
        angles in prop::array::uniform3(-3.1..3.1_f64),
        far in prop::array::uniform3(-100.0..100.0_f64),
    ) {
        let between = Pose::from_translation_rpy(Vector3::from(offset), [0.1, 0.7, -0.4]);
        let motion = Pose::from_translation_rpy(Vector3::from(far), angles);
        let a = bumpy_sheet(11, 200, Vector3::zeros());
        let b = bumpy_sheet(12, 200, Vector3::zeros());
        let carried = |cloud: &[cloudtouch_bvh::Primitive], pose: &Pose| -> Vec<_> {
            cloud.iter().map(|p| noisy(pose.transform_point(&p.centroid()), 0.004)).collect()
        };
        let run = |a, b, pose: &Pose| {
            let (a, b) = (small_leaves(a), small_leaves(b));
            let mut pairs = Vec::new();
            let outcome = traverse(&a, &b, pose, &TraversalSettings::default(), 0, |pair| {
                let mut sets = [
                    a.leaf(pair.a).unwrap().primitive_indices().to_vec(),
                    b.leaf(pair.b).unwrap().primitive_indices().to_vec(),
                ];
                sets.iter_mut().for_each(|set| set.sort());
                pairs.push((sets, pair.gap));
                Flow::Continue
            }).unwrap();
            pairs.sort_by(|x, y| x.0.cmp(&y.0));
            (pairs, outcome)
        };
        let still = Pose::identity();
        let (pairs, outcome) = run(carried(&a, &still), carried(&b, &still), &between);
        // Both trees built in a moved frame; the pose between the frames is carried along.
        let carried_pose = motion.after(&between).after(&motion.inverse());
        let (pairs_moved, outcome_moved) =
            run(carried(&a, &motion), carried(&b, &motion), &carried_pose);
        prop_assert_eq!(pairs.len(), pairs_moved.len());
        for (one, other) in pairs.iter().zip(&pairs_moved) {
            prop_assert_eq!(&one.0, &other.0);
            prop_assert!((one.1 - other.1).abs() < 1e-10);
        }
        prop_assert_eq!(outcome.culled, outcome_moved.culled);
        prop_assert!((outcome.culled_bound - outcome_moved.culled_bound).abs() < 1e-12);
    }
}

#[test]
fn degenerate_clouds_against_one_another() {
    let trees: Vec<_> =
        degenerate_clouds().into_iter().map(|(name, cloud)| (name, small_leaves(cloud))).collect();
    for (name_a, a) in &trees {
        for (name_b, b) in &trees {
            // The flat answer takes the plane across the line between two points, which bounds
            // nothing for triangles, nor where the deviation depends on the direction: those are
            // checked against the plane of the culled pair, beside the traversal.
            let isotropic = |tree: &Tree| {
                all_of(tree).iter().all(|p| {
                    p.covariance().is_some_and(|c| c.std_along(&Vector3::z()) == c.max_std())
                })
            };
            if !isotropic(a) || !isotropic(b) || a.len() * b.len() > 400_000 {
                continue;
            }
            let (found, outcome) = search(a, b, &Pose::identity(), &TraversalSettings::default());
            let flat = flat_answer(&all_of(a), &all_of(b));
            let upper = found.max(outcome.culled_bound);
            assert!(found <= flat && flat <= upper * (1.0 + 1e-6), "{name_a} on {name_b}");
        }
    }
}

#[test]
fn refined_bounds_are_used_for_culling() {
    let mut a = small_leaves(bumpy_sheet(1, 200, Vector3::zeros()));
    let mut b = small_leaves(bumpy_sheet(2, 200, Vector3::zeros()));
    let apart = Pose::from_translation(Vector3::new(0.0, 0.0, 0.4));
    let run = |a: &Tree, b: &Tree| {
        traverse(a, b, &apart, &TraversalSettings::default(), 0, |_| Flow::Continue).unwrap()
    };
    let before = run(&a, &b);
    assert_eq!((before.leaf_pairs, before.nodes_visited), (0, 1));
    // Unknown deviations: nothing may be culled.
    a.set_leaf_bounds(|_| LeafBounds { std: f64::INFINITY, shift: 0.0, reach: 0.0 }).unwrap();
    assert_eq!(run(&a, &b).culled, 0);
    // Known deviations, but means that may move across the gap.
    a.set_leaf_bounds(|_| LeafBounds { std: 0.001, shift: 0.25, reach: 0.0 }).unwrap();
    b.set_leaf_bounds(|_| LeafBounds { std: 0.001, shift: 0.2, reach: 0.0 }).unwrap();
    let moving = run(&a, &b);
    assert!(moving.leaf_pairs > 0);
    assert_eq!(a.root().unwrap().shift(), 0.25);
    // One leaf alone that may move: its ancestors know, the others do not care.
    let special = b.leaves().last().unwrap().id();
    a.set_leaf_bounds(|_| LeafBounds { std: 0.001, shift: 0.0, reach: 0.0 }).unwrap();
    b.set_leaf_bounds(|leaf| LeafBounds {
        std: 0.001,
        shift: if leaf.id() == special { 0.5 } else { 0.0 },
        reach: 0.0,
    })
    .unwrap();
    b.validate().unwrap();
    assert_eq!(b.root().unwrap().shift(), 0.5);
    let mut visited = Vec::new();
    traverse(&a, &b, &apart, &TraversalSettings::default(), 0, |pair| {
        visited.push(pair.b);
        Flow::Continue
    })
    .unwrap();
    assert!(!visited.is_empty() && visited.iter().all(|&leaf| leaf == special));
    // Bounds given are no looser than what they replace, once they say so.
    let error =
        a.set_leaf_bounds(|_| LeafBounds { std: 0.0, shift: f64::NAN, reach: 0.0 }).unwrap_err();
    assert!(matches!(error, TreeError::LeafBounds { shift, .. } if shift.is_nan()));
    assert_eq!(a.root().unwrap().shift(), 0.0);
}

#[test]
fn stopping_leaves_a_bound_for_the_rest() {
    let tree = small_leaves(bumpy_sheet(1, 300, Vector3::zeros()));
    let above = small_leaves(bumpy_sheet(2, 300, Vector3::new(0.0, 0.0, 0.03)));
    let flat = flat_answer(&all_of(&tree), &all_of(&above));
    let run = |limit: usize| {
        let (mut visited, mut found) = (0, 0.0_f64);
        let settings = TraversalSettings::default();
        let outcome = traverse(&tree, &above, &Pose::identity(), &settings, 0, |pair| {
            visited += 1;
            found = found.max(flat_answer(&held(&tree, pair.a), &held(&above, pair.b)));
            if visited == limit { Flow::Stop } else { Flow::Continue }
        })
        .unwrap();
        (found, outcome)
    };
    let (found, whole) = run(usize::MAX);
    assert!(!whole.stopped && whole.pending_bound == 0.0);
    assert_eq!(found, flat);
    let mut pending = 1.0;
    for part in [1, 2, 4, 8, 16] {
        let limit = whole.leaf_pairs * part / 16;
        let (found, outcome) = run(limit);
        assert!(outcome.stopped && outcome.leaf_pairs == limit);
        assert!(flat <= found.max(outcome.culled_bound).max(outcome.pending_bound));
        // Best first: what is left gets less likely.
        assert!(outcome.pending_bound <= pending);
        pending = outcome.pending_bound;
    }
    assert!(pending < 0.01, "{pending}");
    let (_, first) = run(1);
    assert_eq!((first.leaf_pairs, first.pending_bound), (1, 1.0));
}

#[test]
fn pairs_that_cannot_matter_are_left_out_and_bounded() {
    let tree = small_leaves(bumpy_sheet(1, 300, Vector3::zeros()));
    let above = small_leaves(bumpy_sheet(2, 300, Vector3::new(0.0, 0.0, 0.03)));
    let flat = flat_answer(&all_of(&tree), &all_of(&above));
    let run = |wanted: &dyn Fn(f64) -> Flow| {
        let mut found = 0.0_f64;
        let settings = TraversalSettings::default();
        let outcome = traverse(&tree, &above, &Pose::identity(), &settings, 0, |pair| {
            found = found.max(flat_answer(&held(&tree, pair.a), &held(&above, pair.b)));
            wanted(found)
        })
        .unwrap();
        (found, outcome)
    };
    let (_, whole) = run(&|_| Flow::Continue);
    let (found, narrowed) = run(&Flow::Above);
    // The largest probability is found all the same, with less work.
    assert_eq!(found, flat);
    assert!(narrowed.leaf_pairs < whole.leaf_pairs);
    assert!(narrowed.culled_bound <= flat.max(whole.culled_bound));
    assert!(!narrowed.stopped && narrowed.pending_bound == 0.0);
}

#[test]
fn empty_trees_and_bad_poses() {
    let empty = small_leaves(vec![]);
    let some = small_leaves(bumpy_sheet(1, 30, Vector3::zeros()));
    let settings = TraversalSettings::default();
    let mut visit = |_| Flow::Continue;
    let here = Pose::identity();
    let outcome = traverse(&empty, &some, &here, &settings, 0, &mut visit).unwrap();
    assert_eq!(outcome, Outcome::default());
    let bad = Pose::from_translation(Vector3::new(0.0, f64::NAN, 0.0));
    let error = traverse(&some, &some, &bad, &settings, 0, &mut visit).unwrap_err();
    assert!(matches!(error, TreeError::Pose { value } if value.is_nan()));
    let unsure = TraversalSettings { cull_deviations: -0.1, ..settings };
    let error = traverse(&some, &some, &here, &unsure, 0, &mut visit).unwrap_err();
    assert!(matches!(error, TreeError::Setting { name: "cull_deviations", .. }));
}

#[test]
fn identical_clouds_far_from_the_origin_find_themselves() {
    let utm = Vector3::new(5e6, 4e5, 100.0);
    let tree = Tree::build(bumpy_sheet(7, 400, utm), &TreeSettings::default()).unwrap();
    let mut touching = std::collections::BTreeSet::new();
    traverse(&tree, &tree, &Pose::identity(), &TraversalSettings::default(), 0, |pair| {
        if pair.a == pair.b {
            touching.insert(pair.a);
        }
        Flow::Continue
    })
    .unwrap();
    assert_eq!(touching.len(), tree.leaves().count());
    // A millimetre of clear gap between exact points is enough, even out there.
    let exact = |z: f64| {
        let at = |i: usize| Point3::new((i % 20) as f64 * 0.01, (i / 20) as f64 * 0.01, z) + utm;
        small_leaves((0..400).map(|i| noisy(at(i), 0.0)).collect())
    };
    let outcome = traverse(
        &exact(0.0),
        &exact(0.001),
        &Pose::identity(),
        &TraversalSettings::default(),
        0,
        |_| Flow::Continue,
    )
    .unwrap();
    assert_eq!((outcome.leaf_pairs, outcome.culled_bound), (0, 0.0));
}

#[test]
fn one_extent_for_every_index() {
    let mut tree = small_leaves(bumpy_sheet(1, 20, Vector3::zeros()));
    let error = tree.set_extents(vec![Covariance::zero(); 19]).unwrap_err();
    assert_eq!(error, TreeError::Count { expected: 20, found: 19 });
}
