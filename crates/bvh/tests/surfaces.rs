//! What the search among surfaces leaves out is as far apart as it says.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use std::collections::{BTreeMap, BTreeSet};

use crate::common::{bumpy_sheet, noisy};
use cloudtouch_bvh::{
    LeafBounds, NodeId, Primitive, Settled, Sought, SurfaceFlow, SurfaceOutcome, Tree, TreeError,
    TreeSettings, urgency_of_roots, visit_surfaces,
};
use cloudtouch_geom::{
    Covariance, Drift, Motion, Point3, Pose, UncertainPoint, UnitVector3, Vector3, seed,
};
use proptest::prelude::*;

fn small_leaves(primitives: Vec<Primitive>) -> Tree {
    let settings =
        TreeSettings { max_leaf_points: 8, min_leaf_points: 2, ..TreeSettings::default() };
    Tree::build(primitives, &settings).unwrap()
}

/// Discs about a bumpy sheet: thin across it and wide along it.
fn discs(stream: u64, count: usize) -> Vec<Primitive> {
    let disc = |(i, primitive): (usize, Primitive)| {
        let draw = |k| seed::unit(seed::derive(stream, i as u64, k)) - 0.5;
        let normal = UnitVector3::new_normalize(Vector3::new(draw(7), draw(8), 1.0));
        let covariance = Covariance::from_axis(&normal, 0.002, 0.03 + 0.02 * draw(9));
        Primitive::point(UncertainPoint { mean: primitive.centroid(), covariance })
    };
    bumpy_sheet(stream, count, Vector3::zeros()).into_iter().enumerate().map(disc).collect()
}

fn sought(within: f64) -> Sought {
    Sought { within, margin: 0.0, crossings: true, drift: None }
}

type Pairs = BTreeSet<(NodeId, NodeId)>;

