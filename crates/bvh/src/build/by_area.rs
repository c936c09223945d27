//! Cuts a node where its parts would have little surface for how much they hold: what is apart is parted
//! rather than what is many.

use cloudtouch_geom::{Matrix3, Point3};
use wide::f64x4;

use crate::build::parts::{Memory, Part, bring_longer_tail_up, ends, part_in_order};
use crate::tree::obb::in_frame;

/// Cuts are looked for between so many slices of the longest side.
const SLICES: usize = 32;
/// The smaller part has at least one of so many, so that trees do not grow deep.
const MOST_TO_ONE: usize = 10;

/// What is in a slice, or in several.
#[derive(Clone, Copy)]
struct Slice {
    count: usize,
    low: f64x4,
    high: f64x4,
}

impl Slice {
    fn empty() -> Self {
        let infinite = f64x4::splat(f64::INFINITY);
        Self { count: 0, low: infinite, high: -infinite }
    }

    fn and(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            low: self.low.fast_min(other.low),
            high: self.high.fast_max(other.high),
        }
    }

    /// How often a query comes by, as far as that is told by surface, times how much it finds there. Sides
    /// are longer by `least`, so that what is on a line has a surface.
    fn cost(&self, least: f64) -> f64 {
        let [x, y, z, _] = (self.high - self.low + f64x4::splat(least)).to_array();
        self.count as f64 * (x * y + y * z + z * x)
    }
}

/// Parts some across the first of these axes where the sum over both parts of surface times count is least, each
/// part in the order that it had, and says where the second begins; `None`, and all as it was, where no cut leaves
/// so many on both sides.
///
/// The surface area heuristic (Goldsmith and Salmon 1987; MacDonald and Booth 1990), over slices.
pub(crate) fn cut_by_area(
    parts: &mut [Part],
    axes: &Matrix3,
    mean: &Point3,
    least_count: usize,
    memory: &mut Memory,
) -> Option<usize> {
    let Memory { along, local, slices, sorted, .. } = memory;
    let count = parts.len();
    local.clear();
    let in_frame = in_frame(axes, mean);
    local.extend(parts.iter().map(|part| in_frame(&part.centroid)));
    along.clear();
    along.extend(local.iter().map(|place| place.to_array()[0]));
    bring_longer_tail_up(along);
    let (low, high) = ends(along);
    let scale = SLICES as f64 / (high - low);
    slices.clear();
    slices.extend(along.iter().map(|x| (((x - low) * scale) as usize).min(SLICES - 1) as u8));

    let mut all = [Slice::empty(); SLICES];
    for (&place, &slice) in local.iter().zip(slices.iter()) {
        let slice = &mut all[slice as usize];
        slice.count += 1;
        slice.low = slice.low.fast_min(place);
        slice.high = slice.high.fast_max(place);
    }
    let least_count = least_count.max(count / MOST_TO_ONE).max(1);
    let cut = cheapest(&all, least_count, (high - low) / count as f64)? as u8;
    Some(part_in_order(parts, sorted, |place, _| slices[place] < cut))
}

