//! Traversal of two trees: node pairs best first, leaf pairs to the caller, a bound on the rest.

mod examine;
mod leakage;

use std::collections::BinaryHeap;

use cloudtouch_geom::{Pose, Vector3, normal};

use crate::queue::Queued;
use crate::traverse::examine::{Examined, Examiner};
use crate::traverse::leakage::bound_at;
use crate::{NodeId, TraversalSettings, Tree, TreeError};

/// Two leaves whose points may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeafPair {
    /// Leaf of the first tree.
    pub a: NodeId,
    /// Leaf of the second tree.
    pub b: NodeId,
    /// Signed distance (m) of the two boxes along `axis`, each grown by its shift; see
    /// [`crate::Gap::signed`].
    pub gap: f64,
    /// Unit vector of the axis along which the surfaces are farthest apart, in the frame of the
    /// first tree, toward the second.
    pub axis: Vector3,
    /// No point of either leaf has a higher collision probability than this: Φ(−gap/(2σ)) where the
    /// surfaces are apart, else 1.
    pub bound: f64,
}

/// Whether to go on after a leaf pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Flow {
    /// On to the next pair.
    Continue,
    /// On to the next pair whose [`LeafPair::bound`] is above this: the caller knows of a point as
    /// probable, or does not care for less. What is left out counts as culled.
    Above(f64),
    /// No further pairs.
    Stop,
}

/// What a traversal did, and what the part it left out could hold.
///
/// With p the largest collision probability found in the leaf pairs visited, the true maximum over
/// all points lies in [p, max(p, `culled_bound`, `pending_bound`)].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Node pairs whose boxes were tested.
    pub nodes_visited: usize,
    /// Leaf pairs handed to the caller.
    pub leaf_pairs: usize,
    /// Node pairs culled.
    pub culled: usize,
    /// No point below a culled pair has a higher collision probability than this: the largest
    /// Φ(−δ/(2σ)) of them, 0 when none was culled.
    pub culled_bound: f64,
    /// Whether the caller stopped it.
    pub stopped: bool,
    /// The same bound for the pairs that were left when the caller stopped; 0 when none was.
    pub pending_bound: f64,
}

impl Default for Outcome {
    /// Of a traversal that found nothing to visit.
    fn default() -> Self {
        Self {
            nodes_visited: 0,
            leaf_pairs: 0,
            culled: 0,
            culled_bound: 0.0,
            stopped: false,
            pending_bound: 0.0,
        }
    }
}

/// Visits the pairs of leaves, one of each tree, that may touch; which those are is said by
/// [`crate::Traversal`].
///
/// `a_from_b` maps the frame of `b` into that of `a`; it may change between calls, the trees need
/// not. Best first: overlapping pairs before disjoint ones, among the former the deepest overlap
/// relative to the smaller node (in metres the large nodes would all come before the first leaf),
/// among the latter the smallest gap; ties by node name. Of a pair the larger node is descended.
///
/// The bound concerns the refined points ([`Tree::set_leaf_bounds`]): gaps are reduced by the
/// shifts of both nodes and by the rounding of the pose, and σ is the larger of the two bounds on
/// the standard deviation along the axis of the gap. It holds in all three traversals. The
/// stochastic ones draw from `seed` and the names of the two nodes alone, so neither the order of
/// visits nor the number of threads matters; [`crate::Traversal::Certified`] draws nothing.
///
/// An empty tree has no pairs: the outcome is all zeros, and it is for the caller to say what that
/// means.
///
/// # Errors
/// When a setting is out of range or the pose is not finite.
pub fn traverse(
    a: &Tree,
    b: &Tree,
    a_from_b: &Pose,
    settings: &TraversalSettings,
    seed: u64,
    visit: impl FnMut(LeafPair) -> Flow,
) -> Result<Outcome, TreeError> {
    settings.validate()?;
    if let Some(value) = a_from_b.non_finite_entry() {
        return Err(TreeError::Pose { value });
    }
    Ok(walk(a, b, a_from_b, settings, seed, visit, |_| {}))
}

