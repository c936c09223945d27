//! One pass of a robust plane fit.

use cloudtouch_geom::{Matrix3, Vector3};

use crate::lanes::{Lanes, Machine};
use crate::patch::{Patch, Plane};
use crate::smallest_axis::smallest_axis;

/// One pass of Tukey weights: the plane through the neighbours weighted by how well they agree
/// with the last one. `None` when nobody agrees, or those who do lie about one line.
#[inline(always)]
pub(crate) fn reweighted<S: Machine>(
    machine: S,
    patch: &Patch,
    plane: &Plane,
    cut: f64,
) -> Option<Plane> {
    let precisions = patch.precisions(&plane.normal);
    let inverse_cut = 1.0 / (cut * cut);
    let mut total = Lanes::zero(machine);
    let mut first = [Lanes::zero(machine); 3];
    let mut second = [Lanes::zero(machine); 6];
    for group in 0..patch.groups() {
        let offsets = patch.group(machine, group);
        let present = patch.present(machine, group);
        let precision = precisions.group(machine, group);
        let residual = plane.residuals(machine, offsets);
        let weight = tukey(machine, residual * residual * precision * inverse_cut) * precision * present;
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
    plane_of_sums(total.sum(), sums(first), sums(second))
}

/// The plane of least squares, from the sum of weights, of weighted vectors, and of their products
/// xx, xy, xz, yy, yz, zz.
#[inline(always)]
pub(crate) fn plane_of_sums(total: f64, first: [f64; 3], second: [f64; 6]) -> Option<Plane> {
    let per_weight = 1.0 / total;
    let centre = Vector3::from(first) * per_weight;
    let [xx, xy, xz, yy, yz, zz] = second;
    let second = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * per_weight;
    // Nobody agreeing makes this NaN, which has no smallest axis.
    let normal = smallest_axis(&(second - centre * centre.transpose()))?;
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
