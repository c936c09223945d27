//! Every cloud gives a well-formed tree whose leaves keep the promises of the settings.

use crate::common;
use std::collections::BTreeSet;
use std::iter;
use std::sync::Arc;

use crate::common::{bumpy_sheet, degenerate_clouds, is_kept, noisy};
use cloudtouch_bvh::{
    LeafBounds, Node, NodeId, Primitive, Primitives, Split, Tree, TreeError, TreeSettings, Visit,
};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, Vector3, seed};
use proptest::prelude::*;

#[test]
fn degenerate_clouds_build_well_formed_trees() {
    for (name, cloud) in degenerate_clouds() {
        for (max_leaf_points, min_leaf_points, split) in [
            (1, 1, Split::Median),
            (2, 1, Split::SurfaceArea),
            (12, 6, Split::SurfaceArea),
            (40, 10, Split::Median),
        ] {
            let usual = TreeSettings::default();
            let settings = TreeSettings { max_leaf_points, min_leaf_points, split, ..usual };
            let tree = Tree::build(cloud.clone(), &settings).unwrap();
            tree.validate().unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(tree.len(), cloud.len(), "{name}");
            let in_leaves: usize = tree.leaves().map(|leaf| leaf.primitive_indices().len()).sum();
            assert_eq!(in_leaves, cloud.len(), "{name}");
            assert!(tree.leaves().all(|leaf| leaf.primitive_indices().len() <= max_leaf_points));
        }
    }
}

#[test]
fn leaves_of_any_size_may_be_asked_for() {
    let most = usize::MAX;
    let settings =
        TreeSettings { max_leaf_points: most, min_leaf_points: most, ..TreeSettings::default() };
    let cloud = (0..50).map(|i| noisy(Point3::new(i as f64, 0.0, 0.0), 0.01)).collect();
    assert_eq!(Tree::build(cloud, &settings).unwrap().leaves().count(), 1);
}

#[test]
fn an_empty_tree_has_no_root() {
    let tree = Tree::build(vec![], &TreeSettings::default()).unwrap();
    assert!(tree.is_empty() && tree.root().is_none() && tree.leaves().next().is_none());
    assert_eq!(tree.quality(), 1.0);
}

#[test]
fn leaves_are_flat_unless_too_small_to_split() {
    let settings = TreeSettings { max_leaf_points: 200, ..TreeSettings::default() };
    // A ball full of points: no large part of it is flat.
    let ball = (0..1000)
        .map(|i| Vector3::new((i % 10) as f64, (i / 10 % 10) as f64, (i / 100) as f64))
        .map(|p| noisy(Point3::from(p), 0.01))
        .collect();
    let tree = Tree::build(ball, &settings).unwrap();
    for leaf in tree.leaves() {
        let count = leaf.primitive_indices().len();
        assert!(leaf.moments().variation() <= settings.max_variation || count < 20);
        assert!(count >= settings.min_leaf_points);
    }
    // A plane stays in large leaves.
    let plane = (0..1000).map(|i| noisy(Point3::new((i % 40) as f64, (i / 40) as f64, 0.0), 0.01));
    let tree = Tree::build(plane.collect(), &settings).unwrap();
    assert!(tree.leaves().all(|leaf| leaf.primitive_indices().len() > 100));
}

#[test]
fn siblings_overlap_by_a_part_of_their_parent() {
    for sibling_overlap in [0.001, 0.01, 0.05] {
        let settings = TreeSettings { sibling_overlap, ..TreeSettings::default() };
        let tree = Tree::build(bumpy_sheet(3, 2000, Vector3::zeros()), &settings).unwrap();
        let mut checked = 0;
        tree.visit_nodes(|node| {
            if let Some(children) = node.children() {
                let [left, right] = children.map(|id| tree.node(id).unwrap());
                let axis = node.obb().axes.column(0).into_owned();
                let apart = axis.dot(&(right.obb().centre - left.obb().centre)).abs();
                let reach =
                    left.obb().half_width_along(&axis) + right.obb().half_width_along(&axis);
                let wanted = sibling_overlap * 2.0 * node.obb().half_extents[0];
                assert!(reach - apart >= wanted - 1e-12, "{} < {wanted}", reach - apart);
                checked += 1;
            }
            Visit::Descend
        });
        assert!(checked > 40);
    }
}

