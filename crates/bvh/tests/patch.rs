//! Patches: well formed whatever comes and goes, and every primitive where it belongs.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use crate::common::{bumpy_sheet, is_kept, noisy, small_leaves};
use cloudtouch_bvh::{LeafBounds, NodeId, Primitive, Tree, TreeError};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, Vector3, seed};
use proptest::prelude::*;

/// What becomes of a list: these are removed, and these added where the list ends or begins.
#[derive(Debug, Clone)]
struct Step {
    every: usize,
    from: usize,
    count: usize,
    added: Vec<[f64; 3]>,
    at_front: bool,
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let coordinate = prop_oneof![-1.0..1.0_f64, (-3..3_i32).prop_map(|i| f64::from(i) * 0.25)];
    let added = prop::collection::vec(prop::array::uniform3(coordinate), 0..60);
    let step = (1..9_usize, 0..200_usize, 0..150_usize, added, any::<bool>()).prop_map(
        |(every, from, count, added, at_front)| Step { every, from, count, added, at_front },
    );
    prop::collection::vec(step, 1..6)
}

/// Takes a step on a tree and on the list of its primitives; the leaves that changed.
fn take(tree: &mut Tree, all: &mut Vec<Primitive>, step: &Step) -> Vec<NodeId> {
    let is_gone = |index: usize| {
        index >= step.from
            && (index - step.from).is_multiple_of(step.every)
            && (index - step.from) / step.every < step.count
    };
    let kept = (0..all.len()).filter(|&index| !is_gone(index)).map(|index| Some(index as u32));
    let mut before: Vec<Option<u32>> = kept.collect();
    if before.is_empty() {
        return Vec::new();
    }
    let added: Vec<Primitive> = step.added.iter().map(|p| noisy((*p).into(), 0.01)).collect();
    let came = added.iter().map(|_| None);
    if step.at_front {
        before.splice(0..0, came);
    } else {
        before.extend(came);
    }
    let mut new = added.iter();
    *all = before
        .iter()
        .map(|before| before.map_or_else(|| *new.next().unwrap(), |index| all[index as usize]))
        .collect();
    tree.patch(&before, &added).unwrap().leaves
}