/// The leaf pairs visited, and among these those that may cross.
fn visited((a, b): (&Tree, &Tree), pose: &Pose, within: f64) -> (Pairs, Pairs, SurfaceOutcome) {
    let (mut all, mut crossing) = (BTreeSet::new(), BTreeSet::new());
    let outcome = visit_surfaces((a, b), pose, sought(within), |pair| {
        assert!(all.insert((pair.a, pair.b)), "visited twice");
        assert!(pair.may_cross || pair.deviations < within);
        if pair.may_cross {
            crossing.insert((pair.a, pair.b));
        }
        SurfaceFlow::Within(within)
    });
    (all, crossing, outcome.unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(60) })]

    /// Two points whose surfaces, balls here, have a place in common are in a pair that is visited,
    /// whether the reach was said by leaf or by point.
    #[test]
    fn surfaces_that_may_cross_are_visited(
        streams in (0..1000_u64, 0..1000_u64),
        offset in prop::array::uniform3(-0.5..0.5_f64),
        angles in prop::array::uniform3(-3.1..3.1_f64),
        reach in prop::array::uniform2(0.0..0.15_f64),
        by_leaf in any::<bool>(),
    ) {
        let pose = Pose::from_translation_rpy(Vector3::from(offset), angles);
        let mut trees = [(streams.0, 150), (streams.1 + 1000, 120)]
            .map(|(stream, count)| small_leaves(bumpy_sheet(stream, count, Vector3::zeros())));
        for (tree, reach) in trees.iter_mut().zip(reach) {
            if by_leaf {
                tree.set_leaf_bounds(|_| LeafBounds { std: 0.0, shift: 0.0, reach }).unwrap();
            } else {
                let extent = Covariance::isotropic(reach * reach);
                tree.set_extents(vec![extent; tree.index_count()]).unwrap();
            }
            tree.validate().unwrap();
        }
        let [a, b] = &trees;
        // Nothing but crossings is looked for.
        let (_, crossing, outcome) = visited((a, b), &pose, 0.0);
        for i in 0..a.index_count() {
            for j in 0..b.index_count() {
                let from = a.primitive(i).unwrap().centroid();
                let to = pose.transform_point(&b.primitive(j).unwrap().centroid());
                let leaves = (a.leaf_of(i).unwrap(), b.leaf_of(j).unwrap());
                if crossing.contains(&leaves) {
                    continue;
                }
                let apart = (to - from).norm() - reach[0] - reach[1];
                prop_assert!(apart >= outcome.apart && apart > 0.0, "{i} and {j} share a place");
            }
        }
    }

    /// A search that goes on by trees with narrower boxes comes by all that those have to be looked at
    /// for, and by no pair twice.
    #[test]
    fn going_on_by_narrower_trees_leaves_out_nothing_more(
        streams in (0..1000_u64, 0..1000_u64),
        offset in prop::array::uniform3(-0.4..0.4_f64),
        angles in prop::array::uniform3(-3.1..3.1_f64),
        within in 0.5..8.0_f64,
        after in 1_usize..60,
    ) {
        let pose = Pose::from_translation_rpy(Vector3::from(offset), angles);
        let narrow = [(streams.0, 150), (streams.1 + 1000, 120)]
            .map(|(stream, count)| small_leaves(discs(stream, count)));
        let mut loose = narrow.clone();
        for tree in &mut loose {
            tree.set_leaf_bounds(|_| LeafBounds { std: 0.1, shift: 0.05, reach: 0.1 }).unwrap();
        }
        let mut all = BTreeSet::new();
        let outcome = visit_surfaces((&loose[0], &loose[1]), &pose, sought(within), |pair| {
            assert!(all.insert((pair.a, pair.b)), "visited twice");
            match all.len() == after {
                true => SurfaceFlow::WithinBy(within, narrow.each_ref()),
                false => SurfaceFlow::Within(within),
            }
        }).unwrap();
        let (of_narrow, _, _) = visited((&narrow[0], &narrow[1]), &pose, within);
        let (of_loose, _, _) = visited((&loose[0], &loose[1]), &pose, within);
        prop_assert!(all.is_superset(&of_narrow) && all.is_subset(&of_loose));
        prop_assert!(all.len() <= of_narrow.len() + after);
        prop_assert!(outcome.deviations >= within);
    }

    /// Of a leaf that is settled no more pairs come, and of the others all.
    #[test]
    fn of_a_settled_leaf_no_more_pairs_come(
        streams in (0..1000_u64, 0..1000_u64),
        offset in prop::array::uniform3(-0.3..0.3_f64),
        angles in prop::array::uniform3(-3.1..3.1_f64),
        within in 0.5..8.0_f64,
        is_a in any::<bool>(),
        after in 1_usize..6,
    ) {
        let pose = Pose::from_translation_rpy(Vector3::from(offset), angles);
        let [a, b] = [(streams.0, 150), (streams.1 + 1000, 120)]
            .map(|(stream, count)| small_leaves(discs(stream, count)));
        let which = if is_a { Settled::A } else { Settled::B };
        let leaf_of = |a: NodeId, b: NodeId| if is_a { a } else { b };
        let mut found: BTreeMap<NodeId, usize> = BTreeMap::new();
        visit_surfaces((&a, &b), &pose, sought(within), |pair| {
            let pairs = found.entry(leaf_of(pair.a, pair.b)).or_default();
            *pairs += 1;
            if *pairs < after {
                SurfaceFlow::Within(within)
            } else {
                SurfaceFlow::WithinSettled(within, which)
            }
        }).unwrap();
        let (all, _, _) = visited((&a, &b), &pose, within);
        let mut expected: BTreeMap<NodeId, usize> = BTreeMap::new();
        for (a, b) in all {
            let pairs = expected.entry(leaf_of(a, b)).or_default();
            *pairs = after.min(*pairs + 1);
        }
        prop_assert_eq!(found, expected);
    }

    /// Every two points, one of each tree, that are not in a pair that was visited have as many
    /// deviations between them as the outcome says, and at least those asked for.
    #[test]
    fn what_is_left_out_has_as_many_deviations_as_said(
        streams in (0..1000_u64, 0..1000_u64),
        offset in prop::array::uniform3(-0.4..0.4_f64),
        angles in prop::array::uniform3(-3.1..3.1_f64),
        within in 0.5..8.0_f64,
    ) {
        let pose = Pose::from_translation_rpy(Vector3::from(offset), angles);
        let (a, b) = (small_leaves(discs(streams.0, 150)), small_leaves(discs(streams.1 + 1000, 120)));
        let (all, _, outcome) = visited((&a, &b), &pose, within);
        prop_assert_eq!(outcome.leaf_pairs, all.len());
        prop_assert!(outcome.deviations >= within);
        let point = |tree: &Tree, i: usize| match tree.primitive(i) {
            Some(Primitive::Point { point, .. }) => point,
            _ => unreachable!(),
        };
        for i in 0..a.index_count() {
            for j in 0..b.index_count() {
                if all.contains(&(a.leaf_of(i).unwrap(), b.leaf_of(j).unwrap())) {
                    continue;
                }
                let (p, q) = (point(&a, i), Motion::from(&pose).uncertain_point(&point(&b, j)));
                let joint = p.covariance.sum(&q.covariance).matrix();
                let offset = q.mean - p.mean;
                let squared = offset.dot(&(joint.try_inverse().unwrap() * offset));
                prop_assert!(squared.sqrt() >= outcome.deviations * (1.0 - 1e-9));
            }
        }
    }
}

#[test]
fn who_stops_is_told_nothing_of_the_rest() {
    let tree = small_leaves(bumpy_sheet(1, 100, Vector3::zeros()));
    let outcome =
        visit_surfaces((&tree, &tree), &Pose::identity(), sought(6.0), |_| SurfaceFlow::Stop)
            .unwrap();
    assert!(outcome.stopped);
    assert_eq!(
        (outcome.leaf_pairs, outcome.deviations, outcome.apart),
        (1, 0.0, f64::NEG_INFINITY)
    );
}

