//! What a build sorts: the primitives of a node side by side, so that each level reads memory in
//! order.

use std::ops::Range;
use std::slice;

use cloudtouch_geom::{Point3, Vector3};

use crate::fit::fitted;
use crate::primitive::centroid;
use crate::{Moments, Obb, Primitives};

/// What is farther from the middle than this many times the median distance is set apart.
const FAR: f64 = 4.0;

/// A primitive that finds its place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part {
    centroid: Point3,
    pub(crate) index: u32,
}

/// Primitives in the order of the nodes that hold them.
#[derive(Debug)]
pub(crate) struct Parts {
    pub(crate) all: Vec<Part>,
    /// Whether all are points, which their centroids tell all of.
    are_points: bool,
    /// The positions along the axis of the range that is halved.
    along: Vec<f64>,
    /// These in order with the index of the primitive and its place in the range.
    keys: Vec<u128>,
    sorted: Vec<Part>,
}

impl Parts {
    pub(crate) fn of(primitives: &Primitives, indices: &[u32]) -> Self {
        let part = |&index: &u32| Part { centroid: centroid(primitives.corners(index)), index };
        let is_point = |&index: &u32| primitives.is_point(index);
        Self {
            all: indices.iter().map(part).collect(),
            are_points: indices.iter().all(is_point),
            along: Vec::new(),
            keys: Vec::new(),
            sorted: Vec::new(),
        }
    }

    /// Moments and box of a range.
    pub(crate) fn fitted(&self, primitives: &Primitives, range: Range<usize>) -> (Moments, Obb) {
        let parts = &self.all[range];
        if self.are_points {
            let moments = Moments::of(parts.iter().map(|part| slice::from_ref(&part.centroid)));
            let places = parts.iter().map(|part| &part.centroid);
            (moments, Obb::enclosing(moments.axes(), moments.mean, places))
        } else {
            fitted(parts.iter().map(|part| primitives.corners(part.index)))
        }
    }

    /// Puts what is far from a place last, farther than [`FAR`] times the median distance, and says where
    /// that begins; `None` where nothing is, which leaves the order.
    pub(crate) fn set_far_apart(&mut self, range: Range<usize>, from: &Point3) -> Option<usize> {
        let Self { all, along, sorted, .. } = self;
        let parts = &mut all[range.clone()];
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
        (0 < near && near < parts.len()).then_some(range.start + near)
    }

    /// Parts a range at its median along an axis, the lower half of it first, and says where the other
    /// begins.
    pub(crate) fn halve(&mut self, range: Range<usize>, axis: &Vector3, mean: &Point3) -> usize {
        let Self { all, along, keys, sorted, .. } = self;
        let parts = &mut all[range.clone()];
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
        range.start + half
    }
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
