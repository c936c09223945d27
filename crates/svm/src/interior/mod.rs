//! Rung 2: a dense primal-dual interior point method on the dual (eq. 13).
//!
//! Mehrotra's predictor and corrector with Nesterov–Todd scaling. Writing z_i = (α_i, p_i) in its
//! cone with multiplier s_i, u_i = C_i − α_i ≥ 0 with multiplier ξ_i, and the bias b for Σcα = 0:
//! Q z − e − s + ξ + b c = 0. Every iterate is feasible, so its gap can be certified.

pub(crate) mod active;
mod cone;
pub(crate) mod gram;
mod iterate;
mod newton;
mod square;
mod step;

use nalgebra::Vector4;

use crate::certificate::largest_violation;
use crate::certificate::slack::Slack;
use crate::interior::iterate::{Iterate, tail};
use crate::interior::newton::Newton;
use crate::problem::Problem;
use crate::smo::state::Dual;
use crate::status::{Rung, Status};
use crate::watch::Watch;

pub(crate) use crate::interior::iterate::FAR;

/// Seven to twelve iterations are usual at 1e-4; past this rounding has stopped the progress.
const MAX_ITERATIONS: usize = 60;
/// An iteration without a smaller gap counts as stalled only once the gap has fallen to this: until
/// then multipliers that have to grow to a large penalty leave it near 1 while all goes well.
const NEAR: f64 = 0.1;
/// Stalled iterations after which rounding has stopped the progress.
const MAX_STALLED: usize = 5;
/// A start beside a dual point that has not led to the tolerance by then leads nowhere.
const NEAR_ITERATIONS: usize = 15;

/// How far the method came.
pub(crate) struct Reached {
    /// The best multipliers and cone vectors found; none where not even the first were finite.
    pub(crate) duals: Option<Vec<Dual>>,
    pub(crate) iterations: usize,
    pub(crate) status: Status,
}

/// Solves the dual to `relative_gap`, or as far as rounding and `allowed` iterations let it.
///
/// It starts beside a dual point, that of SMO, or, where that is far from the optimum or leads nowhere,
/// cold.
pub(crate) fn solve(
    problem: &Problem,
    so_far: &[Dual],
    relative_gap: f64,
    allowed: usize,
    watch: &mut Watch<'_>,
) -> Reached {
    let Some(mut newton) = Newton::of(problem) else {
        return Reached { duals: None, iterations: 0, status: Status::TooLarge };
    };
    let mut slack = Slack::default();
    let mut run = Run { best: None, iterations: 0 };
    if let Some(near) = Iterate::near(problem, so_far, &mut newton, &mut slack) {
        let allowed = allowed.min(NEAR_ITERATIONS);
        let status = run.go_on(near, &mut newton, &mut slack, relative_gap, allowed, watch);
        if matches!(status, Status::Converged | Status::Cancelled) {
            return run.end(status);
        }
    }
    let start = Iterate::cold(problem, so_far);
    let allowed = (run.iterations + MAX_ITERATIONS).min(allowed);
    let status = run.go_on(start, &mut newton, &mut slack, relative_gap, allowed, watch);
    run.end(status)
}

/// The iterations so far, and the best multipliers among them with their gap.
struct Run {
    best: Option<(Vec<Vector4<f64>>, f64)>,
    iterations: usize,
}

impl Run {
    /// Iterates from a start, and says how that ended.
    fn go_on(
        &mut self,
        mut at: Iterate<'_>,
        newton: &mut Newton,
        slack: &mut Slack,
        relative_gap: f64,
        allowed: usize,
        watch: &mut Watch<'_>,
    ) -> Status {
        let (mut least, mut worse) = (f64::INFINITY, 0);
        while self.iterations < allowed {
            newton.product(&at.z, &mut at.moved);
            let certificate = at.certificate(slack);
            let gap = certificate.relative_gap();
            let violation = || largest_violation(&at.problem.points, |i| at.violation(i));
            let stop =
                watch.shows_stop(Rung::InteriorPoint, self.iterations, &certificate, violation);
            if gap.is_finite() && self.best.as_ref().is_none_or(|(_, least)| gap < *least) {
                self.best = Some((at.z.clone(), gap));
            }
            if gap <= relative_gap {
                return Status::Converged;
            }
            // An earlier run does not count: it may have come closer before it stalled.
            worse = if gap < least { 0 } else { worse + 1 };
            least = least.min(gap);
            if stop {
                return Status::Cancelled;
            }
            // A scaling or a factor that fails is rounding too.
            if worse >= MAX_STALLED && least <= NEAR || at.step(newton).is_none() {
                return Status::Stalled;
            }
            self.iterations += 1;
        }
        Status::IterationLimit
    }

    fn end(self, status: Status) -> Reached {
        let duals = self.best.map(|(z, _)| z.iter().map(|z| (z[0], tail(z))).collect());
        let nothing = duals.is_none() && status == Status::Stalled;
        let status = if nothing { Status::NotFinite } else { status };
        Reached { duals, iterations: self.iterations, status }
    }
}