/// The slice before which the cut costs least, the first of several; `None` where each leaves fewer than so many on
/// one side.
fn cheapest(slices: &[Slice; SLICES], least_count: usize, least_side: f64) -> Option<usize> {
    let mut above = [0.0; SLICES];
    let mut upper = Slice::empty();
    for (cut, slice) in slices.iter().enumerate().rev() {
        upper = upper.and(slice);
        above[cut] = if upper.count < least_count { f64::INFINITY } else { upper.cost(least_side) };
    }
    let (mut best, mut least) = (None, f64::INFINITY);
    let mut lower = Slice::empty();
    for (cut, slice) in slices.iter().enumerate().skip(1) {
        lower = lower.and(&slices[cut - 1]);
        if slice.count == 0 || lower.count < least_count {
            continue;
        }
        let cost = lower.cost(least_side) + above[cut];
        if cost < least {
            (best, least) = (Some(cut), cost);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Pose, Vector3, seed};
    use proptest::prelude::*;

    use super::*;

    fn parts_at(places: &[Point3]) -> Vec<Part> {
        places.iter().zip(0..).map(|(&centroid, index)| Part { centroid, index }).collect()
    }

    fn indices(parts: &[Part]) -> Vec<u32> {
        parts.iter().map(|part| part.index).collect()
    }

    /// Cut along x about the origin.
    fn cut(parts: &mut [Part], least_count: usize) -> Option<usize> {
        let (axes, mean) = (Matrix3::identity(), Point3::origin());
        cut_by_area(parts, &axes, &mean, least_count, &mut Memory::default())
    }

    /// Surface times count of some places.
    fn cost(places: &[Point3], least: f64) -> f64 {
        let along = |k: usize| places.iter().map(move |p| p[k]);
        let side =
            |k| along(k).fold(f64::NEG_INFINITY, f64::max) - along(k).fold(f64::INFINITY, f64::min);
        let [x, y, z] = [0, 1, 2].map(|k| side(k) + least);
        places.len() as f64 * (x * y + y * z + z * x)
    }

    /// A thing beside a longer wall of more points: the median is within the wall.
    #[test]
    fn what_is_apart_is_parted() {
        let unit = |i, k| seed::unit(seed::derive(4, i, k));
        let wall = (0..150).map(|i| Point3::new(2.0 * unit(i, 0), 0.01 * unit(i, 1), unit(i, 2)));
        let thing = (150..250)
            .map(|i| Point3::new(3.0 + 0.2 * unit(i, 0), 1.0 + 0.2 * unit(i, 1), 0.2 * unit(i, 2)));
        let mut parts = parts_at(&wall.chain(thing).collect::<Vec<_>>());
        assert_eq!(cut(&mut parts, 6), Some(150));
        assert_eq!(indices(&parts), (0..250).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_at_one_place_is_not_cut() {
        let mut parts = parts_at(&[Point3::new(0.3, 0.2, 0.1); 40]);
        assert_eq!(cut(&mut parts, 1), None);
        assert_eq!(indices(&parts), (0..40).collect::<Vec<_>>());
    }

    proptest! {
        /// Of the cuts between two slices that leave enough on both sides none costs less; either part keeps its
        /// order.
        #[test]
        fn no_cut_between_slices_costs_less(
            mut places in prop::collection::vec([-1.0..1.0_f64, -0.3..0.3_f64, -0.1..0.1_f64], 13..200),
            step in prop::sample::select(vec![0.0, 0.1, 0.5]),
            scale in prop::sample::select(vec![1.0, 1e-9, 1e9]),
            least_count in 1..8_usize,
        ) {
            let rounded = |x: f64| if step > 0.0 { (x / step).round() * step } else { x };
            places.iter_mut().flatten().for_each(|x| *x = scale * rounded(*x));
            let mut places: Vec<Point3> = places.into_iter().map(Point3::from).collect();
            let mut along: Vec<f64> = places.iter().map(|p| p.x).collect();
            bring_longer_tail_up(&mut along);
            places.iter_mut().zip(along).for_each(|(p, x)| p.x = x);
            let mut parts = parts_at(&places);
            let found = cut(&mut parts, least_count);
            let least_count = least_count.max(places.len() / MOST_TO_ONE);
            let (low, high) = places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                (low.min(p.x), high.max(p.x))
            });
            let least_side = (high - low) / places.len() as f64;
            let slice = |p: &Point3| (((p.x - low) * (SLICES as f64 / (high - low))) as usize).min(SLICES - 1);
            let costs = (1..SLICES).filter_map(|at| {
                let (below, above): (Vec<Point3>, Vec<Point3>) = places.iter().partition(|p| slice(p) < at);
                (below.len().min(above.len()) >= least_count)
                    .then(|| cost(&below, least_side) + cost(&above, least_side))
            });
            let least = costs.fold(f64::INFINITY, f64::min);
            let Some(middle) = found else {
                prop_assert_eq!(least, f64::INFINITY);
                return Ok(());
            };
            let (below, above) = parts.split_at(middle);
            prop_assert!(below.is_sorted_by_key(|part| part.index) && above.is_sorted_by_key(|part| part.index));
            let at = |parts: &[Part]| parts.iter().map(|part| part.centroid).collect::<Vec<_>>();
            let (below, above) = (at(below), at(above));
            prop_assert!(below.len().min(above.len()) >= least_count);
            let own = cost(&below, least_side) + cost(&above, least_side);
            prop_assert!(own <= least * (1.0 + 1e-9), "{} above {}", own, least);
        }

        /// The same points are parted in any frame, whichever way the axis points.
        #[test]
        fn a_cut_does_not_depend_on_the_frame(
            places in prop::collection::vec([-1.0..1.0_f64, -0.3..0.3_f64, -0.1..0.1_f64], 13..200),
            turn in [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64],
            is_reversed in any::<bool>(),
        ) {
            let places: Vec<Point3> = places.into_iter().map(Point3::from).collect();
            let mut parts = parts_at(&places);
            let found = cut(&mut parts, 6);
            let pose = Pose::from_translation_rpy(Vector3::new(1.0, -2.0, 3.0), turn);
            let mut moved = parts_at(&places.iter().map(|p| pose.transform_point(p)).collect::<Vec<_>>());
            let mut axes = *pose.rotation().to_rotation_matrix().matrix();
            if is_reversed {
                axes.column_mut(0).neg_mut();
                axes.column_mut(1).neg_mut();
            }
            let mean = pose.transform_point(&Point3::origin());
            let again = cut_by_area(&mut moved, &axes, &mean, 6, &mut Memory::default());
            prop_assert_eq!(found, again);
            prop_assert_eq!(indices(&parts), indices(&moved));
        }
    }
}
