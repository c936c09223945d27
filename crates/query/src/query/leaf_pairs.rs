//! Clouds against open meshes: pairs of leaves, each classified on its own.

use cloudtouch_bvh::{Flow, TraversalSettings, traverse};
use cloudtouch_geom::Pose;

use crate::error::QueryError;
// For now the points of two leaves are gathered as the paper does: an open mesh has no pieces of its
// own on this path yet.
use crate::paper::{bound_left_out, gather};
use crate::record::{Evidence, add_pair};
use crate::shape::Shape;

use super::classify::classify;
use super::task::Task;

/// What the classifier wants of a cloud at a time: leaves are smaller.
const LEAF_POINTS: usize = 40;

/// Classifies the leaf pairs that may touch and bounds the others.
pub(super) fn traverse_leaf_pairs(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<(), QueryError> {
    let settings = task.settings;
    let leaf_points = [a, b].map(|body| match body {
        Shape::Cloud(_) => LEAF_POINTS,
        Shape::Mesh(_) => 0,
    });
    let traversal = TraversalSettings { leaf_points, ..task.traversal };
    let mut failed = None;
    // A certified traversal draws nothing: any seed will do.
    let outcome = traverse(a.tree(), b.tree(), a_from_b, &traversal, 0, |pair| {
        let relevant = evidence.relevant_probability();
        let next = Flow::Above(relevant.max(settings.cull_probability));
        let stats = &mut evidence.stats;
        let max_parts = settings.max_mesh_parts;
        let points = match gather((a, pair.a), (b, pair.b), a_from_b, max_parts, stats) {
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
        let answer = classify(&points, &task.classifier, relevant, &task.clock, stats);
        add_pair((a, b, a_from_b), &points, &answer, evidence);
        let is_enough = evidence.largest() > settings.stop_above || task.clock.is_over();
        if is_enough { Flow::Stop } else { next }
    })?;
    if let Some(error) = failed {
        return Err(error.into());
    }
    evidence.stats.nodes_visited += outcome.nodes_visited;
    evidence.widen(outcome.pending_bound);
    evidence.widen(outcome.culled_bound);
    Ok(())
}
