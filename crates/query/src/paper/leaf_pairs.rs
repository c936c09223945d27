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
        bound_what_chance_culled((a, b), a_from_b, task, &looked_at, evidence)?;
    }
    Ok(())
}

/// Bounds the leaf pairs that a stochastic traversal culled: the boxes of the large nodes it
/// culled by chance bound their points far too loosely. Those that the time does not suffice for it bounds by these.
fn bound_what_chance_culled(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    looked_at: &BTreeSet<(NodeId, NodeId)>,
    evidence: &mut Evidence,
) -> Result<(), QueryError> {
    let certified = TraversalSettings { kind: Traversal::Certified, ..task.traversal };
    let mut left_out = 0.0_f64;
    let outcome = traverse(tree(a), tree(b), a_from_b, &certified, 0, |pair| {
        if !looked_at.contains(&(pair.a, pair.b)) {
            left_out = left_out.max(pair.bound);
        }
        if task.clock.is_over() { Flow::Stop } else { Flow::Above(left_out) }
    })?;
    evidence.stats.nodes_visited += outcome.nodes_visited;
    evidence.widen(left_out.max(outcome.culled_bound).max(outcome.pending_bound));
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use cloudtouch_geom::PointCloud;
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::{scene, surface};

    use super::*;
    use crate::classifier::{ClassifierSettings, Clock};
    use crate::{PaperCloud, PaperCloudSettings, PaperSettings};

    #[test]
    fn bounds_of_what_chance_culled_went_on_after_the_deadline() {
        let samples = surface::sample_surface(&scene::sphere(0.1, 3), 2_000, 1);
        let points = PointCloud::from_points(surface::positions(&samples));
        let settings = PaperCloudSettings::new(SensorModel::Isotropic { std: 0.005 });
        let ball = PaperCloud::prepare(&points, &settings).unwrap();
        let ball = ball.prepared();
        let bodies = (Shape::Cloud(ball), Shape::Cloud(ball));
        let settings = &PaperSettings::default();
        let beside = Pose::from_translation_rpy([0.19, 0.0, 0.0].into(), [0.0; 3]);
        // Of which all were looked at, so that none ends it.
        let mut looked_at = BTreeSet::new();
        let certified = TraversalSettings::default();
        traverse(ball.tree(), ball.tree(), &beside, &certified, 0, |pair| {
            looked_at.insert((pair.a, pair.b));
            Flow::Continue
        })
        .unwrap();
        let bounded = |limit| {
            let (classifier, traversal) = (ClassifierSettings::default(), certified);
            let clock = Clock::new(Instant::now(), limit);
            let task = Task { settings, classifier, traversal, clock };
            let mut evidence = Evidence::default();
            bound_what_chance_culled(bodies, &beside, &task, &looked_at, &mut evidence).unwrap();
            (evidence.bound_of_rest(), evidence.stats.nodes_visited)
        };
        let (bound, nodes) = bounded(None);
        let (in_no_time, few_nodes) = bounded(Some(Duration::ZERO));
        assert!(bound < 0.5 && in_no_time > 0.5, "{in_no_time} {bound}");
        assert!(2 * few_nodes < nodes, "{few_nodes} {nodes}");
    }
}