/// The traversal, which also shows the pairs it culls; `settings` and the pose are checked.
fn walk(
    a: &Tree,
    b: &Tree,
    a_from_b: &Pose,
    settings: &TraversalSettings,
    seed: u64,
    mut visit: impl FnMut(LeafPair) -> Flow,
    mut on_culled: impl FnMut(&Examined),
) -> Outcome {
    let mut outcome = Outcome::default();
    let (Some(root_a), Some(root_b)) = (a.root, b.root) else { return outcome };
    let examiner = Examiner::new(a, b, root_a, root_b, *a_from_b, *settings, seed);
    let mut queue = BinaryHeap::new();
    // δ/(2σ), the least of what was culled.
    let mut culled_deviations = f64::INFINITY;
    let mut cull = |pair: &Examined, outcome: &mut Outcome| {
        outcome.culled += 1;
        culled_deviations = culled_deviations.min(pair.deviations);
        on_culled(pair);
    };
    let mut found = vec![(root_a, root_b)];
    let mut wanted_within = f64::INFINITY;
    loop {
        for ids in found.drain(..) {
            let pair = examiner.examine(ids, wanted_within);
            outcome.nodes_visited += 1;
            if pair.descend {
                queue.push(Queued::new(pair.urgency, (pair.a, pair.b), pair));
            } else {
                cull(&pair, &mut outcome);
            }
        }
        let Some(Queued { item: pair, .. }) = queue.pop() else { break };
        if pair.deviations >= wanted_within {
            cull(&pair, &mut outcome);
        } else if let Some(narrower) = examiner.narrower_pairs(&pair) {
            found.extend(narrower);
        } else {
            outcome.leaf_pairs += 1;
            match visit(LeafPair::from(pair)) {
                Flow::Continue => {}
                Flow::Above(bound) => wanted_within = wanted_within.min(-normal::quantile(bound)),
                Flow::Stop => {
                    outcome.stopped = true;
                    let deviations = queue.iter().map(|queued| queued.item.deviations);
                    outcome.pending_bound = bound_at(deviations.fold(f64::INFINITY, f64::min));
                    break;
                }
            }
        }
    }
    outcome.culled_bound = bound_at(culled_deviations);
    outcome
}

impl From<Examined> for LeafPair {
    fn from(pair: Examined) -> Self {
        let Examined { a, b, gap, axis, deviations, .. } = pair;
        Self { a: NodeId(a), b: NodeId(b), gap, axis, bound: bound_at(deviations) }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, normal, seed};
    use proptest::prelude::*;

    use super::*;
    use crate::{LeafBounds, Primitive, Traversal, TreeSettings};

    /// A noisy, slightly curved sheet; the noise differs from point to point and by direction, and
    /// every tenth primitive is a triangle.
    fn sheet(stream: u64, count: u64, noise: f64) -> Vec<Primitive> {
        (0..count)
            .map(|i| {
                let draw = |k| seed::unit(seed::derive(stream, i, k));
                let (x, y) = (draw(0) - 0.5, draw(1) - 0.5);
                let mean = Point3::new(x, y, 0.3 * (x * x + y * y) + 0.01 * draw(2));
                if i % 10 == 0 {
                    let corner =
                        |k| mean + 0.1 * Vector3::new(draw(k), draw(k + 1), 0.1 * draw(k + 2));
                    return Primitive::Triangle([mean, corner(10), corner(20)]);
                }
                let ray =
                    UnitVector3::new_normalize(Vector3::new(draw(3) - 0.5, draw(4) - 0.5, 1.0));
                let covariance = Covariance::from_axis(&ray, noise * (0.5 + draw(5)), 0.2 * noise);
                Primitive::Point { point: UncertainPoint { mean, covariance }, weight: draw(6) }
            })
            .collect()
    }

    fn leaves_below(tree: &Tree, id: NodeId) -> Vec<u32> {
        let leaf = |&id: &u32| tree.leaf(NodeId(id)).is_some();
        tree.preorder(Some(id.0)).into_iter().filter(leaf).collect()
    }

