//! Which planes cannot win a vote: told of four at a time, and of nearly all.

use cloudtouch_geom::Vector3;

use crate::lanes::{Lanes, Machine, Stored, WIDTH};
use crate::surface::vote::{CUT, OWN_VOTES, Vote};

/// What rounding may take from a cost, a part of the most that voters can spare.
const ROUNDING: f64 = 1e-9;

impl<S: Machine> Vote<'_, S> {
    /// The least that planes through three places each can cost: no more than [`Self::disagreement`], and less by no more
    /// than the tails of what is missed. Of three places on one line it says nothing.
    #[inline(always)]
    pub(super) fn least_costs(&self, places: [[Vector3; 3]; WIDTH]) -> Stored {
        let Self { machine, voters, .. } = *self;
        let [a, b, c] = [0, 1, 2].map(|corner| {
            [0, 1, 2].map(|axis| Lanes::load(machine, places.map(|plane| plane[corner][axis])))
        });
        let normal = cross(minus(b, a), minus(c, a));
        let inverse_square = dot(normal, normal).inverse();
        let inverse = match self.same {
            Some(variance) => inverse_square * (1.0 / variance),
            None => self.variances(normal, inverse_square).inverse() * inverse_square,
        };
        // In standard deviations.
        let scaling = inverse.sqrt();
        let [x, y, z] = normal.map(|entry| entry * scaling);
        let below = Lanes::zero(machine) - dot([x, y, z], a);
        let (most, all) = (Lanes::splat(machine, CUT * CUT), voters.len() as f64);
        let own = below * below;
        let beyond = (own - most * OWN_VOTES).not_negative();
        let mut spared = Lanes::zero(machine);
        for voter in 0..voters.len() {
            let place: [f64; 3] = voters.offset(voter).into();
            let [p, q, r] = place.map(|entry| Lanes::splat(machine, entry));
            let above = x.times_plus(p, y.times_plus(q, z.times_plus(r, below)));
            let less = Lanes::zero(machine) - above;
            spared += less.times_plus(above, most).not_negative();
        }
        (own - beyond + most * all - spared - most * (ROUNDING * all)).stored()
    }

    /// The variances of the point along normals that are not of unit length, m².
    #[inline(always)]
    fn variances(&self, [x, y, z]: [Lanes<S>; 3], inverse_square: Lanes<S>) -> Lanes<S> {
        let [xx, xy, xz, yy, yz, zz] = self.voters.own_noise().upper_triangle();
        let along =
            x * x * xx + y * y * yy + z * z * zz + (x * y * xy + x * z * xz + y * z * yz) * 2.0;
        (along * inverse_square).at_least(self.voters.floor())
    }
}

#[inline(always)]
fn minus<S: Machine>(a: [Lanes<S>; 3], b: [Lanes<S>; 3]) -> [Lanes<S>; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<S: Machine>(a: [Lanes<S>; 3], b: [Lanes<S>; 3]) -> Lanes<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<S: Machine>(a: [Lanes<S>; 3], b: [Lanes<S>; 3]) -> [Lanes<S>; 3] {
    let across = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [across(1, 2), across(2, 0), across(0, 1)]
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Matrix3};
    use proptest::prelude::*;

    use super::*;
    use crate::lanes::{Kernel, run};
    use crate::surface::patch::{Offsets, Patch, PatchNoise, Plane};

    /// The least costs of planes, and what they cost.
    struct Costs<'a>(&'a Patch<'a>, [[Vector3; 3]; WIDTH]);

    impl Kernel for Costs<'_> {
        type Output = [Stored; 2];

        #[inline(always)]
        fn run<S: Machine>(self, machine: S) -> [Stored; 2] {
            let vote = Vote::new(machine, self.0);
            let cost = |[a, b, c]: [Vector3; 3]| {
                let normal = (b - a).cross(&(c - a)).normalize();
                vote.disagreement(&Plane { normal, height: normal.dot(&a) })
            };
            [vote.least_costs(self.1), self.1.map(cost)]
        }
    }

    proptest! {
        /// Else the best candidate might be left out; and were it less by much, hardly any would be.
        #[test]
        fn it_is_no_more_than_the_cost_and_hardly_less(
            places in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 8..20),
            flat in 0.0..1.0_f64,
            stds in prop::array::uniform3(0.003..0.3_f64),
            turn in prop::array::uniform3(-1.0..1.0_f64),
            is_same in any::<bool>(),
        ) {
            let mut places: Vec<Vector3> =
                places.into_iter().map(|[x, y, z]| Vector3::new(x, y, flat * z)).collect();
            places.sort_by(|p, q| p.norm_squared().total_cmp(&q.norm_squared()));
            let mut offsets = Offsets::default();
            offsets.set(places.iter().copied());
            let skew = Matrix3::identity() + Vector3::from(turn).cross_matrix();
            let variances = Matrix3::from_diagonal(&Vector3::from(stds.map(|std| std * std)));
            let noise = if is_same {
                Covariance::isotropic(stds[0] * stds[0])
            } else {
                Covariance::from_symmetric(&(skew * variances * skew.transpose()))
            };
            let patch = Patch::new(&offsets, PatchNoise::Uniform(&noise), &noise, 0.1);
            let origin = Vector3::zeros();
            let planes = [[origin, places[0], places[3]], [origin, places[2], places[7]],
                [places[0], places[1], places[2]], [places[3], places[5], places[6]]];
            let [least, costs] = run(Costs(&patch, planes));
            // All misses' tails, the point's among them.
            let most = 0.1 * (places.len() as f64 + OWN_VOTES) + 1e-6;
            for (least, cost) in least.into_iter().zip(costs) {
                prop_assert!(least <= cost, "{} of {}", least, cost);
                prop_assert!(cost <= least + most, "{} of {}", least, cost);
            }
        }
    }
}