fn agrees(tree: &Tree, all: &[Primitive]) -> Result<(), TestCaseError> {
    prop_assert_eq!(tree.validate(), Ok(()));
    prop_assert_eq!(tree.len(), all.len());
    for (index, primitive) in all.iter().enumerate() {
        prop_assert_eq!(tree.primitive(index), Some(*primitive));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_patched_tree_is_well_formed(steps in steps(), has_bounds in any::<bool>()) {
        let mut all = bumpy_sheet(3, 200, Vector3::zeros());
        let mut tree = small_leaves(all.clone());
        let bounds = |std| LeafBounds { std, shift: 0.01, reach: 0.02 };
        if has_bounds {
            tree.set_leaf_bounds(|_| bounds(0.02)).unwrap();
        }
        for step in &steps {
            let leaves = take(&mut tree, &mut all, step);
            agrees(&tree, &all)?;
            if has_bounds {
                tree.set_bounds_of(&leaves, |_| bounds(0.05)).unwrap();
                agrees(&tree, &all)?;
                for leaf in leaves {
                    prop_assert!(is_kept(tree.leaf(leaf).unwrap().max_std(), 0.05));
                }
            }
        }
    }

    #[test]
    fn amended_primitives_are_held_by_all_around_them(steps in steps(), seed in 0..1000_u64) {
        let mut all = bumpy_sheet(3, 200, Vector3::zeros());
        let mut tree = small_leaves(all.clone());
        tree.set_extents(vec![Covariance::isotropic(1e-4); all.len()]).unwrap();
        for step in &steps {
            take(&mut tree, &mut all, step);
            let moved = |index: usize| {
                let place = all[index].centroid() + Vector3::repeat(0.03);
                (index as u32, noisy(place, 0.02), Covariance::isotropic(4e-4))
            };
            let first = seed as usize % all.len();
            let amended: Vec<_> = (first..all.len()).step_by(11).map(moved).collect();
            tree.amend(&amended).unwrap();
            amended.iter().for_each(|(index, primitive, _)| all[*index as usize] = *primitive);
            agrees(&tree, &all)?;
            let leaf = tree.leaf(tree.leaf_of(first).unwrap()).unwrap();
            prop_assert!(leaf.reach() >= 0.02 * (1.0 - 1e-12));
        }
    }
}

#[test]
fn only_leaves_that_change_are_named() {
    let all = bumpy_sheet(3, 900, Vector3::zeros());
    let mut tree = small_leaves(all.clone());
    let before: Vec<Option<u32>> = (1..all.len() as u32).map(Some).collect();
    let lost = tree.leaf_of(0).unwrap();
    let patched = tree.patch(&before, &[]).unwrap();
    assert_eq!((patched.stale, patched.leaves), (vec![lost], vec![lost]));
    assert_eq!(tree.validate(), Ok(()));
}

#[test]
fn what_cannot_be_meant_leaves_the_tree_as_it_was() {
    let all = bumpy_sheet(3, 16, Vector3::zeros());
    let mut tree = small_leaves(all.clone());
    let far = noisy(Point3::new(f64::NAN, 0.0, 0.0), 0.01);
    assert!(matches!(tree.patch(&[Some(0), None], &[far]), Err(TreeError::Coordinate { .. })));
    let twice = tree.patch(&[Some(1), Some(1)], &[]).unwrap_err();
    assert_eq!(twice, TreeError::NoSuchPrimitive { index: 1 });
    assert!(matches!(tree.patch(&[], &[]), Err(TreeError::Count { .. })));
    assert!(matches!(tree.patch(&[Some(0), None], &[]), Err(TreeError::Count { .. })));
    let extent = Covariance::zero();
    let amended = tree.amend(&[(0, all[0], extent)]).unwrap_err();
    assert_eq!(amended, TreeError::NoSuchPrimitive { index: 0 });
    agrees(&tree, &all).unwrap();
}

/// Above the leaves the bounds were those of the extents and covariances alone, and pairs that may touch were left out.
#[test]
fn bounds_set_after_extents_are_held_by_all_above() {
    let all = bumpy_sheet(3, 200, Vector3::zeros());
    let mut tree = small_leaves(all.clone());
    tree.set_extents(vec![Covariance::zero(); all.len()]).unwrap();
    let leaves: Vec<NodeId> = tree.leaves().map(|leaf| leaf.id()).collect();
    let bounds = LeafBounds { std: 1.0, shift: 0.0, reach: 0.5 };
    tree.set_bounds_of(&leaves, |_| bounds).unwrap();
    tree.refit(&all).unwrap();
    tree.validate().unwrap();
    assert!(tree.root().unwrap().max_std() >= 1.0);
}

#[test]
fn extents_set_on_one_thread_make_the_same_tree() {
    let all = bumpy_sheet(3, 200, Vector3::zeros());
    let extent = |i: usize| Covariance::isotropic(1e-4 * (1 + i % 7) as f64);
    let extents: Vec<Covariance> = (0..all.len()).map(extent).collect();
    let [mut on_all, mut on_one] = [small_leaves(all.clone()), small_leaves(all)];
    on_all.set_extents(extents.clone()).unwrap();
    on_one.set_extents_on_this_thread(extents).unwrap();
    assert_eq!(format!("{on_all:?}"), format!("{on_one:?}"));
}

/// It was left out where the largest is taken, and what may touch was not met.
#[test]
fn an_extent_that_was_no_number_counted_as_none() {
    let all = bumpy_sheet(3, 50, Vector3::zeros());
    let mut tree = small_leaves(all.clone());
    let good = vec![Covariance::isotropic(1e-4); all.len()];
    tree.set_extents(good.clone()).unwrap();
    let reach = tree.root().unwrap().reach();
    for value in [f64::NAN, f64::INFINITY, 1e201] {
        let bad = Covariance::isotropic(value);
        let mut extents = good.clone();
        extents[7] = bad;
        let refused = tree.set_extents(extents);
        assert!(matches!(refused, Err(TreeError::Extent { index: 7, .. })), "{refused:?}");
        let refused = tree.amend(&[(3, all[3], good[3]), (9, all[9], bad)]);
        assert!(matches!(refused, Err(TreeError::Extent { index: 9, .. })), "{refused:?}");
        assert_eq!(tree.root().unwrap().reach(), reach);
    }
}

/// Where covariances are not the same in all directions, the leaf that was fitted anew had other bounds along its new
/// axes than the nodes above it held.
#[test]
fn a_patched_tree_of_needles_was_called_malformed() {
    for seed in 0..300 {
        let draw = |i: u64, k| seed::unit(seed::derive(seed, i, k)) - 0.5;
        let needle = |i: u64| {
            // Of every other seed nearly along one another.
            let spread = if seed % 2 == 0 { 1.0 } else { 0.2 };
            let off = spread * Vector3::new(draw(i, 3), draw(i, 4), draw(i, 5));
            let along = UnitVector3::new_normalize(off + Vector3::z() * (1.0 - spread));
            let mean = Point3::new(draw(i, 0), draw(i, 1), 0.1 * draw(i, 2));
            let covariance = Covariance::from_axis(&along, 0.05, 0.001);
            Primitive::point(UncertainPoint { mean, covariance })
        };
        let mut all: Vec<Primitive> = (0..100).map(needle).collect();
        let mut tree = small_leaves(all.clone());
        for step in 1..6_u64 {
            // Every ninth is another, and all of a place go, so that leaves are emptied too.
            let place = all[step as usize].centroid();
            let stays = |i: &usize| (all[*i].centroid() - place).norm() > 0.2;
            let is_same = |i: usize| !(i as u64 + step).is_multiple_of(9);
            let left = (0..all.len()).filter(stays);
            let before: Vec<Option<u32>> = left.map(|i| is_same(i).then_some(i as u32)).collect();
            let new = before.iter().filter(|before| before.is_none()).count() as u64;
            let added: Vec<Primitive> = (0..new).map(|i| needle(1000 * step + i)).collect();
            let leaves = tree.patch(&before, &added).unwrap().leaves;
            let mut came = added.into_iter();
            let known = |index: Option<u32>| index.map(|index| all[index as usize]);
            all =
                before.iter().map(|&b| known(b).unwrap_or_else(|| came.next().unwrap())).collect();
            assert_eq!(tree.validate(), Ok(()), "{seed} {step}");
            tree.set_bounds_of(&leaves[..1], |_| LeafBounds { std: 0.03, shift: 0.0, reach: 0.0 })
                .unwrap();
            assert_eq!(tree.validate(), Ok(()), "{seed} {step}, bounded");
        }
    }
}
