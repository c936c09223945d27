//! Insertion and removal: well formed after every step, and the answers of brute force.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use crate::common;
use std::collections::BTreeMap;

use crate::common::{bumpy_sheet, flat_answer, held, noisy, small_leaves};
use cloudtouch_bvh::{
    Flow, Primitive, TraversalSettings, Tree, TreeError, TreeSettings, Visit, traverse,
};
use cloudtouch_geom::{Point3, Pose, Vector3, seed};
use proptest::prelude::*;

#[derive(Debug, Clone)]
enum Change {
    Insert(Primitive),
    /// The n-th of the primitives present, modulo their number.
    Remove(usize),
    /// Every point moves by up to this much.
    Move(f64),
    Rebuild,
}

fn any_change() -> impl Strategy<Value = Change> {
    // Coordinates on a coarse grid half of the time, for duplicates.
    let coordinate = prop_oneof![-1.0..1.0_f64, (-3..3_i32).prop_map(|i| i as f64 * 0.25)];
    let point = prop::array::uniform3(coordinate);
    let triangle = prop::array::uniform3(prop::array::uniform3(-1.0..1.0_f64));
    prop_oneof![
        8 => (point, 0.0..0.05_f64).prop_map(|(p, std)| Change::Insert(noisy(p.into(), std))),
        1 => triangle.prop_map(|t| Change::Insert(Primitive::Triangle(t.map(Point3::from)))),
        7 => any::<usize>().prop_map(Change::Remove),
        1 => (0.0..0.3_f64).prop_map(Change::Move),
        1 => Just(Change::Rebuild),
    ]
}

fn apply(tree: &mut Tree, present: &mut BTreeMap<usize, Primitive>, change: Change) {
    match change {
        Change::Insert(primitive) => {
            let index = tree.insert(primitive).unwrap();
            assert!(present.insert(index, primitive).is_none(), "index {index} given out twice");
        }
        Change::Remove(n) if !present.is_empty() => {
            let index = *present.keys().nth(n % present.len()).unwrap();
            assert_eq!(tree.remove(index), Ok(present.remove(&index).unwrap()));
            assert_eq!(tree.remove(index), Err(TreeError::NoSuchPrimitive { index }));
        }
        Change::Remove(_) => assert!(tree.is_empty()),
        Change::Move(distance) => {
            for (&index, primitive) in present.iter_mut() {
                let draw = |k| 2.0 * seed::unit(seed::derive(9, index as u64, k)) - 1.0;
                let offset = Vector3::new(draw(0), draw(1), draw(2)) * distance;
                *primitive = common::moved(&[*primitive], &offset)[0];
            }
            let nothing = noisy(Point3::origin(), 0.0);
            let all: Vec<_> = (0..tree.index_count())
                .map(|index| present.get(&index).copied().unwrap_or(nothing))
                .collect();
            tree.refit(&all).unwrap();
        }
        Change::Rebuild => tree.rebuild(),
    }
}

/// The pair of points (one of each) that is nearest, among the leaf pairs visited.
fn nearest(a: &Tree, b: &Tree) -> f64 {
    let mut found = f64::INFINITY;
    let distance = |p: &Primitive, q: &Primitive| (p.centroid() - q.centroid()).norm();
    traverse(a, b, &Pose::identity(), &TraversalSettings::default(), 0, |pair| {
        for p in &held(a, pair.a) {
            for q in &held(b, pair.b) {
                found = found.min(distance(p, q));
            }
        }
        Flow::Continue
    })
    .unwrap();
    found
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(80))]

    #[test]
    fn any_history_leaves_a_well_formed_tree_with_the_right_answers(
        start in 0..60_usize,
        changes in prop::collection::vec(any_change(), 1..120),
        max_leaf_points in 1..9_usize,
    ) {
        let cloud = bumpy_sheet(3, start, Vector3::zeros());
        let mut present: BTreeMap<_, _> = cloud.iter().copied().enumerate().collect();
        let settings = TreeSettings { max_leaf_points, min_leaf_points: 1, ..Default::default() };
        let mut tree = Tree::build(cloud, &settings).unwrap();
        for change in changes {
            // Coverages are kept once asked for; a stale one would be found by `validate`.
            tree.visit_nodes(|node| {
                assert!((0.0..=1.0).contains(&node.coverage()));
                Visit::Descend
            });
            apply(&mut tree, &mut present, change);
            prop_assert_eq!(tree.validate(), Ok(()));
            prop_assert_eq!(tree.len(), present.len());
        }
        for index in 0..tree.index_count() {
            prop_assert_eq!(tree.primitive(index), present.get(&index).copied());
            let listed = tree.leaf_of(index).and_then(|leaf| tree.leaf(leaf));
            let found = listed.is_some_and(|leaf| leaf.primitive_indices().contains(&(index as u32)));
            prop_assert_eq!(found, present.contains_key(&index));
        }

        // Points only: triangles are exact, and their nearest points are not their centroids.
        let points: Vec<_> = present.values().filter(|p| p.covariance().is_some()).copied().collect();
        let probe = bumpy_sheet(8, 60, Vector3::new(0.2, 0.1, 0.1));
        let probe_tree = small_leaves(probe.clone());
        let flat = flat_answer(&points, &probe);
        if flat > 1e-6 {
            let closest = points
                .iter()
                .flat_map(|p| probe.iter().map(move |q| (p, q)))
                .max_by(|x, y| {
                    common::pair_probability(x.0, x.1).total_cmp(&common::pair_probability(y.0, y.1))
                })
                .map(|(p, q)| (p.centroid() - q.centroid()).norm())
                .unwrap();
            prop_assert!(nearest(&tree, &probe_tree) <= closest);
        }
        tree.tighten();
        prop_assert_eq!(tree.validate(), Ok(()));
    }
}

