//! A first plane that outliers and second faces cannot bend: the best supported of a few.

use cloudtouch_geom::Vector3;

use crate::lanes::{Lanes, Machine};
use crate::surface::patch::{Patch, Plane};
use crate::surface::reweight::{plane_of_sums, sums};

/// Planes are laid through the point and each pair of this many nearest neighbours.
const PAIRED: usize = 8;
/// Planes are also laid through each three of this many.
const TRIPLED: usize = 6;
/// How many neighbours vote on a plane.
const VOTERS: usize = 19;
/// A voter farther off than this many standard deviations counts as off the plane, however far.
const CUT: f64 = 3.0;
/// By so much at most an outlier costs more the farther it is.
const TAIL: f64 = 0.1;
/// A plane that misses the point itself costs as much as one that misses this many voters.
const OWN_VOTES: f64 = 4.0;

/// The plane with the most support among the nearest neighbours; `None` when they are too few or
/// all on one line with the point.
///
/// That is the least-squares plane where it misses nobody and noise is the same in all directions. Else candidates are laid through three
/// places, so that one of them is likely to lie in one face even where two meet: the point and two
/// neighbours, or three neighbours, since the point itself may be the outlier.
#[inline(always)]
pub(crate) fn best_candidate<S: Machine>(machine: S, patch: &Patch) -> Option<Plane> {
    let voters = patch.nearest(VOTERS);
    let mut vote = Vote::new(machine, &voters);
    if let Some(plane) = least_squares(machine, &voters) {
        // Along a noisy direction nothing misses a plane, and that says little for it.
        if vote.same.is_some() && vote.is_unanimous(&plane) {
            return Some(plane);
        }
        vote.consider(plane);
    }
    let mut offsets = [Vector3::zeros(); PAIRED];
    let paired = &mut offsets[..voters.len().min(PAIRED)];
    for (i, offset) in paired.iter_mut().enumerate() {
        *offset = voters.offset(i);
    }
    for (j, b) in paired.iter().enumerate() {
        for a in &paired[..j] {
            if let Some(normal) = across(a, b) {
                vote.consider(Plane { normal, height: 0.0 });
            }
        }
    }
    let tripled = &paired[..paired.len().min(TRIPLED)];
    for (j, c) in tripled.iter().enumerate() {
        for (i, b) in tripled[..j].iter().enumerate() {
            for a in &tripled[..i] {
                if let Some(normal) = across(&(b - a), &(c - a)) {
                    vote.consider(Plane { normal, height: normal.dot(a) });
                }
            }
        }
    }
    vote.best
}

/// The plane that costs least of those considered.
struct Vote<'a, S> {
    machine: S,
    voters: &'a Patch<'a>,
    /// The largest variance of the point along any normal, m².
    scale: f64,
    /// The variance along all normals with its narrowness, where it does not depend on them.
    same: Option<(f64, f64)>,
    best: Option<Plane>,
    best_cost: f64,
}

impl<'a, S: Machine> Vote<'a, S> {
    #[inline(always)]
    fn new(machine: S, voters: &'a Patch<'a>) -> Self {
        let scale = voters.largest_own_variance();
        let same = voters.isotropic_own_variance().map(|v| (v, (v / scale).ln()));
        Self { machine, voters, scale, same, best: None, best_cost: f64::INFINITY }
    }

    #[inline(always)]
    fn consider(&mut self, plane: Plane) {
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
    fn is_unanimous(&self, plane: &Plane) -> bool {
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
    fn disagreement(&self, plane: &Plane) -> f64 {
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

/// The direction across two others; `None` when they are nearly parallel, which would leave a
/// direction of rounding error.
#[inline(always)]
fn across(a: &Vector3, b: &Vector3) -> Option<Vector3> {
    let cross = a.cross(b);
    let squared = cross.norm_squared();
    (squared > 1e-6 * a.norm_squared() * b.norm_squared()).then(|| cross / squared.sqrt())
}

#[inline(always)]
fn least_squares<S: Machine>(machine: S, voters: &Patch) -> Option<Plane> {
    let mut first = [Lanes::zero(machine); 3];
    let mut second = [Lanes::zero(machine); 6];
    // Where there is no neighbour the offsets are zero, which adds nothing, or another's.
    for group in 0..voters.groups() {
        let offsets = voters.group(machine, group);
        let present = voters.present(machine, group);
        let [x, y, z] = offsets;
        let [x, y, z] = [x * present, y * present, z * present];
        for (sum, value) in first.iter_mut().zip([x, y, z]) {
            *sum += value;
        }
        for (sum, product) in second.iter_mut().zip([x * x, x * y, x * z, y * y, y * z, z * z]) {
            *sum += product;
        }
    }
    plane_of_sums(voters.len() as f64, sums(first), sums(second))
}
