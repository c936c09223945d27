//! The samples of a mesh that are nearest to a place, without those farther away.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use cloudtouch_geom::Point3;

use crate::error::SubdivisionError;

use super::subdivide::{MAX_DEPTH, SampleRegion, by_coordinates, samples_of};

/// How far a computed distance may be off, as a share of the coordinates; generously.
const ROUNDING: f64 = 1e-12;
/// Samples whose distances differ by less than about this share of the spacing are as near as each other: those of a
/// regular part often are, and rounding is not to choose among them.
const TIED: f64 = 1e-6;

/// As many as wanted of the samples of [`sample_region`](super::sample_region), nearest to the middle of the
/// region, in order of distance, as far as it tells, then place.
///
/// # Errors
/// When that takes more than `max_parts` parts, those that were split included and those farther away than
/// what is wanted not.
pub(crate) fn nearest_in_region(
    triangles: impl IntoIterator<Item = [Point3; 3]>,
    region: &SampleRegion,
    wanted: usize,
    max_parts: usize,
) -> Result<Vec<Point3>, SubdivisionError> {
    let mut nearest = Nearest { region, wanted, samples: Vec::new(), parts: 0, max_parts };
    let away = |corners: [Point3; 3]| (region.away(&corners), corners);
    let is_beyond = |&(away, _): &(f64, _)| away > region.radius;
    let triangles: Vec<(f64, [Point3; 3])> =
        triangles.into_iter().map(away).filter(|triangle| !is_beyond(triangle)).collect();
    let largest = triangles.iter().map(|(_, corners)| size_of(corners)).fold(0.0, f64::max);
    // PERF: few come before all that are wanted are known, so that most need not be put in order.
    let key = |(place, (away, _)): (usize, &(f64, _))| Reverse((by_size(*away), place));
    let mut order: BinaryHeap<_> = triangles.iter().enumerate().map(key).collect();
    while let Some(Reverse((_, place))) = order.pop() {
        let (away, corners) = triangles[place];
        if nearest.is_farther(away, largest) {
            break;
        }
        nearest.look(away, corners, MAX_DEPTH);
    }
    if nearest.parts > max_parts {
        return Err(SubdivisionError { spacing: region.spacing, max_parts });
    }
    Ok(nearest.samples.into_iter().map(|(_, place)| place).collect())
}

/// The nearest samples so far.
struct Nearest<'a> {
    region: &'a SampleRegion,
    wanted: usize,
    /// Each with its distance from the middle in [steps](steps), in [order](by_distance), no more than wanted.
    samples: Vec<(f64, Point3)>,
    /// Triangles looked at so far, before and after splitting.
    parts: usize,
    max_parts: usize,
}

impl Nearest<'_> {
    /// Adds what a triangle has, no place of which is nearer than `away`.
    fn look(&mut self, away: f64, corners: [Point3; 3], depth: usize) {
        if !self.may_have_one(away, &corners) {
            return;
        }
        self.parts = self.parts.saturating_add(1);
        if self.parts > self.max_parts {
            return;
        }
        let region = self.region;
        let Some(halves) = region.split(&corners, away, depth) else {
            samples_of(corners).into_iter().for_each(|place| self.add(place));
            return;
        };
        // What is near first: it leaves out most of what is not.
        let [p, q] = halves.map(|half| (region.away(&half), half));
        let in_order = if p.0 <= q.0 { [p, q] } else { [q, p] };
        for (away, half) in in_order {
            self.look(away, half, depth - 1);
        }
    }

    fn may_have_one(&self, away: f64, corners: &[Point3; 3]) -> bool {
        // What is no number is looked at, until there are too many parts.
        !(away > self.region.radius || self.is_farther(away, size_of(corners)))
    }

    /// Whether what is so far away, with coordinates of this size, is farther than all that are wanted.
    fn is_farther(&self, away: f64, size: f64) -> bool {
        let is_full = self.samples.len() == self.wanted;
        let last = self.samples.last().filter(|_| is_full);
        let farthest = last.map_or(f64::INFINITY, |&(steps, _)| (steps + 0.5) * step(self.region));
        away > farthest + ROUNDING * size
    }

    fn add(&mut self, place: Point3) {
        let distance = (place - self.region.center).norm();
        let sample = (steps(distance, self.region), place);
        if distance <= self.region.radius
            // What is there already comes from a part that has this corner too.
            && let Err(at) = self.samples.binary_search_by(|other| by_distance(other, &sample))
        {
            self.samples.insert(at, sample);
            self.samples.truncate(self.wanted);
        }
    }
}

/// Distances that differ by less are not told apart, m.
fn step(region: &SampleRegion) -> f64 {
    TIED * region.spacing.max(0.0)
}

fn steps(distance: f64, region: &SampleRegion) -> f64 {
    (distance / step(region)).round()
}

