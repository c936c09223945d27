//! Pairs of leaves, each classified on its own: the paper's mode, and clouds against open meshes.

use std::collections::BTreeSet;

use cloudtouch_bvh::{Flow, NodeId, Traversal, TraversalSettings, traverse};
use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::mode::Mode;

use super::classify::classify;
use super::evidence::Evidence;
use super::leaf_pair::{self, gather};
use super::record::add_pair;
use super::task::Task;

/// What the classifier wants of a cloud at a time.
const LEAF_POINTS: usize = 40;

/// Clouds of the calibrated mode have smaller leaves than the classifier wants.
fn leaf_traversal(task: &Task<'_>, bodies: [BodyRef<'_>; 2]) -> TraversalSettings {
    let leaf_points = bodies.map(|body| match body {
        BodyRef::Cloud(_) => LEAF_POINTS,
        BodyRef::Mesh(_) => 0,
    });
    TraversalSettings { leaf_points, ..task.traversal }
}

/// Classifies the leaf pairs that may touch and bounds the others.
pub(super) fn traverse_leaf_pairs(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<(), QueryError> {
    let settings = task.settings;
    let traversal = leaf_traversal(task, [a, b]);
    let mut looked_at = BTreeSet::new();
    let mut failed = None;
    let outcome = traverse(a.tree(), b.tree(), a_from_b, &traversal, settings.seed, |pair| {
        looked_at.insert((pair.a, pair.b));
        let relevant = match settings.mode {
            Mode::Calibrated => evidence.relevant_probability(),
            // As printed, but for pairs that no probability can come from.
            Mode::Paper => 0.0,
        };
        let next = Flow::Above(relevant.max(settings.cull_probability));
        let stats = &mut evidence.stats;
        let max_parts = settings.max_mesh_parts;
        let points = match gather((a, pair.a), (b, pair.b), a_from_b, max_parts, stats) {
            Ok(Some(points)) => points,
            Ok(None) => {
                evidence.widen(leaf_pair::bound_left_out());
                return next;
            }
            Err(error) => {
                failed = Some(error);
                return Flow::Stop;
            }
        };
        stats.leaf_pairs += 1;
        let answer = classify(&points, settings, relevant, &task.clock, stats);
        add_pair((a, b, a_from_b), &points, &answer, evidence);
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
        bound_what_chance_culled((a, b), a_from_b, task, &looked_at, evidence)?;
    }
    Ok(())
}

/// Bounds the leaf pairs that a stochastic traversal culled: the boxes of the large nodes it
/// culled by chance bound their points far too loosely.
fn bound_what_chance_culled(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    looked_at: &BTreeSet<(NodeId, NodeId)>,
    evidence: &mut Evidence,
) -> Result<(), QueryError> {
    let certified =
        TraversalSettings { kind: Traversal::Certified, ..leaf_traversal(task, [a, b]) };
    let mut left_out = 0.0_f64;
    let outcome = traverse(a.tree(), b.tree(), a_from_b, &certified, 0, |pair| {
        if !looked_at.contains(&(pair.a, pair.b)) {
            left_out = left_out.max(pair.bound);
        }
        Flow::Above(left_out)
    })?;
    evidence.stats.nodes_visited += outcome.nodes_visited;
    evidence.widen(left_out.max(outcome.culled_bound));
    Ok(())
}