    /// Every point of `id` lies on its side of the plane with a probability below `bound`, even
    /// when its mean moves by `shift` and its deviation becomes `std` where those are given.
    fn check_side(
        tree: &Tree,
        id: NodeId,
        a_from_tree: &Pose,
        outward: &Vector3,
        plane: f64,
        refined: Option<LeafBounds>,
        bound: f64,
    ) {
        for &index in tree.node(id).unwrap().primitive_indices() {
            let primitive = tree.primitive(index as usize).unwrap();
            for corner in primitive.corners() {
                let margin = plane - outward.dot(&a_from_tree.transform_point(corner).coords);
                let along = a_from_tree.inverse().transform_vector(outward);
                let own = LeafBounds { std: primitive.std_along(&along), shift: 0.0, reach: 0.0 };
                let LeafBounds { std, shift, .. } = refined.unwrap_or(own);
                let probability = normal::below_zero(margin - shift, std);
                assert!(
                    probability <= bound * (1.0 + 1e-6) + 1e-300,
                    "point {index}: {probability} > {bound}"
                );
            }
        }
    }

    fn check_culls_are_certified(
        kind: Traversal,
        noise: f64,
        a_from_b: &Pose,
        refined: Option<LeafBounds>,
    ) {
        let settings = TreeSettings { max_leaf_points: 12, ..TreeSettings::default() };
        let mut a = Tree::build(sheet(1, 300, noise), &settings).unwrap();
        let mut b = Tree::build(sheet(2, 260, noise), &settings).unwrap();
        if let Some(bounds) = refined {
            a.set_leaf_bounds(|_| bounds).unwrap();
            b.set_leaf_bounds(|_| bounds).unwrap();
        }
        let traversal = TraversalSettings { kind, cull_deviations: 3.72 };
        let (mut visited, mut culled) = (BTreeSet::new(), BTreeSet::new());
        let mut highest = 0.0_f64;
        let on_pair = |pair: LeafPair| {
            assert!(visited.insert((pair.a.0, pair.b.0)), "visited twice");
            Flow::Continue
        };
        let on_culled = |pair: &Examined| {
            let pair = LeafPair::from(*pair);
            highest = highest.max(pair.bound);
            for leaf_a in leaves_below(&a, pair.a) {
                for leaf_b in leaves_below(&b, pair.b) {
                    assert!(culled.insert((leaf_a, leaf_b)), "culled twice");
                }
            }
            // The mid-plane of the gap: half way between the two facing supports.
            let obb_a = a.node(pair.a).unwrap().obb();
            let obb_b = b.node(pair.b).unwrap().obb().transformed(a_from_b);
            let high_a = pair.axis.dot(&obb_a.centre.coords) + obb_a.half_width_along(&pair.axis);
            let low_b = pair.axis.dot(&obb_b.centre.coords) - obb_b.half_width_along(&pair.axis);
            let plane = 0.5 * (high_a + low_b);
            check_side(&a, pair.a, &Pose::identity(), &pair.axis, plane, refined, pair.bound);
            check_side(&b, pair.b, a_from_b, &-pair.axis, -plane, refined, pair.bound);
        };
        let outcome = walk(&a, &b, a_from_b, &traversal, 5, on_pair, on_culled);
        assert_eq!(outcome.leaf_pairs, visited.len());
        assert_eq!(outcome.culled_bound, highest);
        assert!(visited.is_disjoint(&culled));
        assert_eq!(visited.len() + culled.len(), a.leaves().count() * b.leaves().count());
        if kind == Traversal::Certified {
            assert!(outcome.culled_bound <= 1e-4);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn culled_and_visited_make_up_all_pairs_and_culled_ones_are_separated(
            kind in prop_oneof![
                Just(Traversal::Certified), Just(Traversal::Paper), Just(Traversal::GapAware)
            ],
            noise in prop_oneof![Just(0.0), Just(0.002), Just(0.02)],
            offset in prop::array::uniform3(-0.6..0.6_f64),
            angles in prop::array::uniform3(-3.1..3.1_f64),
            refined in prop_oneof![
                Just(None), Just(Some(LeafBounds { std: 0.005, shift: 0.01, reach: 0.02 }))
            ],
        ) {
            let pose = Pose::from_translation_rpy(Vector3::from(offset), angles);
            check_culls_are_certified(kind, noise, &pose, refined);
        }
    }
}
