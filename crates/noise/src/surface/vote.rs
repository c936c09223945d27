//! How well the nearest neighbours agree with a plane.

use crate::lanes::{Lanes, Machine};
use crate::surface::patch::{Patch, Plane};

/// A voter farther off than this many standard deviations counts as off the plane, however far.
pub(super) const CUT: f64 = 3.0;
/// By so much at most an outlier costs more the farther it is.
const TAIL: f64 = 0.1;
/// A plane that misses the point itself costs as much as one that misses this many voters.
pub(super) const OWN_VOTES: f64 = 4.0;

/// The plane that costs least of those considered.
pub(super) struct Vote<'a, S> {
    pub(super) machine: S,
    pub(super) voters: &'a Patch<'a>,
    /// The largest variance of the point along any normal, m².
    pub(super) scale: f64,
    /// The variance along all normals with its narrowness, where it does not depend on them.
    pub(super) same: Option<(f64, f64)>,
    pub(super) best: Option<Plane>,
    pub(super) best_cost: f64,
}

impl<'a, S: Machine> Vote<'a, S> {
    #[inline(always)]
    pub(super) fn new(machine: S, voters: &'a Patch<'a>) -> Self {
        let scale = voters.largest_own_variance();
        let same = voters.isotropic_own_variance().map(|v| (v, (v / scale).ln()));
        Self { machine, voters, scale, same, best: None, best_cost: f64::INFINITY }
    }

    #[inline(always)]
    pub(super) fn consider(&mut self, plane: Plane) {
        let cost = self.disagreement(&plane);
        if cost < self.best_cost {
            self.best_cost = cost;
            self.best = Some(plane);
        }
    }

    /// The variance of residuals from a plane, and the logarithm of what part it is of the largest.
    #[inline(always)]
    fn variance(&self, plane: &Plane) -> (f64, f64) {
        self.same.unwrap_or_else(|| {
            let variance = self.voters.own_variance(&plane.normal);
            (variance, (variance / self.scale).ln())
        })
    }

    /// Whether a plane misses neither the point nor a voter.
    #[inline(always)]
    pub(super) fn is_unanimous(&self, plane: &Plane) -> bool {
        let machine = self.machine;
        let (variance, _) = self.variance(plane);
        let most = CUT * CUT * variance;
        let mut beyond = Lanes::zero(machine);
        for group in 0..self.voters.groups() {
            let offsets = self.voters.group(machine, group);
            let present = self.voters.present(machine, group);
            let residuals = plane.residuals(machine, offsets);
            beyond +=
                (residuals * residuals * present - Lanes::splat(machine, most)).not_negative();
        }
        plane.height * plane.height <= most && beyond.sum() == 0.0
    }

    /// The truncated negative log-likelihood of the voters; infinite where it is more than that of
    /// the best so far.
    ///
    /// The logarithm matters where noise depends on direction: without it a plane facing the noisy
    /// direction explains anything. `scale` makes it at most zero, so that an outlier costs the same
    /// whatever the plane.
    #[inline(always)]
    pub(super) fn disagreement(&self, plane: &Plane) -> f64 {
        let machine = self.machine;
        let (variance, narrowness) = self.variance(plane);
        let (inverse, most) = (1.0 / variance, CUT * CUT);
        // The plane is to be the one the point is on, unless the point is far beyond its noise.
        let own = capped(plane.height * plane.height * inverse, OWN_VOTES * most);
        // How much less the voters cost than if all of them missed the plane.
        let mut spared = Lanes::zero(machine);
        let spare = Lanes::splat(machine, most - narrowness);
        for group in 0..self.voters.groups() {
            let offsets = self.voters.group(machine, group);
            let present = self.voters.present(machine, group);
            let residuals = plane.residuals(machine, offsets);
            spared += (spare - residuals * residuals * inverse).not_negative() * present;
        }
        // What a miss costs beyond the cap comes to this.
        let least = own + most * self.voters.len() as f64 - spared.sum();
        if least > self.best_cost {
            return f64::INFINITY;
        }
        let mut tails = Lanes::zero(machine);
        for group in 0..self.voters.groups() {
            let offsets = self.voters.group(machine, group);
            let present = self.voters.present(machine, group);
            let residuals = plane.residuals(machine, offsets);
            let cost = residuals * residuals * inverse + Lanes::splat(machine, narrowness);
            tails += Lanes::load(machine, cost.stored().map(|cost| tail(cost, most))) * present;
        }
        least + tails.sum()
    }
}

/// The cost up to the cap, and hardly more beyond it.
///
/// Where samples are far sharper than their spacing every plane misses all voters but those it was
/// laid through. Planes that cost the same to the last bit would be told apart by rounding, and the
/// surface would jump when the cloud is moved.
#[inline(always)]
fn capped(cost: f64, most: f64) -> f64 {
    cost.min(most) + tail(cost, most)
}

/// What a cost comes to beyond its cap.
#[inline(always)]
fn tail(cost: f64, most: f64) -> f64 {
    if cost <= most { 0.0 } else { TAIL * (cost - most) / cost }
}
