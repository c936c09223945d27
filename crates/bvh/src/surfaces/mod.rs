//! Which leaves of two trees have surfaces that may touch: pairs best first, and a bound on the rest.

mod across_edges;
mod apart;
mod carried;
mod pairs;
mod placed;
pub(crate) mod settled;
pub(crate) mod sought;

use cloudtouch_geom::Pose;

use crate::surfaces::pairs::{Pairs, USUAL_PAIRS, Waiting};
use crate::surfaces::settled::Settled;
use crate::surfaces::sought::{Sought, SurfaceOutcome};
use crate::{NodeId, Tree, TreeError};

/// Two leaves whose surfaces may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePair {
    /// Leaf of the first tree.
    pub a: NodeId,
    /// Leaf of the second tree.
    pub b: NodeId,
    /// The Mahalanobis distance between a point of the one and a point of the other is at least this,
    /// shifts and spreads as in [`Tree::set_leaf_bounds`]; 0 where boxes are not beyond the margin.
    pub deviations: f64,
    /// Whether surfaces are looked for that may cross, and these may: their boxes, grown by their reach
    /// too, overlap.
    pub may_cross: bool,
}

/// Whether to go on after a pair of leaves.
#[derive(Debug, Clone, Copy)]
pub enum SurfaceFlow<'a> {
    /// On to the next pair with fewer deviations than these, or whose surfaces may cross.
    Within(f64),
    /// The same, by trees of the same nodes whose boxes and bounds are others and hold too, such as a
    /// clone that was refitted: what waits is tested anew.
    WithinBy(f64, [&'a Tree; 2]),
    /// As [`Self::Within`], and no more pairs with the leaf of this pair that is named: the caller knows of it beside
    /// all of the other tree. What is left out for that is not in the outcome.
    WithinSettled(f64, Settled),
    /// No further pairs.
    Stop,
}

/// Visits the pairs of leaves, one of each tree, that may hold what is sought.
///
/// `a_from_b` maps the frame of `b` into that of `a`; it may change between calls, the trees need
/// not. Best first: overlapping pairs before disjoint ones, among the former the deepest overlap
/// relative to the smaller node (in metres the large nodes would all come before the first leaf),
/// among the latter the fewest deviations; ties by node name. Of a pair the larger node is descended.
///
/// Along a unit vector n across which two boxes are g apart and their points have standard deviations
/// up to σ and τ, no two of these have less than (g − m)/√(σ² + τ²) deviations between them, m the
/// margin: the bound is the largest over the normals of the faces. Gaps are reduced by the shifts of
/// both nodes, by the rounding of the pose, and by how far a drift takes the second box along n; its
/// turn raises the deviations and the reach of the second.
///
/// An empty tree has no pairs, and nothing was left out; it is for the caller to say what that means.
///
/// # Errors
/// When the pose or the margin is not finite, the margin is negative, or `within` is not a number.
pub fn visit_surfaces<'a>(
    (a, b): (&'a Tree, &'a Tree),
    a_from_b: &Pose,
    sought: Sought,
    mut visit: impl FnMut(SurfacePair) -> SurfaceFlow<'a>,
) -> Result<SurfaceOutcome, TreeError> {
    check(a_from_b, &sought)?;
    let mut within = sought.within;
    let mut outcome = SurfaceOutcome::NOTHING;
    let (Some(root_a), Some(root_b)) = (a.root, b.root) else { return Ok(outcome) };
    let mut pairs = Pairs::new((a, root_a), (b, root_b), a_from_b, sought, USUAL_PAIRS);
    pairs.test(root_a, root_b, within, &mut outcome);
    while let Some(pair) = pairs.most_urgent() {
        let Waiting { deviations, surfaces, .. } = pair.item;
        if pairs.is_settled(pair.nodes()) {
            pairs.drop_most_urgent();
            continue;
        }
        if deviations >= within && !pairs.may_cross(&pair) {
            outcome.leave_out(deviations, surfaces);
            pairs.drop_most_urgent();
            continue;
        }
        if let Some(halves) = pairs.narrower(&pair) {
            pairs.test_instead(halves, within, &mut outcome);
            continue;
        }
        pairs.drop_most_urgent();
        outcome.leaf_pairs += 1;
        let may_cross = pairs.may_cross(&pair);
        let (a, b) = pair.nodes();
        match visit(SurfacePair { a: NodeId(a), b: NodeId(b), deviations, may_cross }) {
            SurfaceFlow::Within(limit) => within = within.min(limit),
            SurfaceFlow::WithinSettled(limit, settled) => {
                within = within.min(limit);
                pairs.settle((a, b), settled);
            }
            SurfaceFlow::WithinBy(limit, trees) => {
                within = within.min(limit);
                pairs.go_on_by(trees, a_from_b, within, &mut outcome);
            }
            SurfaceFlow::Stop => {
                (outcome.deviations, outcome.apart) = (0.0, f64::NEG_INFINITY);
                outcome.stopped = true;
                break;
            }
        }
    }
    Ok(outcome)
}

/// By one test of two boxes, whether [`visit_surfaces`] would look into two trees: `None` where it would
/// leave out all of them, else how urgent that is, the less the sooner. Negative for boxes that overlap,
/// relative to the smaller one; else the deviations between them.
///
/// # Errors
/// As [`visit_surfaces`].
pub fn urgency_of_roots(
    (a, b): (&Tree, &Tree),
    a_from_b: &Pose,
    sought: Sought,
) -> Result<Option<f64>, TreeError> {
    check(a_from_b, &sought)?;
    let (Some(root_a), Some(root_b)) = (a.root, b.root) else { return Ok(None) };
    let mut pairs = Pairs::new((a, root_a), (b, root_b), a_from_b, sought, 1);
    let mut outcome = SurfaceOutcome::NOTHING;
    pairs.test(root_a, root_b, sought.within, &mut outcome);
    Ok(pairs.most_urgent().map(|roots| roots.urgency()))
}

fn check(a_from_b: &Pose, sought: &Sought) -> Result<(), TreeError> {
    if let Some(value) = a_from_b.non_finite_entry() {
        return Err(TreeError::Pose { value });
    }
    let setting = |name, value, expected| Err(TreeError::Setting { name, value, expected });
    if !(0.0..f64::INFINITY).contains(&sought.margin) {
        return setting("margin", sought.margin, "a length in metres, at least 0");
    }
    if sought.within.is_nan() {
        return setting("within", sought.within, "a number of deviations");
    }
    Ok(())
}
