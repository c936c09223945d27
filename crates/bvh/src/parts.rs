//! What a build sorts: the primitives of a node side by side, so that each level reads memory in
//! order.

use std::ops::Range;
use std::slice;

use cloudtouch_geom::{Point3, Vector3};

use crate::fit::fitted;
use crate::{Moments, Obb, Primitive};

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
    /// By place in the range that is halved, with the position along the axis.
    keys: Vec<(f64, u32, u32)>,
    sorted: Vec<Part>,
}

impl Parts {
    pub(crate) fn of(primitives: &[Primitive], indices: &[u32]) -> Self {
        let part = |&index: &u32| Part { centroid: primitives[index as usize].centroid(), index };
        let is_point = |&index: &u32| matches!(primitives[index as usize], Primitive::Point { .. });
        Self {
            all: indices.iter().map(part).collect(),
            are_points: indices.iter().all(is_point),
            keys: Vec::new(),
            sorted: Vec::new(),
        }
    }

    /// Moments and box of a range.
    pub(crate) fn fitted(&self, primitives: &[Primitive], range: Range<usize>) -> (Moments, Obb) {
        let parts = &self.all[range];
        if self.are_points {
            fitted(parts.iter().map(|part| slice::from_ref(&part.centroid)))
        } else {
            fitted(parts.iter().map(|part| primitives[part.index as usize].corners()))
        }
    }

    /// Parts a range at its median along an axis: the lower half of it comes first.
    pub(crate) fn halve(&mut self, range: Range<usize>, axis: &Vector3, mean: &Point3) {
        let Self { all, keys, sorted, .. } = self;
        let parts = &mut all[range];
        keys.clear();
        keys.extend(
            parts
                .iter()
                .zip(0..)
                .map(|(part, place)| (axis.dot(&(part.centroid - mean)), part.index, place)),
        );
        // The sign of an eigenvector is arbitrary and an odd count halves unevenly; letting the
        // longer tail point up makes the partition independent of the frame.
        if keys.iter().map(|(key, ..)| key * key * key).sum::<f64>() < 0.0 {
            for (key, ..) in &mut *keys {
                *key = -*key;
            }
        }
        let half = parts.len() / 2;
        keys.select_nth_unstable_by(half, |a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
        sorted.clear();
        sorted.extend(keys.iter().map(|&(.., place)| parts[place as usize]));
        parts.copy_from_slice(sorted);
    }
}
