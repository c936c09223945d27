//! Which way samples get denser along a surface: where it ends, they are on one side.

use cloudtouch_geom::Vector3;

use crate::lanes::{Lanes, Machine};
use crate::surface::patch::Patch;
use crate::surface::regression::{Coefficients, Frame, squared_residual_and_reach};
use crate::surface::reweight::{TUKEY_CUT, sums, tukey};

/// Samples count up to the neighbour of this rank, ...
const NEAREST: usize = 24;
/// ... or up to so many standard deviations of the noise, whichever is farther, less the farther they are.
const REACH_STDS: f64 = 2.5;

/// What so little of the weights says, a part of what those of samples all around come to, is next to nothing.
const LEAST_TOLD: f64 = 0.01;

/// The score ∇ log f of the samples at the point along a surface of these coefficients, 1/m, f being how dense
/// they are there. `normal` is that of the surface nearest the point.
///
/// With weights that depend on the distance alone, f changes by the part g·x over a vector x, where Σw x =
/// ½ g Σw x². What is off the surface does not count.
#[inline(always)]
pub(crate) fn score<S: Machine>(
    machine: S,
    patch: &Patch,
    normal: Vector3,
    surface: (&Frame, &Coefficients),
) -> Vector3 {
    let reach = squared_reach(patch);
    let inverse_reach = 1.0 / reach;
    let inverse_cut = 1.0 / (TUKEY_CUT * TUKEY_CUT);
    let precisions = patch.precisions(&normal);
    let mut first = [Lanes::zero(machine); 3];
    let mut second = Lanes::zero(machine);
    for group in 0..patch.groups() {
        let offsets = patch.group(machine, group);
        let [x, y, z] = offsets;
        let [residual, across] = squared_residual_and_reach(machine, offsets, surface);
        let precision = precisions.group(machine, group);
        let weight = tukey(machine, residual * precision * inverse_cut)
            * tukey(machine, (x * x + y * y + z * z) * inverse_reach)
            * patch.present(machine, group);
        for (sum, entry) in first.iter_mut().zip(offsets) {
            *sum += weight * entry;
        }
        second += weight * across;
    }
    let first = Vector3::from(sums(first));
    let along = first - normal * normal.dot(&first);
    along * (2.0 / (second.sum() + LEAST_TOLD * reach))
}

/// How far samples count, squared, m²: not beyond the last neighbour, past which there may be more.
#[inline(always)]
fn squared_reach(patch: &Patch) -> f64 {
    let to = |rank: usize| patch.offset(rank).norm_squared();
    let last = patch.len() - 1;
    let by_noise = REACH_STDS * REACH_STDS * patch.largest_own_variance();
    to(last.min(NEAREST)).max(by_noise).min(to(last))
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, seed};
    use proptest::prelude::*;
    use pulp::Scalar256b;

    use super::*;
    use crate::lanes::{Kernel, run};
    use crate::surface::patch::{Offsets, PatchNoise};

    struct Flat<'a>(&'a Patch<'a>);

    impl Kernel for Flat<'_> {
        type Output = Vector3;

        #[inline(always)]
        fn run<S: Machine>(self, machine: S) -> Vector3 {
            score(machine, self.0, Vector3::z(), (&Frame::new(Vector3::z()), &[0.0; 4]))
        }
    }

    /// What is told of places about one, whose noise is `std` along each axis.
    fn told(mut places: Vec<Vector3>, std: f64) -> Vector3 {
        places.sort_by(|p, q| p.norm_squared().total_cmp(&q.norm_squared()));
        places.truncate(60);
        let mut offsets = Offsets::default();
        offsets.set(places.into_iter());
        let noise = Covariance::isotropic(std * std);
        let patch = Patch::new(&offsets, PatchNoise::Uniform(&noise), &noise, 0.1);
        let found = run(Flat(&patch));
        let portable = Flat(&patch).run(Scalar256b);
        assert_eq!(found.map(f64::to_bits), portable.map(f64::to_bits));
        found
    }

    fn grid(keep: impl Fn(f64) -> bool) -> Vec<Vector3> {
        let steps = || (-12..=12).map(|step| 0.1 * f64::from(step));
        let all = steps().flat_map(|x| steps().map(move |y| Vector3::new(x, y, 0.0)));
        all.filter(|place| keep(place.x) && place.norm() > 0.0).collect()
    }

    #[test]
    fn samples_all_around_tell_no_way() {
        assert!(told(grid(|_| true), 0.1).norm() < 1e-9);
    }

    /// At the end of a surface the density falls from all to nothing over the noise, by φ(0)/Φ(0) of it; a window as
    /// wide as needed to tell sees less of that.
    #[test]
    fn at_an_end_samples_are_on_one_side() {
        let found = told(grid(|x| x >= 0.0), 0.1);
        assert!(found.x > 2.0 && found.x < 8.0, "{found}");
        assert!(found.y.abs() < 1e-9 && found.z == 0.0, "{found}");
    }

    /// Of a density that changes by g·x the score is g.
    #[test]
    fn a_density_that_changes_evenly_is_told() {
        let mut mean = Vector3::zeros();
        for draw in 0..400 {
            let unit = |k| seed::unit(seed::derive(7, draw, k));
            let places = (0..400).filter_map(|i| {
                let (x, y) = (2.0 * unit(3 * i) - 1.0, 2.0 * unit(3 * i + 1) - 1.0);
                (unit(3 * i + 2) < 0.5 + 0.4 * x).then_some(Vector3::new(x, y, 0.0))
            });
            mean += told(places.collect(), 0.3) / 400.0;
        }
        assert!((mean - Vector3::new(0.8, 0.0, 0.0)).norm() < 0.15, "{mean}");
    }

    proptest! {
        /// No neighbour counts for all of it as it comes to the edge of the window, nor as it leaves the surface.
        #[test]
        fn it_does_not_jump(x in 0.2..1.4_f64, z in -0.5..0.5_f64) {
            let with = |d: f64| {
                let mut places = grid(|x| x >= 0.0);
                places.push(Vector3::new(x + d, 0.05, z + d));
                told(places, 0.1)
            };
            prop_assert!((with(0.0) - with(1e-9)).norm() < 1e-5);
        }
    }
}