/// They were made to touch, whatever lay between them.
#[test]
fn without_an_overlap_siblings_keep_to_what_they_hold() {
    let settings = TreeSettings { sibling_overlap: 0.0, ..TreeSettings::default() };
    let sheet = |x: f64| bumpy_sheet(3, 300, Vector3::new(x, 0.0, 0.0));
    let tree = Tree::build([sheet(0.0), sheet(3.0)].concat(), &settings).unwrap();
    let root = tree.root().unwrap();
    let [left, right] = root.children().unwrap().map(|id| tree.node(id).unwrap().obb());
    let axis = root.obb().axes.column(0).into_owned();
    let apart = axis.dot(&(right.centre - left.centre)).abs();
    assert!(apart - left.half_width_along(&axis) - right.half_width_along(&axis) > 0.5);
}

#[test]
fn pruning_leaves_out_what_is_below() {
    let tree = common::small_leaves(bumpy_sheet(3, 600, Vector3::zeros()));
    let mut all = 0;
    tree.visit_nodes(|_| {
        all += 1;
        Visit::Descend
    });
    assert_eq!(all, 2 * tree.leaves().count() - 1);
    let mut visited = Vec::new();
    tree.visit_nodes(|node| {
        visited.push(node.id());
        if node.parent().is_some() { Visit::Prune } else { Visit::Descend }
    });
    let root = tree.root().unwrap();
    let [left, right] = root.children().unwrap();
    assert_eq!(visited, [root.id(), left, right]);
}

#[test]
fn coverage_falls_with_the_noise_and_is_one_without() {
    let with = |std| {
        let cloud = (0..900)
            .map(|i| noisy(Point3::new((i % 30) as f64 * 0.1, (i / 30) as f64 * 0.1, 0.0), std));
        let tree = Tree::build(cloud.collect(), &TreeSettings::default()).unwrap();
        let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
        mean(tree.leaves().map(|leaf| leaf.coverage()).collect())
    };
    assert_eq!(with(0.0), 1.0);
    // A plane has no thickness but rounding: any noise along the normal leaves the box.
    assert!(with(0.001) < 1e-9);
    // A full block has: only points near a face leak.
    let block = |std: f64| {
        let cloud = (0..8000)
            .map(|i| Point3::new((i % 20) as f64, (i / 20 % 20) as f64, (i / 400) as f64))
            .map(|p| noisy(p, std));
        let settings =
            TreeSettings { max_leaf_points: 8000, max_variation: 1.0 / 3.0, ..Default::default() };
        Tree::build(cloud.collect(), &settings).unwrap().root().unwrap().coverage()
    };
    assert!(block(0.01) > block(1.0) && block(1.0) > block(5.0));
    assert!(block(0.01) > 0.8 && block(5.0) > 0.0);
}

#[test]
fn bounds_cover_every_point_in_every_direction() {
    let needle = Covariance::from_axis(
        &UnitVector3::new_unchecked(Vector3::new(0.6, 0.0, 0.8)),
        0.05,
        0.001,
    );
    let cloud: Vec<_> = (0..300)
        .map(|i| {
            let mean = Point3::new((i % 20) as f64 * 0.1, (i / 20) as f64 * 0.1, 0.0);
            Primitive::point(UncertainPoint { mean, covariance: needle })
        })
        .collect();
    let tree = Tree::build(cloud, &TreeSettings::default()).unwrap();
    tree.visit_nodes(|node| {
        assert!(is_kept(node.max_std(), 0.05));
        for direction in [Vector3::x(), Vector3::y(), Vector3::z(), Vector3::new(0.8, 0.0, -0.6)] {
            let bound = node.std_along(&direction);
            assert!(bound >= needle.std_along(&direction) - 1e-15 && bound <= node.max_std());
        }
        Visit::Descend
    });
    // Exact along the axes of a leaf's box, where gaps between flat patches are measured.
    for leaf in tree.leaves() {
        for k in 0..3 {
            let axis = leaf.obb().axes.column(k).into_owned();
            let more = leaf.std_along(&axis) - needle.std_along(&axis);
            assert!((-1e-12..1e-8).contains(&more));
        }
    }
}

