//! What a tree holds of a cloud whose surface is not computed: points as they were measured, and bounds on
//! what refinement may do to them.

use std::sync::Arc;

use cloudtouch_bvh::{LeafBounds, Node, Primitive, Primitives};
use cloudtouch_geom::{Covariance, UncertainPoint};
use cloudtouch_noise::{Neighborhoods, NoiseModel, Scratch, SensorNoise};

use super::pieces::Pieces;
use super::surface::edge::DISC_SPACINGS;

/// Relative rounding of an eigenvalue, generously.
const ROUNDING: f64 = 1e-9;

/// How much surface a point of a cloud stands for in the coverage of a node.
pub(crate) type Weight<'a> = &'a dyn Fn(&Neighborhoods, usize) -> f64;

/// What the tree is to hold of the pieces of a cloud.
pub(super) fn primitives_of(
    points: &Neighborhoods,
    pieces: &Pieces,
    sensor: &SensorNoise,
    weigh: Option<Weight<'_>>,
) -> Primitives {
    let indices = || pieces.indices(points).into_iter();
    if let Some(weigh) = weigh {
        let measured = |index| measured_point(index, points, sensor, weigh(points, index));
        return Primitives::Each(indices().map(measured).collect());
    }
    let means = pieces.neighborhoods(points).shared_points();
    match (sensor.as_uniform(), sensor.shared()) {
        (Some(covariance), _) => Primitives::Alike { means, covariance: *covariance },
        (None, Some(covariances)) if pieces.is_each() => Primitives::Points { means, covariances },
        _ => {
            let covariances = indices().map(|index| sensor[index]).collect();
            Primitives::Points { means, covariances: Arc::new(covariances) }
        }
    }
}

/// A point as it was measured.
pub(super) fn measured_point(
    index: usize,
    points: &Neighborhoods,
    sensor: &SensorNoise,
    weight: f64,
) -> Primitive {
    let (mean, covariance) = (points.points()[index], sensor[index]);
    Primitive::Point { point: UncertainPoint { mean, covariance }, weight }
}

/// What refinement may do to the points of a leaf, given what the spacing of each is limited to (m), the
/// index of each piece and all that was measured.
pub(super) fn leaf_bounds(
    leaf: Node<'_>,
    cap: f64,
    index: impl Fn(u32) -> usize,
    (noise, points, sensor): (&NoiseModel, &Neighborhoods, &SensorNoise),
) -> LeafBounds {
    let indices = || leaf.primitive_indices().iter().map(|&piece| index(piece));
    let all = noise.bounds(most_std(indices().map(|index| &sensor[index])), cap);
    let std = if all.std.is_finite() {
        all.std
    } else {
        // What only the neighbours tell, they are asked for.
        let mut scratch = Scratch::default();
        let mut refined_std = |index| {
            let refined = noise.refine(index, points, sensor, cap, &mut scratch);
            refined.point.covariance.max_std() * (1.0 + ROUNDING)
        };
        indices().map(&mut refined_std).fold(0.0, f64::max)
    };
    LeafBounds { std, shift: all.shift, reach: DISC_SPACINGS * cap }
}

/// No standard deviation of these is larger, m, nor this by more than a millionth than the largest.
fn most_std<'a>(all: impl Iterator<Item = &'a Covariance>) -> f64 {
    // PERF: those of a leaf are much the same.
    all.fold(
        0.0,
        |most, noise| {
            if noise.is_within(most) { most } else { most.max(noise.max_std_at_most()) }
        },
    )
}
