//! One pass of a robust plane fit.

use cloudtouch_geom::{Matrix3, Vector3};

use crate::lanes::{Lanes, Machine};
use crate::surface::patch::{Patch, Plane};
use crate::surface::smallest_axis::smallest_axis;

/// Residuals beyond so many standard deviations weigh nothing.
pub(crate) const TUKEY_CUT: f64 = 3.0;
/// A scatter that is no larger beside the moments that it is the difference of is rounding.
const SCATTER_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// One pass of Tukey weights: the plane through the neighbours weighted by how well they agree
/// with the last one. `None` when nobody agrees, or those who do lie about one line.
#[inline(always)]
pub(crate) fn reweighted<S: Machine>(machine: S, patch: &Patch, plane: &Plane) -> Option<Plane> {
    let precisions = patch.precisions(&plane.normal);
    let inverse_cut = 1.0 / (TUKEY_CUT * TUKEY_CUT);
    let mut total = Lanes::zero(machine);
    let mut first = [Lanes::zero(machine); 3];
    let mut second = [Lanes::zero(machine); 6];
    for group in 0..patch.groups() {
        let offsets = patch.group(machine, group);
        let present = patch.present(machine, group);
        let precision = precisions.group(machine, group);
        let residual = plane.residuals(machine, offsets);
        let weight =
            tukey(machine, residual * residual * precision * inverse_cut) * precision * present;
        let [x, y, z] = offsets;
        let weighted = [weight * x, weight * y, weight * z];
        total += weight;
        for (sum, weighted) in first.iter_mut().zip(weighted) {
            *sum += weighted;
        }
        let products = [
            weighted[0] * x,
            weighted[0] * y,
            weighted[0] * z,
            weighted[1] * y,
            weighted[1] * z,
            weighted[2] * z,
        ];
        for (sum, product) in second.iter_mut().zip(products) {
            *sum += product;
        }
    }
    plane_of_sums((total.sum(), sums(first), sums(second)), patch.whitening())
}

/// The plane of least squares, from the sum of weights, of weighted vectors, and of their products
/// xx, xy, xz, yy, yz, zz.
///
/// Distances are in units of the noise, which `whitening` makes the same in all directions: a layer that noise along rays
/// makes deeper than it is wide is no surface that the rays lie in.
#[inline(always)]
pub(crate) fn plane_of_sums(
    (total, first, second): (f64, [f64; 3], [f64; 6]),
    whitening: Option<&Matrix3>,
) -> Option<Plane> {
    let per_weight = 1.0 / total;
    let centre = Vector3::from(first) * per_weight;
    let [xx, xy, xz, yy, yz, zz] = second;
    let second = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * per_weight;
    let scatter = second - centre * centre.transpose();
    // Where one neighbour alone agrees all of it is rounding, whose axes are any.
    if scatter.trace() <= SCATTER_ROUNDING * second.trace() {
        return None;
    }
    // Nobody agreeing makes this NaN, which has no smallest axis.
    let normal = match whitening {
        None => smallest_axis(&scatter)?,
        Some(whitening) => {
            let axis = smallest_axis(&(whitening * scatter * whitening.transpose()))?;
            (whitening.transpose() * axis).normalize()
        }
    };
    Some(Plane { normal, height: normal.dot(&centre) })
}

/// Not by `map`, which would be compiled without vector instructions.
#[inline(always)]
pub(crate) fn sums<S: Machine, const N: usize>(lanes: [Lanes<S>; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    for (sum, lanes) in sums.iter_mut().zip(lanes) {
        *sum = lanes.sum();
    }
    sums
}

/// The Tukey factor of squared residuals in units of the squared cut.
#[inline(always)]
pub(crate) fn tukey<S: Machine>(machine: S, ratio: Lanes<S>) -> Lanes<S> {
    let rest = (Lanes::splat(machine, 1.0) - ratio).not_negative();
    rest * rest
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Covariance;
    use proptest::prelude::*;
    use pulp::Scalar256b;

    use super::*;
    use crate::lanes::{Kernel, run};
    use crate::surface::patch::{NoiseLanes, Offsets, PatchNoise};

    struct Reweight<'a>(&'a Patch<'a>, &'a Plane);

    impl Kernel for Reweight<'_> {
        type Output = Option<Plane>;

        #[inline(always)]
        fn run<S: Machine>(self, machine: S) -> Option<Plane> {
            reweighted(machine, self.0, self.1)
        }
    }

    /// The same, neighbour by neighbour.
    fn plainly(
        places: &[Vector3],
        noise: &[Covariance],
        floor: f64,
        plane: &Plane,
    ) -> Option<Plane> {
        let (mut total, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for (place, noise) in places.iter().zip(noise) {
            let variance = noise.variance_along(&plane.normal).max(floor);
            let residual = plane.normal.dot(place) - plane.height;
            let rest = (1.0 - residual * residual / variance / 9.0).max(0.0);
            let weight = rest * rest / variance;
            total += weight;
            first += place * weight;
            second += place * place.transpose() * weight;
        }
        let centre = first / total;
        let scatter = second / total - centre * centre.transpose();
        // As large in all directions as the noise of the point is, its first neighbour's.
        let noise = (noise[0].matrix() + Matrix3::identity() * floor).symmetric_eigen();
        let scale =
            Matrix3::from_diagonal(&noise.eigenvalues.map(|variance| 1.0 / variance.sqrt()));
        let whitening = noise.eigenvectors * scale * noise.eigenvectors.transpose();
        let normal = whitening * smallest_axis(&(whitening * scatter * whitening))?;
        let normal = normal.normalize();
        Some(Plane { normal, height: normal.dot(&centre) })
    }

    proptest! {
        /// The plane is that of plain sums within 1e-9, and the same to the bit with and without
        /// vector instructions.
        #[test]
        fn lanes_sum_up_what_one_after_the_other_does(
            places in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 4..61),
            variances in prop::array::uniform3(0.01..0.1_f64),
            is_uniform in any::<bool>(),
            tilt in -0.2..0.2_f64,
        ) {
            let places: Vec<Vector3> =
                places.iter().map(|&[x, y, z]| Vector3::new(x, y, 0.2 * z)).collect();
            let mut offsets = Offsets::default();
            offsets.set(places.iter().copied());
            let noise: Vec<Covariance> = (0..places.len())
                .map(|i| Covariance::diagonal(variances).scaled(if is_uniform { 1.0 } else { 1.0 + i as f64 }))
                .collect();
            let mut lanes = NoiseLanes::default();
            lanes.set(noise.iter());
            let by = if is_uniform { PatchNoise::Uniform(&noise[0]) } else { PatchNoise::Each(&lanes) };
            let patch = Patch::new(&offsets, by, &noise[0], 0.5);
            let plane = Plane { normal: Vector3::new(tilt, 0.0, 1.0).normalize(), height: 0.01 };
            let floor = (0.03_f64 * 0.5).powi(2);
            let found = run(Reweight(&patch, &plane));
            let portable = Reweight(&patch, &plane).run(Scalar256b);
            let bits = |p: Plane| [p.normal.x, p.normal.y, p.normal.z, p.height].map(f64::to_bits);
            prop_assert_eq!(found.map(bits), portable.map(bits));
            if let (Some(found), Some(plain)) = (found, plainly(&places, &noise, floor, &plane)) {
                let sign = found.normal.dot(&plain.normal).signum();
                prop_assert!((found.normal - plain.normal * sign).norm() < 1e-9);
                prop_assert!((found.height - plain.height * sign).abs() < 1e-9);
            }
        }
    }
}