#[test]
fn bad_input_is_named() {
    let settings = TreeSettings::default();
    let good = noisy(Point3::origin(), 0.01);
    let build = |primitive| Tree::build(vec![good, primitive], &settings).unwrap_err();
    let nan = noisy(Point3::new(0.0, f64::NAN, 0.0), 0.01);
    assert!(matches!(build(nan), TreeError::Coordinate { index: 1, value } if value.is_nan()));
    let infinite = Primitive::Triangle([
        Point3::origin(),
        Point3::origin(),
        Point3::new(0.0, f64::INFINITY, 0.0),
    ]);
    assert!(matches!(build(infinite), TreeError::Coordinate { index: 1, .. }));
    let covariance = Covariance::isotropic(f64::INFINITY);
    let unsure = Primitive::point(UncertainPoint { mean: Point3::origin(), covariance });
    assert!(matches!(build(unsure), TreeError::Covariance { index: 1, .. }));
    let point = UncertainPoint::exact(Point3::origin());
    let heavy = Primitive::Point { point, weight: -1.0 };
    assert!(matches!(build(heavy), TreeError::Weight { index: 1, value: -1.0 }));

    for (name, bad) in [
        ("max_leaf_points", TreeSettings { max_leaf_points: 0, ..settings }),
        ("min_leaf_points", TreeSettings { min_leaf_points: 41, ..settings }),
        ("min_leaf_points", TreeSettings { min_leaf_points: 0, ..settings }),
        ("max_variation", TreeSettings { max_variation: f64::NAN, ..settings }),
        ("sibling_overlap", TreeSettings { sibling_overlap: -0.01, ..settings }),
    ] {
        let error = Tree::build(vec![good], &bad).unwrap_err();
        assert!(
            matches!(error, TreeError::Setting { name: found, .. } if found == name),
            "{error}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn random_clouds_with_ties_build_well_formed_trees(
        // Few distinct coordinates make duplicates and shared coordinates common.
        cells in prop::collection::vec((0..6_i32, 0..4_i32, 0..2_i32), 1..300),
        offset in prop_oneof![Just(0.0), Just(5e6)],
        max_leaf_points in 1..50_usize,
        max_variation in 0.0..0.33_f64,
    ) {
        let cloud = cells
            .iter()
            .map(|&(x, y, z)| Point3::new(x as f64 * 0.01 + offset, y as f64 * 0.01, z as f64))
            .map(|mean| noisy(mean, 0.002))
            .collect();
        let settings = TreeSettings {
            max_leaf_points,
            min_leaf_points: 1 + max_leaf_points / 4,
            max_variation,
            ..Default::default()
        };
        let tree = Tree::build(cloud, &settings.clone()).unwrap();
        prop_assert_eq!(tree.validate(), Ok(()));
    }
}

/// Bounds given while it is built are those given after it, points listed by their places alone are those
/// listed one by one, and a tree that one thread builds is one that many build, to the last name.
#[test]
fn a_tree_built_with_bounds_is_one_that_is_given_them() {
    const POINTS: usize = 6000;
    let settings = TreeSettings::default();
    let covariance = Covariance::isotropic(1e-4);
    let mut means: Vec<Point3> =
        bumpy_sheet(5, POINTS - 2, Vector3::zeros()).iter().map(|p| p.centroid()).collect();
    means.extend([Point3::new(0.0, 50.0, 9.0), Point3::new(-70.0, 0.0, 3.0)]);
    let point = |&mean: &Point3| Primitive::point(UncertainPoint { mean, covariance });
    let listed: Vec<Primitive> = means.iter().map(point).collect();
    let mut after = Tree::build(listed.clone(), &settings).unwrap();
    let bounds_of = |leaf: Node<'_>| {
        let std = leaf.obb().radius();
        LeafBounds { std, shift: 0.1 * std, reach: 0.2 * std }
    };
    let told = |tree: &Tree| {
        let mut told = Vec::new();
        let mut next: Vec<NodeId> = tree.root().map(|root| root.id()).into_iter().collect();
        while let Some(id) = next.pop() {
            let node = tree.node(id).unwrap();
            let bounds = [node.max_std(), node.shift(), node.reach(), node.coverage()];
            let along = node.std_along(&Vector3::new(0.6, 0.0, 0.8));
            let shape = (node.obb(), node.moments());
            told.push((id, node.primitive_indices().to_vec(), bounds, along, shape));
            next.extend(node.children().into_iter().flatten());
        }
        told
    };
    let unbounded = told(&after);
    after.set_leaf_bounds(bounds_of).unwrap();
    assert_ne!(told(&after), unbounded);
    let alike = Primitives::Alike { means: Arc::new(means), covariance };
    for (primitives, threads) in
        [(Primitives::Each(listed.clone()), 1), (Primitives::Each(listed.clone()), 4), (alike, 3)]
    {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let of_leaf = |_: &Tree, leaf: Node<'_>| (bounds_of(leaf), leaf.id());
        let build = || Tree::build_bounded(primitives, &settings, of_leaf);
        let (built, leaves) = pool.install(build).unwrap();
        assert!(leaves.into_iter().eq(built.leaves().map(|leaf| leaf.id())));
        assert_eq!(told(&built), told(&after));
        assert_eq!(built.validate(), Ok(()));
        assert!((0..POINTS).all(|index| built.primitive(index) == Some(listed[index])));
    }
    let nothing_known =
        |_: &Tree, _: Node<'_>| (LeafBounds { std: f64::NAN, shift: 0.0, reach: 0.0 }, ());
    let refused = Tree::build_bounded(Primitives::Each(listed), &settings, nothing_known);
    assert!(matches!(refused, Err(TreeError::LeafBounds { .. })));
    let far = vec![Point3::origin(), Point3::new(1e101, 0.0, 0.0)];
    let far = Primitives::Alike { means: Arc::new(far), covariance };
    let refused = Tree::build_bounded(far, &settings, |_, leaf| (bounds_of(leaf), ()));
    assert!(matches!(refused, Err(TreeError::Coordinate { index: 1, .. })));
}

