//! Coverage: how much of a node's surface is expected to lie inside its box (section 5).

use std::sync::OnceLock;

use cloudtouch_geom::normal;

use crate::{Obb, Primitive};

/// Beyond this many standard deviations a tail (below 1e-18) changes no sum of weights.
const NEGLIGIBLE: f64 = 9.0;

/// The coverages of nodes that were asked for: each takes a pass over all points of its node, and
/// [`Certified`](crate::Traversal::Certified) never asks.
#[derive(Debug, Clone, Default)]
pub(crate) struct Coverages(OnceLock<Vec<OnceLock<f64>>>);

impl Coverages {
    /// 1 − P_cov of one of so many nodes, computed when first asked for.
    pub(crate) fn outside(&self, node: u32, count: usize, compute: impl FnOnce() -> f64) -> f64 {
        let all = self.0.get_or_init(|| vec![OnceLock::new(); count]);
        *all[node as usize].get_or_init(compute)
    }

    /// What was computed of a node.
    pub(crate) fn known(&self, node: u32) -> Option<f64> {
        self.0.get()?.get(node as usize)?.get().copied()
    }

    /// Of nodes that are, or hold, something else now.
    pub(crate) fn forget(&mut self) {
        self.0.take();
    }
}

/// 1 − P_cov = Σ w_i P_out(x_i) / Σ w_i, in \[0, 1\]; the largest P_out when every weight is zero,
/// 0 when there is no primitive.
pub(crate) fn fraction_outside(primitives: impl Iterator<Item = Primitive>, obb: &Obb) -> f64 {
    let (mut outside, mut total, mut worst) = (0.0, 0.0, 0.0_f64);
    for primitive in primitives {
        let (out, weight) = (probability_outside(&primitive, obb), primitive.weight());
        outside += weight * out;
        total += weight;
        worst = worst.max(out);
    }
    if total > 0.0 { (outside / total).min(1.0) } else { worst }
}

/// P_out = 1 − the least, over the three box axes, of the probability that the surface point lies
/// between the two faces; 0 for an exact primitive, which the box holds.
fn probability_outside(primitive: &Primitive, obb: &Obb) -> f64 {
    let Primitive::Point { point, .. } = primitive else { return 0.0 };
    let [xx, _, _, yy, _, zz] = point.covariance.upper_triangle();
    let variance_bound = xx + yy + zz;
    if variance_bound == 0.0 {
        return 0.0;
    }
    let local = obb.to_local(&point.mean);
    // Distances to the nearer and the farther face of each axis, in standard deviations.
    let mut near = [f64::INFINITY; 3];
    let mut far = [f64::INFINITY; 3];
    for k in 0..3 {
        let depth = (obb.half_extents[k] - local[k].abs()).max(0.0);
        if depth * depth > NEGLIGIBLE * NEGLIGIBLE * variance_bound {
            continue;
        }
        let std = point.covariance.std_along(&obb.axes.column(k).into_owned());
        if std > 0.0 {
            near[k] = depth / std;
            far[k] = (obb.half_extents[k] + local[k].abs()) / std;
        }
    }
    let nearest = near[0].min(near[1]).min(near[2]);
    let mut worst = 0.0_f64;
    for k in 0..3 {
        // PERF: tails take most of a build. An axis this much farther cannot be the worst: for
        // z >= 0 a tail at z + 0.7 is less than half of that at z, so two of them are less.
        if near[k] < nearest + 0.7 {
            let beyond_far = if far[k] > NEGLIGIBLE { 0.0 } else { normal::upper_tail(far[k]) };
            worst = worst.max(normal::upper_tail(near[k]) + beyond_far);
        }
    }
    worst.min(1.0)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, Vector3};

    use super::*;

    fn unit_box() -> Obb {
        Obb {
            centre: Point3::origin(),
            axes: Matrix3::identity(),
            half_extents: Vector3::new(1.0, 0.5, 0.1),
        }
    }

    fn point(mean: [f64; 3], variances: [f64; 3], weight: f64) -> Primitive {
        let point =
            UncertainPoint { mean: mean.into(), covariance: Covariance::diagonal(variances) };
        Primitive::Point { point, weight }
    }

    #[test]
    fn outside_is_the_worst_axis() {
        let out = |mean, variances| probability_outside(&point(mean, variances, 1.0), &unit_box());
        assert_eq!(out([0.9, 0.4, 0.0], [0.0; 3]), 0.0);
        // On a face: half of it is out, and with a tiny std nothing reaches the far face.
        assert!((out([1.0, 0.0, 0.0], [1e-6, 0.0, 0.0]) - 0.5).abs() < 1e-12);
        // One std inside the y faces' centre: two tails.
        let both = 2.0 * normal::upper_tail(0.5 / 0.3);
        assert!((out([0.0; 3], [0.0, 0.09, 0.0]) - both).abs() < 1e-12);
        // The worst axis counts, not the product.
        assert!((out([1.0, 0.0, 0.0], [1e-6, 0.09, 0.0]) - 0.5).abs() < 1e-12);
    }

    /// All six tails, and no shortcut.
    fn reference(mean: [f64; 3], std: f64) -> f64 {
        let half = unit_box().half_extents;
        (0..3)
            .map(|k| {
                let tail = |distance: f64| normal::upper_tail(distance / std);
                tail(half[k] - mean[k]) + tail(half[k] + mean[k])
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn shortcuts_change_nothing() {
        for i in 0..2000 {
            let draw = |k| cloudtouch_geom::seed::unit(cloudtouch_geom::seed::derive(1, i, k));
            let half = unit_box().half_extents;
            let mean: [f64; 3] = std::array::from_fn(|k| half[k] * (2.0 * draw(k as u64) - 1.0));
            let std = 10_f64.powf(3.0 * draw(3) - 3.0);
            let out = probability_outside(&point(mean, [std * std; 3], 1.0), &unit_box());
            assert!((out - reference(mean, std).min(1.0)).abs() < 1e-15);
        }
    }

    #[test]
    fn fraction_weighs_and_survives_zero_weights() {
        let fraction = |points: &[Primitive]| fraction_outside(points.iter().copied(), &unit_box());
        let on_face = |weight| point([1.0, 0.0, 0.0], [1e-6, 0.0, 0.0], weight);
        let in_middle = |weight| point([0.0; 3], [1e-6, 0.0, 0.0], weight);
        assert!((fraction(&[on_face(3.0), in_middle(1.0)]) - 0.375).abs() < 1e-12);
        assert!((fraction(&[on_face(0.0), in_middle(1.0)])).abs() < 1e-12);
        assert!((fraction(&[on_face(0.0), in_middle(0.0)]) - 0.5).abs() < 1e-12);
        assert_eq!(fraction(&[]), 0.0);
    }
}
