//! What a build sorts: the primitives of a node side by side, so that each level reads memory in
//! order.

use std::slice;

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::build::fit::fitted;
use crate::tree::primitive::centroid;
use crate::{Moments, Obb, Primitives};

/// What is farther from the middle than this many times the median distance is set apart.
const FAR: f64 = 4.0;

/// A primitive that finds its place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    centroid: Point3,
    pub(crate) index: u32,
}

/// Buffers of those who sort, to use again.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    /// The positions along the axis of what is halved.
    along: Vec<f64>,
    /// These in order with the index of the primitive and its place among the parts.
    keys: Vec<u128>,
    sorted: Vec<Part>,
}

pub(crate) fn parts_of(primitives: &Primitives, indices: &[u32]) -> Vec<Part> {
    let part = |&index: &u32| Part { centroid: centroid(primitives.corners(index)), index };
    indices.iter().map(part).collect()
}

/// Moments and box of parts, which may all be points.
pub(crate) fn fitted_parts(
    parts: &[Part],
    primitives: &Primitives,
    are_points: bool,
) -> (Moments, Obb) {
    if are_points {
        let moments = moments_of_points(parts);
        (moments, box_of_points(parts, &moments, moments.axes()))
    } else {
        fitted(parts.iter().map(|part| primitives.corners(part.index)))
    }
}

/// The same of both halves of a node, in less time.
pub(crate) fn fitted_halves(
    halves: [&[Part]; 2],
    primitives: &Primitives,
    are_points: bool,
) -> [(Moments, Obb); 2] {
    if !are_points {
        return halves.map(|parts| fitted_parts(parts, primitives, are_points));
    }
    let moments = halves.map(moments_of_points);
    let axes = Moments::axes_of_two([&moments[0], &moments[1]]);
    [0, 1].map(|k| (moments[k], box_of_points(halves[k], &moments[k], axes[k])))
}

fn moments_of_points(parts: &[Part]) -> Moments {
    Moments::of(parts.iter().map(|part| slice::from_ref(&part.centroid)))
}

fn box_of_points(parts: &[Part], moments: &Moments, axes: Matrix3) -> Obb {
    Obb::enclosing(axes, moments.mean, parts.iter().map(|part| &part.centroid))
}

/// Puts what is far from a place last, farther than [`FAR`] times the median distance, and says where
/// that begins; `None` where nothing is, which leaves the order.
pub(crate) fn set_far_apart(
    parts: &mut [Part],
    from: &Point3,
    memory: &mut Memory,
) -> Option<usize> {
    let Memory { along, sorted, .. } = memory;
    let squared = |part: &Part| (part.centroid - from).norm_squared();
    along.clear();
    along.extend(parts.iter().map(squared));
    let limit = along.iter().copied().fold(0.0, f64::max) / FAR.powi(2);
    let half = parts.len() / 2;
    // PERF: of most bodies more than half is farther than this, so that nothing is far beside it.
    if along.iter().filter(|&&squared| squared >= limit).count() > half {
        return None;
    }
    let (_, &mut median, _) = along.select_nth_unstable_by(half, f64::total_cmp);
    let is_far = |part: &&Part| squared(part) > FAR.powi(2) * median;
    sorted.clear();
    sorted.extend(parts.iter().filter(|part| !is_far(part)));
    let near = sorted.len();
    sorted.extend(parts.iter().filter(is_far));
    parts.copy_from_slice(sorted);
    (0 < near && near < parts.len()).then_some(near)
}

/// Parts some at their median along an axis, the lower half of them first, and says where the other
/// begins.
pub(crate) fn halve(
    parts: &mut [Part],
    axis: &Vector3,
    mean: &Point3,
    memory: &mut Memory,
) -> usize {
    let Memory { along, keys, sorted } = memory;
    along.clear();
    along.extend(parts.iter().map(|part| axis.dot(&(part.centroid - mean))));
    // The sign of an eigenvector is arbitrary and an odd count halves unevenly; letting the
    // longer tail point up makes the partition independent of the frame.
    let is_turned = along.iter().map(|along| along * along * along).sum::<f64>() < 0.0;
    keys.clear();
    keys.extend(along.iter().zip(parts.iter()).zip(0_u32..).map(|((&along, part), place)| {
        let along = if is_turned { -along } else { along };
        let tie = u64::from(part.index) << 32 | u64::from(place);
        u128::from(ordered(along)) << 64 | u128::from(tie)
    }));
    let half = parts.len() / 2;
    keys.select_nth_unstable(half);
    sorted.clear();
    sorted.extend(keys.iter().map(|&key| parts[key as u32 as usize]));
    parts.copy_from_slice(sorted);
    half
}

/// A whole number that is in the order of [`f64::total_cmp`], by which a machine sorts sooner.
fn ordered(value: f64) -> u64 {
    let bits = value.to_bits();
    if value.is_sign_negative() { !bits } else { bits | 1 << 63 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_in_the_order_of_what_they_stand_for() {
        let mut values = [0.0, -0.0, 1.0, -1.0, 1e-310, -1e-310, f64::MAX, f64::MIN, 2.5, -2.5];
        values.sort_by(f64::total_cmp);
        assert!(values.map(ordered).is_sorted_by(|a, b| a < b));
    }
}
