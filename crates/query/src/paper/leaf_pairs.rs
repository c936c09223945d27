//! The hierarchy (section 5): pairs of leaves, each classified on its own.

use std::collections::BTreeSet;

use cloudtouch_bvh::{Flow, NodeId, Traversal, TraversalSettings, traverse};
use cloudtouch_geom::Pose;

use crate::classifier::{PairPoints, Trained};
use crate::error::QueryError;
use crate::record::Evidence;
use crate::shape::Shape;

use super::add::add_pair;
use super::body::tree;
use super::classify::classify;
use super::leaf_pair::{bound_left_out, gather};
use super::task::Task;

/// Classifies the pairs of leaves that the traversal descends to and bounds the others; `on_trained`
/// is shown each pair with its answer.
pub(super) fn traverse_leaf_pairs(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
    mut on_trained: impl FnMut(&PairPoints, &Trained),
) -> Result<(), QueryError> {
    let settings = task.settings;
    // As printed, but for pairs that no probability can come from.
    let next = Flow::Above(settings.cull_probability);
    let (traversal, seed) = (&task.traversal, settings.seed);
    let mut looked_at = BTreeSet::new();
    let mut failed = None;
    let outcome = traverse(tree(a), tree(b), a_from_b, traversal, seed, |pair| {
        looked_at.insert((pair.a, pair.b));
        let stats = &mut evidence.stats;
        let points = match gather((a, pair.a), (b, pair.b), a_from_b, settings, stats) {
            Ok(Some(points)) => points,
            Ok(None) => {
                evidence.widen(bound_left_out());
                return next;
            }
            Err(error) => {
                failed = Some(error);
                return Flow::Stop;
            }
        };
        stats.leaf_pairs += 1;
        let trained = classify(&points, task, stats);
        on_trained(&points, &trained);
        add_pair((a, b, a_from_b), &points, &trained.answer, evidence);
        let is_enough = evidence.largest() > settings.stop_above || task.clock.is_over();
        if is_enough { Flow::Stop } else { next }
    })?;
    if let Some(error) = failed {
        return Err(error.into());
    }
    evidence.stats.nodes_visited += outcome.nodes_visited;
    evidence.widen(outcome.pending_bound);
    if settings.traversal == Traversal::Certified || outcome.stopped {
        evidence.widen(outcome.culled_bound);
    } else {
        bound_what_chance_culled((a, b), a_from_b, traversal, &looked_at, evidence)?;
    }
    Ok(())
}

/// Bounds the leaf pairs that a stochastic traversal culled: the boxes of the large nodes it
/// culled by chance bound their points far too loosely.
fn bound_what_chance_culled(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    by_chance: &TraversalSettings,
    looked_at: &BTreeSet<(NodeId, NodeId)>,
    evidence: &mut Evidence,
) -> Result<(), QueryError> {
    let certified = TraversalSettings { kind: Traversal::Certified, ..*by_chance };
    let mut left_out = 0.0_f64;
    let outcome = traverse(tree(a), tree(b), a_from_b, &certified, 0, |pair| {
        if !looked_at.contains(&(pair.a, pair.b)) {
            left_out = left_out.max(pair.bound);
        }
        Flow::Above(left_out)
    })?;
    evidence.stats.nodes_visited += outcome.nodes_visited;
    evidence.widen(left_out.max(outcome.culled_bound));
    Ok(())
}