/// They were spelled in all of their digits, three hundred at most.
#[test]
fn numbers_in_messages_are_short() {
    let settings = TreeSettings::default();
    let message = |point| {
        let refused = Tree::build(vec![Primitive::point(point)], &settings);
        refused.unwrap_err().to_string()
    };
    let far = message(UncertainPoint::exact(Point3::new(0.0, -1e300, 0.0)));
    assert!(far.starts_with("primitive 0 has the coordinate -1e300: "), "{far}");
    let covariance = Covariance::isotropic(1e200);
    let blurred = message(UncertainPoint { mean: Point3::origin(), covariance });
    assert!(blurred.contains("has the entry 1e200: ") && blurred.len() < 120, "{blurred}");
}

/// A return from far away stretched the box of the root, and turned every cut below.
#[test]
fn what_is_far_leaves_the_tree_over_the_rest_as_it_is() {
    let leaves = |far: &[Point3]| -> BTreeSet<Vec<u32>> {
        let mut cloud = bumpy_sheet(3, 600, Vector3::zeros());
        let count = cloud.len() as u32;
        cloud.extend(far.iter().map(|&place| noisy(place, 0.01)));
        let tree = common::small_leaves(cloud);
        tree.validate().unwrap();
        let of_sheet = |leaf: &Node<'_>| leaf.primitive_indices().iter().all(|&i| i < count);
        tree.leaves().filter(of_sheet).map(|leaf| leaf.primitive_indices().to_vec()).collect()
    };
    let far = [30.0, -40.0, 1e6].map(|x| Point3::new(x, 0.3 * x, 5.0));
    let plain = leaves(&[]);
    assert!(plain.len() > 20);
    assert_eq!(plain, leaves(&far[..1]));
    assert_eq!(plain, leaves(&far));
}

/// Each round set apart a few, with no end to the rounds: 20,000 points were 1044 levels deep, and 200,000 overflowed
/// the stack.
#[test]
fn what_was_ever_farther_made_the_tree_a_thousand_levels_deep() {
    const POINTS: u64 = 20_000;
    let along = |i: u64| {
        let distance = (i as f64 / POINTS as f64).powf(2.0005);
        if i.is_multiple_of(2) { distance } else { -distance }
    };
    let aside = |i: u64, k| 1e-3 * along(i) * seed::unit(seed::derive(1, i, k));
    let place = |i| Point3::new(along(i), aside(i, 0), aside(i, 1));
    let cloud = (1..=POINTS).map(|i| Primitive::point(UncertainPoint::exact(place(i)))).collect();
    let tree = Tree::build(cloud, &TreeSettings::default()).unwrap();
    let above = |id: &NodeId| tree.node(*id).and_then(|node| node.parent());
    let depth = |leaf: Node<'_>| iter::successors(leaf.parent(), above).count();
    let deepest = tree.leaves().map(depth).max();
    assert!((15..60).contains(&deepest.unwrap()), "{deepest:?}");
}

/// A limit of 1e200 was told of entries that are refused from 1e74 on.
#[test]
fn the_limit_that_is_told_is_the_one_that_was_exceeded() {
    let point = |variance: f64| {
        let (mean, covariance) = (Point3::origin(), Covariance::isotropic(variance));
        Primitive::point(UncertainPoint { mean, covariance })
    };
    let build = |variance| Tree::build(vec![point(variance)], &TreeSettings::default());
    let told = |error: TreeError| -> f64 {
        let text = error.to_string();
        let (_, limit) = text.split_once("below ").expect("a limit is told");
        limit.split_whitespace().next().unwrap_or_default().parse().expect("a number")
    };
    for value in [1.01e74, 1e100, 1e190] {
        assert!(told(build(value).unwrap_err()) < value);
        let mut tree = build(1.0).unwrap();
        let refused = tree.set_extents(vec![Covariance::isotropic(value)]);
        assert!(told(refused.unwrap_err()) < value);
    }
    assert!(build(0.99e74).is_ok());
}
