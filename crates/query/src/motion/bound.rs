//! What no pose of a stretch exceeds.

use cloudtouch_geom::{Drift, Pose};

use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::doubt::taken::knows_taken;
use crate::doubt::unseen::knows_unseen;
use crate::error::QueryError;
use crate::exact::collide;
use crate::mesh::Mesh;
use crate::query::{Query, blur};
use crate::record::CLEAR_DEVIATIONS;
use crate::search::{greatest_depth, reach_of};
use crate::stats::Stats;

/// Two bodies, and how the second drifts about a pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drifting<'a> {
    pub bodies: (BodyRef<'a>, BodyRef<'a>),
    /// From the file frame of B into that of A.
    pub a_from_b: Pose,
    /// In the local frame of A.
    pub drift: Drift,
}

/// Doubts are looked for at the ends and in the middle of a stretch at least, ...
const LEAST_DOUBTED: usize = 3;
/// ... and beside an image so often that nothing moves by more than this part of the smaller body.
const DOUBTED_WAY: f64 = 0.05;

impl Drifting<'_> {
    /// A bound on the probability of a collision at any pose on the way; 1 as soon as it would exceed
    /// `cut`, or when time is over.
    pub(super) fn upper_bound(
        &self,
        query: &Query,
        cut: f64,
        clock: &Clock,
        stats: &mut Stats,
    ) -> Result<f64, QueryError> {
        let (a, b) = self.bodies;
        let settings = query.settings();
        let local = a.shape().local_from(&b.shape(), &self.a_from_b);
        if let (BodyRef::Mesh(a), BodyRef::Mesh(b)) = (a, b) {
            return self.exact((a, b), &local, stats);
        }
        // It keeps along the motion.
        let judge = settings.judge.for_blur(blur((a, b)));
        let at_most = |deviations, clearness| judge.at_most(settings.prior, deviations, clearness);
        let is_above = |deviations: f64, clearness: f64| {
            at_most(deviations, clearness) > cut || clock.is_over()
        };
        let is_deep = |depth: f64| depth > 0.0 && is_above(-depth, 0.0);
        let depth = greatest_depth((a, b), &local, &self.drift, is_deep, stats);
        if is_deep(depth) {
            return Ok(1.0);
        }
        // Of what gets inside, the distance from the surface may part nothing.
        let given = |between: f64| if depth > 0.0 { -depth } else { between };
        let is_enough = |between: f64, clearness: f64| is_above(given(between), clearness);
        let reach = reach_of((a, b), &local, &self.drift, is_enough, stats)?;
        let upper = at_most(given(reach.deviations), reach.clearness);
        Ok(if reach.is_complete { upper } else { 1.0 })
    }

    /// Whether a bound on the probability leaves none of the way less than [`CLEAR_DEVIATIONS`] from a
    /// collision.
    pub(super) fn is_clear(&self, query: &Query, upper: f64) -> bool {
        let settings = query.settings();
        let judge = settings.judge.for_blur(blur(self.bodies));
        upper <= judge.at_most(settings.prior, CLEAR_DEVIATIONS, 0.0)
    }

    /// At how many poses, ends included and evenly apart, what lies where the pair is doubted is not passed over:
    /// of a depth image, which may have seen nothing anywhere, no point of B gets far from one to the next.
    pub(super) fn poses_to_doubt(&self) -> usize {
        let (a, b) = (self.bodies.0.shape(), self.bodies.1.shape());
        if ![a, b].into_iter().any(|body| knows_unseen(body) || knows_taken(body)) {
            return LEAST_DOUBTED;
        }
        let local = a.local_from(&b, &self.a_from_b);
        let samples = b.samples();
        let ways = samples.iter().map(|s| self.drift.in_any_direction(&local.transform_point(s)));
        let way = 2.0 * ways.fold(0.0, f64::max);
        let step = DOUBTED_WAY * a.size().min(b.size());
        // A body without size is doubted anyway.
        let steps = if step > 0.0 { (way / step).ceil() as usize } else { 0 };
        steps.saturating_add(1).max(LEAST_DOUBTED)
    }

    /// Where two exact surfaces never touch, one is inside the other all the time or never.
    fn exact(
        &self,
        meshes: (&Mesh, &Mesh),
        local: &Pose,
        stats: &mut Stats,
    ) -> Result<f64, QueryError> {
        let touch = |deviations: f64, _: f64| deviations <= 0.0;
        if reach_of(self.bodies, local, &self.drift, touch, stats)?.deviations <= 0.0 {
            return Ok(1.0);
        }
        Ok(if collide(meshes, local)? { 1.0 } else { 0.0 })
    }
}