/// A number as a whole one of the same order as [`f64::total_cmp`]: among the bits of negative numbers those of
/// the larger ones are less; turned they are more.
fn by_size(number: f64) -> i64 {
    let bits = number.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// The largest coordinate of some places, m.
fn size_of(corners: &[Point3; 3]) -> f64 {
    corners.iter().map(|p| p.coords.amax()).fold(0.0, f64::max)
}

fn by_distance(p: &(f64, Point3), q: &(f64, Point3)) -> Ordering {
    p.0.total_cmp(&q.0).then_with(|| by_coordinates(&p.1, &q.1))
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;
    use proptest::prelude::*;

    use super::super::subdivide::sample_region;
    use super::*;

    fn rim(k: i32, count: i32, radius: f64) -> Point3 {
        let turn = std::f64::consts::TAU * f64::from(k) / f64::from(count);
        Point3::new(radius * turn.cos(), radius * turn.sin(), 0.0)
    }

    /// The first of all samples by distance, as far as it tells.
    fn by_all(triangles: &[[Point3; 3]], region: &SampleRegion, wanted: usize) -> Vec<Point3> {
        let mut all = sample_region(triangles.to_vec(), region, 10_000_000).unwrap();
        let distance = |p: &Point3| steps((p - region.center).norm(), region);
        all.sort_by(|p, q| distance(p).total_cmp(&distance(q)).then(by_coordinates(p, q)));
        all.truncate(wanted);
        all
    }

    /// A fan has one corner in all of its triangles.
    #[test]
    fn the_nearest_samples_of_a_fan_are_the_first_of_all_by_distance() {
        let bent = |k| rim(k, 60, 1.0) + Vector3::z() * 0.1 * (3.0 * f64::from(k)).sin();
        let fan: Vec<[Point3; 3]> =
            (0..60).map(|k| [Point3::origin(), bent(k), bent(k + 1)]).collect();
        for (x, wanted) in [(0.0, 3), (0.0, 20), (0.0, 70), (0.4, 1), (0.4, 20), (0.4, 5000)] {
            let center = Point3::new(x, 0.01, 0.02);
            let region = SampleRegion { center, core: 0.3, radius: 0.5, spacing: 0.1 };
            let nearest = nearest_in_region(fan.clone(), &region, wanted, 100_000).unwrap();
            assert_eq!(nearest, by_all(&fan, &region, wanted), "{x} {wanted}");
        }
    }

    /// Every facet of a slender handle is a sliver along all of it, and all of them were split for the
    /// nearest twenty samples.
    #[test]
    fn a_slender_handle_took_more_parts_than_were_allowed() {
        let along = Vector3::z() * 0.28;
        let facet = |k| {
            let [p, q] = [k, k + 1].map(|k| rim(k, 48, 0.013));
            [[p, q, q + along], [p, q + along, p + along]]
        };
        let handle: Vec<[Point3; 3]> = (0..48).flat_map(facet).collect();
        let center = Point3::new(0.013, 0.0, 0.14);
        let region = SampleRegion { center, core: 0.08, radius: 0.08, spacing: 0.0075 };
        assert!(sample_region(handle.clone(), &region, 3_000).is_err());
        let nearest = nearest_in_region(handle.clone(), &region, 20, 3_000).unwrap();
        assert_eq!(nearest, by_all(&handle, &region, 20));
    }

    #[test]
    fn a_spacing_of_nanometres_is_little_work_and_none_at_all_is_refused() {
        let [x, y] = [Vector3::x(), Vector3::y()];
        let corners = [Point3::origin(), Point3::origin() + x, Point3::origin() + y];
        let center = Point3::new(0.3, 0.3, 0.0);
        let nearest = |spacing| {
            let region = SampleRegion { center, core: 0.1, radius: 0.1, spacing };
            nearest_in_region([corners], &region, 5, 20_000)
        };
        assert_eq!(nearest(1e-9).map(|places| places.len()), Ok(5));
        assert!([0.0, -1.0, f64::NAN].into_iter().all(|spacing| nearest(spacing).is_err()));
    }

    /// STL files have corners that differ in the sign of a zero; these were two samples.
    #[test]
    fn corners_that_differ_in_the_sign_of_a_zero_are_one_sample() {
        let corners = |zero: f64| [[zero, 0.0, 0.0], [0.1, 0.0, zero], [zero, 0.1, 0.0]];
        let triangles = [0.0, -0.0].map(|zero| corners(zero).map(Point3::from));
        let center = Point3::new(0.03, 0.02, 0.0);
        let region = SampleRegion { center, core: 1.0, radius: 1.0, spacing: 1.0 };
        let nearest = nearest_in_region(triangles, &region, 20, 100).unwrap();
        assert_eq!(nearest.len(), 4);
        assert_eq!(nearest, by_all(&triangles, &region, 20));
    }

    proptest! {
        #[test]
        fn the_nearest_samples_are_the_first_of_all(
            corners in prop::collection::vec(prop::array::uniform9(-1.0_f64..1.0), 1..12),
            flat in 0.0_f64..1.0,
            center in prop::array::uniform3(-0.5_f64..0.5),
            radius in 0.1_f64..1.0,
            wanted in 1_usize..60,
        ) {
            let point = |[x, y, z]: [f64; 3]| Point3::new(x, flat * y, flat * flat * z);
            let triangle = |c: &[f64; 9]| [0, 3, 6].map(|k| point([c[k], c[k + 1], c[k + 2]]));
            let triangles: Vec<[Point3; 3]> = corners.iter().map(triangle).collect();
            let region = SampleRegion { center: point(center), core: 0.5 * radius, radius, spacing: 0.08 };
            let nearest = nearest_in_region(triangles.clone(), &region, wanted, 10_000_000).unwrap();
            prop_assert_eq!(nearest, by_all(&triangles, &region, wanted));
        }
    }
}
