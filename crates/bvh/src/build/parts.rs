//! What a build sorts: the primitives of a node side by side, so that each level reads memory in
//! order.

use std::cmp::Ordering;
use std::slice;

use cloudtouch_geom::{Matrix3, Point3, Vector3};
use wide::f64x4;

use crate::build::fit::fitted;
use crate::tree::primitive::centroid;
use crate::{Moments, Obb, Primitives};

/// What is farther from the middle than this many times the median distance is set apart.
const FAR: f64 = 4.0;
/// Where parts are along an axis is first told by so many counts.
const BINS: usize = 64;
/// A double of this size has no digits below one.
const WHOLE: f64 = (1_u64 << 52) as f64;

/// A primitive that finds its place.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Part {
    pub(crate) centroid: Point3,
    pub(crate) index: u32,
}

/// Buffers of those who sort, to use again.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    /// The positions along the axis of what is halved.
    pub(crate) along: Vec<f64>,
    /// Their places along all three, and the slices that these are in.
    pub(crate) local: Vec<f64x4>,
    pub(crate) slices: Vec<u8>,
    /// Some positions, with what tells apart those that are equal.
    told: Vec<Key>,
    pub(crate) sorted: Vec<Part>,
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

/// Parts some at their median along an axis, the lower half of them first, each half in the order that it had, and
/// says where the other begins.
pub(crate) fn halve(
    parts: &mut [Part],
    axis: &Vector3,
    mean: &Point3,
    memory: &mut Memory,
) -> usize {
    let Memory { along, told, sorted, .. } = memory;
    along.clear();
    along.extend(parts.iter().map(|part| axis.dot(&(part.centroid - mean))));
    bring_longer_tail_up(along);
    let half = parts.len() / 2;
    let least_above = nth(half, along, parts, told);
    part_in_order(parts, sorted, |place, part| is_less((along[place], part.index), least_above));
    half
}

/// The sign of an eigenvector is arbitrary, an odd count halves unevenly and of cuts that are as good the first is
/// taken; letting the longer tail point up makes the partition independent of the frame.
pub(crate) fn bring_longer_tail_up(along: &mut [f64]) {
    if sum_of_cubes(along) < 0.0 {
        along.iter_mut().for_each(|along| *along = -*along);
    }
}

/// Brings those first that are below, by place and part, each half in the order that it had, and says how many they
/// are.
pub(crate) fn part_in_order(
    parts: &mut [Part],
    sorted: &mut Vec<Part>,
    is_below: impl Fn(usize, &Part) -> bool,
) -> usize {
    sorted.resize(sorted.len().max(parts.len()), Part::default());
    let (mut below, mut above) = (0, 0);
    for place in 0..parts.len() {
        let is_below = is_below(place, &parts[place]);
        // PERF: without a branch, which would be wrong half of the time.
        sorted[above] = parts[place];
        parts[below] = sorted[above];
        below += usize::from(is_below);
        above += usize::from(!is_below);
    }
    parts[below..].copy_from_slice(&sorted[..above]);
    below
}

/// Where a part is along an axis, and its index, which tells apart those at one place.
type Key = (f64, u32);

fn is_less((along, index): Key, (than, than_index): Key) -> bool {
    along < than || (along == than && index < than_index)
}

/// The key that so many are less than.
fn nth(mut rank: usize, along: &[f64], parts: &[Part], told: &mut Vec<Key>) -> Key {
    // PERF: counted by bins, of which one has to be looked into.
    let (low, high) = ends(along);
    let scale = (BINS - 1) as f64 / (high - low);
    // The last bits of a sum with 2⁵² are the whole number; where there is no scale all are in one bin.
    let bin = |along: f64| ((along - low) * scale + WHOLE).to_bits() as usize % BINS;
    let mut counts = [0_u32; BINS];
    for &along in along {
        counts[bin(along)] += 1;
    }
    let mut own = 0;
    while counts[own] as usize <= rank {
        rank -= counts[own] as usize;
        own += 1;
    }
    told.clear();
    for (&along, part) in along.iter().zip(parts) {
        if bin(along) == own {
            told.push((along, part.index));
        }
    }
    let in_order = |(one, index): &Key, (other, other_index): &Key| {
        one.partial_cmp(other).unwrap_or(Ordering::Equal).then(index.cmp(other_index))
    };
    *told.select_nth_unstable_by(rank, in_order).1
}

pub(crate) fn ends(values: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &value in values {
        low = if value < low { value } else { low };
        high = if value > high { value } else { high };
    }
    (low, high)
}

/// In four sums, so that none has to wait for the last addition.
fn sum_of_cubes(values: &[f64]) -> f64 {
    let cube = |value: f64| value * value * value;
    let fours = values.chunks_exact(4);
    let rest: f64 = fours.remainder().iter().map(|&value| cube(value)).sum();
    let mut sums = [0.0; 4];
    for four in fours {
        sums.iter_mut().zip(four).for_each(|(sum, &value)| *sum += cube(value));
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Places along x, whose indices fall.
    fn parts_at(along: &[f64]) -> Vec<Part> {
        let index = |place: usize| (along.len() - place) as u32;
        let part = |(place, &x)| Part { centroid: Point3::new(x, 0.0, 0.0), index: index(place) };
        along.iter().enumerate().map(part).collect()
    }

    proptest! {
        /// Whatever is counted first, the lower half is that of all in order, and keeps the order that it had.
        #[test]
        fn halves_are_those_of_all_in_order(
            mut along in prop::collection::vec(-1.0..1.0_f64, 2..300),
            step in prop::sample::select(vec![0.0, 0.01, 0.3, 10.0]),
            scale in prop::sample::select(vec![1.0, 1e-310, 1e90]),
            far in prop::option::of(0..300_usize),
        ) {
            let rounded = |x: f64| if step > 0.0 { (x / step).round() * step } else { x };
            along.iter_mut().for_each(|x| *x = scale * rounded(*x));
            if let Some(far) = far {
                let count = along.len();
                along[far % count] = 1e9 * scale;
            }
            let before = parts_at(&along);
            let mut halved = before.clone();
            let half = halve(&mut halved, &Vector3::x(), &Point3::origin(), &mut Memory::default());
            let is_turned = sum_of_cubes(&along) < 0.0;
            let key = |part: &Part| {
                (if is_turned { -part.centroid.x } else { part.centroid.x }, part.index)
            };
            let mut sorted = before.clone();
            sorted.sort_by(|a, b| key(a).partial_cmp(&key(b)).expect("finite places"));
            let low: Vec<u32> = sorted[..half].iter().map(|part| part.index).collect();
            let indices = |parts: &[Part]| parts.iter().map(|part| part.index).collect::<Vec<_>>();
            let (kept, others): (Vec<Part>, Vec<Part>) =
                before.iter().partition(|part| low.contains(&part.index));
            prop_assert_eq!(half, along.len() / 2);
            prop_assert_eq!(indices(&halved[..half]), indices(&kept));
            prop_assert_eq!(indices(&halved[half..]), indices(&others));
        }
    }
}