#[test]
fn exact_points_at_one_place_are_visited_and_others_infinitely_far() {
    let exact = |x: f64| small_leaves(vec![noisy(Point3::new(x, 0.0, 0.0), 0.0)]);
    let (here, there) = (exact(0.0), exact(1e-3));
    assert_eq!(visited((&here, &here), &Pose::identity(), 6.0).0.len(), 1);
    let (all, _, outcome) = visited((&here, &there), &Pose::identity(), 6.0);
    assert_eq!((all.len(), outcome.deviations), (0, f64::INFINITY));
    assert!((outcome.apart - 1e-3).abs() < 1e-12);
}

#[test]
fn a_pose_that_is_not_finite_is_refused_and_an_empty_tree_has_no_pairs() {
    let some = small_leaves(bumpy_sheet(1, 20, Vector3::zeros()));
    let empty = small_leaves(Vec::new());
    let (all, _, outcome) = visited((&empty, &some), &Pose::identity(), 6.0);
    assert_eq!((all.len(), outcome.deviations, outcome.stopped), (0, f64::INFINITY, false));
    let bad = Pose::from_translation(Vector3::new(f64::NAN, 0.0, 0.0));
    let error =
        visit_surfaces((&some, &some), &bad, sought(6.0), |_| SurfaceFlow::Stop).unwrap_err();
    assert!(matches!(error, TreeError::Pose { .. }));
}

/// It left nothing out, so that all pairs of leaves were visited.
#[test]
fn deviations_that_are_no_number_are_refused() {
    let some = small_leaves(bumpy_sheet(1, 20, Vector3::zeros()));
    let (pose, asked) = (Pose::identity(), sought(f64::NAN));
    let search = visit_surfaces((&some, &some), &pose, asked, |_| SurfaceFlow::Stop).map(drop);
    let roots = urgency_of_roots((&some, &some), &pose, asked).map(drop);
    for found in [search, roots] {
        assert!(matches!(found, Err(TreeError::Setting { name: "within", .. })), "{found:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(40) })]

    /// What is left out of a search along a drift has as many deviations anywhere on the way, and
    /// surfaces that meet there are visited.
    #[test]
    fn a_drift_leaves_out_nothing_that_comes_near_on_the_way(
        streams in (0..1000_u64, 0..1000_u64),
        offset in prop::array::uniform3(-0.6..0.6_f64),
        linear in prop::array::uniform3(-0.2..0.2_f64),
        yaw in -0.5..0.5_f64,
        within in 0.5..8.0_f64,
        s in -1.0..1.0_f64,
    ) {
        let (mut a, mut b) =
            (small_leaves(discs(streams.0, 100)), small_leaves(discs(streams.1 + 1000, 80)));
        let reach = 0.02;
        for tree in [&mut a, &mut b] {
            tree.set_extents(vec![Covariance::isotropic(reach * reach); tree.index_count()]).unwrap();
        }
        let pose = Pose::from_translation(Vector3::from(offset));
        let (linear, angular) = (Vector3::from(linear), Vector3::z() * yaw);
        let pivot = Point3::new(0.3, -0.2, 0.1);
        let drift = Some(Drift::new(pivot, linear, angular));
        let sought = Sought { drift, ..sought(within) };
        let mut all = BTreeSet::new();
        let outcome = visit_surfaces((&a, &b), &pose, sought, |pair| {
            all.insert((pair.a, pair.b));
            SurfaceFlow::Within(within)
        }).unwrap();
        let turn = Pose::from_translation_rpy(Vector3::zeros(), [0.0, 0.0, yaw * s]);
        let moves = |place: Point3| {
            pivot + linear * s + turn.transform_vector(&(place - pivot))
        };
        let point = |tree: &Tree, i: usize| match tree.primitive(i) {
            Some(Primitive::Point { point, .. }) => point,
            _ => unreachable!(),
        };
        for i in 0..a.index_count() {
            for j in 0..b.index_count() {
                if all.contains(&(a.leaf_of(i).unwrap(), b.leaf_of(j).unwrap())) {
                    continue;
                }
                let (p, q) = (point(&a, i), Motion::from(&pose).uncertain_point(&point(&b, j)));
                let turned = Motion::from(&turn).covariance(&q.covariance);
                let joint = p.covariance.sum(&turned).matrix();
                let offset = moves(q.mean) - p.mean;
                let squared = offset.dot(&(joint.try_inverse().unwrap() * offset));
                prop_assert!(squared.sqrt() >= outcome.deviations * (1.0 - 1e-9));
                prop_assert!(squared.sqrt() >= within * (1.0 - 1e-9));
                prop_assert!(offset.norm() > 2.0 * reach);
            }
        }
    }
}