#[test]
fn inserting_and_removing_leaves_the_tree_as_it_was() {
    let before = small_leaves(bumpy_sheet(3, 500, Vector3::zeros()));
    // Into a leaf with room, so that none is split.
    let room = before.leaves().find(|leaf| leaf.primitive_indices().len() < 12).unwrap();
    let inside = noisy(room.moments().mean, 0.003);
    let far = noisy(Point3::new(4.0, 4.0, 4.0), 0.003);
    for primitive in [inside, far] {
        let mut tree = before.clone();
        let index = tree.insert(primitive).unwrap();
        tree.validate().unwrap();
        assert_eq!(tree.len(), 501);
        tree.remove(index).unwrap();
        tree.validate().unwrap();
        // The same primitives in the same leaves; boxes are loose until tightened.
        tree.tighten();
        let leaves = |tree: &Tree| -> Vec<Vec<u32>> {
            let mut sets: Vec<_> =
                tree.leaves().map(|leaf| leaf.primitive_indices().to_vec()).collect();
            sets.iter_mut().for_each(|set| set.sort());
            sets.sort();
            sets
        };
        if leaves(&tree) == leaves(&before) {
            for (one, other) in before.leaves().zip(tree.leaves()) {
                assert!((one.obb().centre - other.obb().centre).norm() < 1e-12);
                assert!((one.obb().half_extents - other.obb().half_extents).amax() < 1e-12);
                assert!((one.coverage() - other.coverage()).abs() < 1e-12);
                assert_eq!((one.max_std(), one.shift()), (other.max_std(), other.shift()));
            }
        } else {
            // The far point filled a leaf that was full: split, and split it stays.
            assert_eq!(leaves(&tree).len(), leaves(&before).len() + 1);
        }
    }
}

#[test]
fn a_tree_can_be_emptied_and_filled_again() {
    let mut tree = small_leaves(bumpy_sheet(3, 100, Vector3::zeros()));
    for index in 0..100 {
        tree.remove((index * 37) % 100).unwrap();
        tree.validate().unwrap();
    }
    assert!(tree.is_empty() && tree.root().is_none());
    for i in 0..100 {
        let index = tree.insert(noisy(Point3::new(i as f64 * 0.01, 0.0, 0.0), 0.001)).unwrap();
        assert_eq!(index, 100 + i);
        tree.validate().unwrap();
    }
    assert_eq!(tree.len(), 100);
    // Slots of released nodes were used again, and none is in use twice.
    assert!(tree.node_slots() <= 2 * 100);
}

#[test]
fn leaves_overfull_with_equal_points_are_split() {
    let mut tree = small_leaves(vec![]);
    for _ in 0..200 {
        tree.insert(noisy(Point3::new(0.1, 0.2, 0.3), 0.01)).unwrap();
    }
    tree.validate().unwrap();
    assert!(tree.leaves().all(|leaf| leaf.primitive_indices().len() <= 12));
}

#[test]
fn insertion_loosens_and_quality_says_so() {
    let mut tree = small_leaves(bumpy_sheet(3, 300, Vector3::zeros()));
    // A second sheet right through the first, in the order of a scan.
    for primitive in bumpy_sheet(30, 300, Vector3::new(0.0, 0.0, 0.01)) {
        tree.insert(primitive).unwrap();
    }
    tree.validate().unwrap();
    let quality = tree.quality();
    assert!(quality > 0.3 && quality < 4.0, "{quality}");
}

#[test]
fn bad_points_are_refused_and_change_nothing() {
    let mut tree = small_leaves(bumpy_sheet(3, 50, Vector3::zeros()));
    let bad = noisy(Point3::new(f64::NAN, 0.0, 0.0), 0.01);
    assert!(matches!(tree.insert(bad), Err(TreeError::Coordinate { index: 50, .. })));
    assert_eq!((tree.len(), tree.index_count()), (50, 50));
    assert_eq!(tree.remove(50), Err(TreeError::NoSuchPrimitive { index: 50 }));
}
