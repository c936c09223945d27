//! How well the nearest neighbours agree with a plane.

use crate::lanes::{Lanes, Machine};
use crate::surface::patch::{Patch, Plane};

/// A voter farther off than this many standard deviations counts as off the plane, however far: √(9 + ln 3), for a vote
/// that costs three deviations when missed, and gains ln 3 when not.
pub(super) const CUT: f64 = 3.178;
/// By so much at most an outlier costs more the farther it is.
const TAIL: f64 = 0.1;
/// A plane that misses the point itself costs as much as one that misses this many voters.
pub(super) const OWN_VOTES: f64 = 3.56;

/// The plane that costs least of those considered.
pub(super) struct Vote<'a, S> {
    pub(super) machine: S,
    pub(super) voters: &'a Patch<'a>,
    /// The variance along all normals, where it does not depend on them, m².
    pub(super) same: Option<f64>,
    pub(super) best: Option<Plane>,
    pub(super) best_cost: f64,
}

impl<'a, S: Machine> Vote<'a, S> {
    #[inline(always)]
    pub(super) fn new(machine: S, voters: &'a Patch<'a>) -> Self {
        let same = voters.isotropic_own_variance();
        Self { machine, voters, same, best: None, best_cost: f64::INFINITY }
    }

    #[inline(always)]
    pub(super) fn consider(&mut self, plane: Plane) {
        let cost = self.disagreement(&plane);
        if cost < self.best_cost {
            self.best_cost = cost;
            self.best = Some(plane);
        }
    }

    /// The variance of residuals from a plane, m².
    #[inline(always)]
    fn variance(&self, plane: &Plane) -> f64 {
        self.same.unwrap_or_else(|| self.voters.own_variance(&plane.normal))
    }

    /// Whether a plane misses neither the point nor a voter.
    #[inline(always)]
    pub(super) fn is_unanimous(&self, plane: &Plane) -> bool {
        let machine = self.machine;
        let most = CUT * CUT * self.variance(plane);
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
    /// Of what lies along the plane nothing is asked, so it is not narrower where less of the noise is across it: a camera
    /// sees as many samples whichever way a surface faces, and displaces them along its rays.
    #[inline(always)]
    pub(super) fn disagreement(&self, plane: &Plane) -> f64 {
        let machine = self.machine;
        let (inverse, most) = (1.0 / self.variance(plane), CUT * CUT);
        // The plane is to be the one the point is on, unless the point is far beyond its noise.
        let own = capped(plane.height * plane.height * inverse, OWN_VOTES * most);
        // How much less the voters cost than if all of them missed the plane.
        let mut spared = Lanes::zero(machine);
        let spare = Lanes::splat(machine, most);
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
            let cost = residuals * residuals * inverse;
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
