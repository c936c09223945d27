//! Places inside a mesh in the order of how deep they are.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

use cloudtouch_geom::{Point3, bounding_box};

use crate::mesh::Mesh;

/// Places that come one after another are bounded together, and in so many parts where one of them may be the next.
const PARTS: usize = 8;
/// Distances are rounded, relative to the size of the mesh, generously.
const ROUNDING: f64 = 1e-6;

/// The numbers of places inside a mesh, deepest first and of equals in their order. How deep a place is takes long to
/// tell; of most of those that nobody asks for it is not told.
pub(super) struct DeepestFirst<'a> {
    mesh: &'a Mesh,
    places: &'a [Point3],
    waiting: BinaryHeap<Waiting>,
}

/// Places by their numbers, the first and past the last: none is deeper than what comes before, m, as the bits of a
/// number that is not negative, and where that is told a single one is as deep.
///
/// Of equals those come first that are not told, for one of them may be as deep and the first in the order.
type Waiting = (u64, Reverse<bool>, Reverse<usize>, usize);

impl<'a> DeepestFirst<'a> {
    /// Of places in the frame of the mesh.
    pub(super) fn new(mesh: &'a Mesh, places: &'a [Point3]) -> Self {
        let all = (!places.is_empty()).then(|| waiting(f64::INFINITY, false, 0..places.len()));
        Self { mesh, places, waiting: all.into_iter().collect() }
    }

    /// Adds few places as deep as they are, and more in parts that are bounded.
    fn part(&mut self, places: Range<usize>) {
        let mesh = self.mesh;
        if places.len() <= PARTS {
            let of = |at: usize| waiting(mesh.distance(&self.places[at]), true, at..at + 1);
            return self.waiting.extend(places.map(of));
        }
        let (low, high) = bounding_box(&self.places[places.clone()]).unwrap_or_default();
        let middle = nalgebra::center(&low, &high);
        let (depth, size) = (mesh.distance(&middle), places.len().div_ceil(PARTS));
        for begin in places.clone().step_by(size) {
            let part = begin..places.end.min(begin + size);
            let ways = self.places[part.clone()].iter().map(|place| (place - middle).norm());
            // No place is deeper than another by more than the way between them.
            let most = depth + ways.fold(0.0, f64::max);
            let most = most + ROUNDING * (most + mesh.size());
            self.waiting.push(waiting(most, false, part));
        }
    }
}

impl Iterator for DeepestFirst<'_> {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        loop {
            let (_, Reverse(is_told), Reverse(begin), end) = self.waiting.pop()?;
            if is_told {
                return Some(begin);
            }
            self.part(begin..end);
        }
    }
}

fn waiting(depth: f64, is_told: bool, places: Range<usize>) -> Waiting {
    (depth.to_bits(), Reverse(is_told), Reverse(places.start), places.end)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;
    use cloudtouch_testkit::scene;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Along a line and all over, several at one place.
        #[test]
        fn places_come_in_the_order_of_their_depths(
            from in prop::array::uniform3(-0.05..0.05_f64),
            step in prop::array::uniform3(-0.001..0.001_f64),
            scatter in prop_oneof![Just(0.0), 0.0..0.03_f64],
            aside in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..200),
            copies in 1_usize..4,
        ) {
            let mesh = Mesh::prepare(&scene::cuboid([0.6, 0.4, 0.5])).unwrap();
            let at = |(k, aside): (usize, &[f64; 3])| {
                let way = Vector3::from(step) * (k / copies) as f64;
                Point3::from(from) + way + Vector3::from(*aside) * scatter
            };
            let places: Vec<Point3> = aside.iter().enumerate().map(at).collect();
            let told: Vec<usize> = DeepestFirst::new(&mesh, &places).collect();
            let mut sorted: Vec<usize> = (0..places.len()).collect();
            let depths: Vec<f64> = places.iter().map(|place| mesh.distance(place)).collect();
            sorted.sort_by(|p, q| depths[*q].total_cmp(&depths[*p]));
            prop_assert_eq!(told, sorted);
        }
    }
}
