//! `Paper` and `GapAware`: reproducible, and as frequent as their formulas say.

use std::collections::BTreeSet;

use crate::common::{bumpy_sheet, noisy, small_leaves};
use cloudtouch_bvh::{Flow, Traversal, TraversalSettings, Tree, TreeSettings, traverse};
use cloudtouch_geom::{Point3, Pose, Vector3, normal};

fn settings(kind: Traversal) -> TraversalSettings {
    TraversalSettings { kind, ..Default::default() }
}

fn visited(a: &Tree, b: &Tree, pose: &Pose, kind: Traversal, seed: u64) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    traverse(a, b, pose, &settings(kind), seed, |pair| {
        pairs.push((pair.a.index(), pair.b.index()));
        Flow::Continue
    })
    .expect("usable settings");
    pairs
}

#[test]
fn the_seed_and_nothing_else_decides() {
    let a = small_leaves(bumpy_sheet(1, 300, Vector3::zeros()));
    let b = small_leaves(bumpy_sheet(2, 300, Vector3::zeros()));
    for kind in [Traversal::Paper, Traversal::GapAware] {
        let pose = Pose::from_translation(Vector3::new(0.0, 0.0, 0.02));
        let first = visited(&a, &b, &pose, kind, 7);
        assert_eq!(first, visited(&a, &b, &pose, kind, 7), "{kind:?}");
        assert_ne!(first, visited(&a, &b, &pose, kind, 8), "{kind:?}");
        let threads: Vec<_> = (0..2)
            .map(|_| {
                let (a, b) = (a.clone(), b.clone());
                std::thread::spawn(move || visited(&a, &b, &pose, kind, 7))
            })
            .collect();
        for thread in threads {
            assert_eq!(first, thread.join().unwrap(), "{kind:?}");
        }
        // A slight push reorders the queue, but a pair that is disjoint in both runs keeps its
        // draw: with `Paper`, whose probability ignores the gap, hardly any pair changes.
        let pushed = Pose::from_translation(Vector3::new(1e-9, 0.0, 0.02));
        let sets = [first, visited(&a, &b, &pushed, kind, 7)].map(BTreeSet::from_iter);
        assert!(sets[0].symmetric_difference(&sets[1]).count() <= sets[0].len() / 100, "{kind:?}");
    }
}

/// Two single leaves, blocks of 5 cm spacing one above the other, `gap` apart.
fn blocks(gap: f64, std: f64) -> [Tree; 2] {
    let settings =
        TreeSettings { max_leaf_points: 1000, max_variation: 1.0 / 3.0, ..Default::default() };
    [0.0, 0.2 + gap].map(|bottom| {
        let at = |i: usize| {
            Point3::new(
                (i % 9) as f64 * 0.05,
                (i / 9 % 7) as f64 * 0.05,
                (i / 63) as f64 * 0.05 + bottom,
            )
        };
        Tree::build((0..315).map(|i| noisy(at(i), std)).collect(), &settings)
            .expect("a usable cloud")
    })
}

#[test]
fn frequencies_match_the_formulas() {
    let std = 0.02;
    for gap in [0.001, 0.01, 0.03] {
        let [a, b] = blocks(gap, std);
        let outside = [&a, &b].map(|tree| 1.0 - tree.root().unwrap().coverage());
        let tail = 2.0 * normal::upper_tail(gap / std);
        let either = |p: f64, q: f64| 1.0 - (1.0 - p) * (1.0 - q);
        let paper = either(outside[0], outside[1]);
        let aware = either(outside[0] * tail, outside[1] * tail);
        assert!(aware > 0.01 && paper < 0.99, "the test needs a chance on both sides");
        for (kind, expected) in [(Traversal::Paper, paper), (Traversal::GapAware, aware)] {
            let runs = 4000;
            let hits = (0..runs)
                .filter(|&s| !visited(&a, &b, &Pose::identity(), kind, s).is_empty())
                .count();
            let frequency = hits as f64 / runs as f64;
            // Five standard errors: a false alarm in 2 million.
            let tolerance = 5.0 * (expected * (1.0 - expected) / runs as f64).sqrt();
            assert!(
                (frequency - expected).abs() < tolerance,
                "{kind:?} at {gap}: {frequency}, not {expected}"
            );
        }
    }
}

#[test]
fn distance_matters_only_when_aware_of_it() {
    // Planes have no thickness, so their coverage is zero: the rule of the paper culls nothing.
    let far = Pose::from_translation(Vector3::new(0.0, 0.0, 1.0));
    let at = |i: usize| Point3::new((i % 30) as f64 * 0.01, (i / 30) as f64 * 0.01, 0.0);
    let a = small_leaves((0..900).map(|i| noisy(at(i), 0.001)).collect());
    let count = |kind| (0..20).map(|s| visited(&a, &a, &far, kind, s).len()).sum::<usize>();
    assert_eq!(count(Traversal::Paper), 20 * a.leaves().count().pow(2));
    assert_eq!(count(Traversal::GapAware), 0);
}

#[test]
fn overlapping_boxes_are_always_descended() {
    let a = small_leaves(bumpy_sheet(1, 200, Vector3::zeros()));
    let overlapping = |kind| -> BTreeSet<(usize, usize)> {
        let mut pairs = BTreeSet::new();
        traverse(&a, &a, &Pose::identity(), &settings(kind), 3, |pair| {
            if pair.gap <= 0.0 {
                pairs.insert((pair.a.index(), pair.b.index()));
            }
            Flow::Continue
        })
        .unwrap();
        pairs
    };
    // Each leaf overlaps itself; on the way down its ancestors overlap themselves.
    for kind in [Traversal::Paper, Traversal::GapAware, Traversal::Certified] {
        let pairs = overlapping(kind);
        assert!(a.leaves().all(|leaf| pairs.contains(&(leaf.id().index(), leaf.id().index()))));
    }
}

#[test]
fn the_bound_of_what_was_culled_is_reported() {
    let [a, b] = blocks(0.01, 0.02);
    let expected = normal::upper_tail(0.005 / 0.02);
    let culled = (0..50)
        .map(|seed| {
            traverse(&a, &b, &Pose::identity(), &settings(Traversal::Paper), seed, |_| {
                Flow::Continue
            })
            .unwrap()
        })
        .find(|outcome| outcome.culled == 1)
        .expect("one of fifty draws culls");
    // Sides and deviations are rounded up to single precision.
    assert!(culled.culled_bound >= expected && culled.culled_bound - expected < 1e-6);
}
