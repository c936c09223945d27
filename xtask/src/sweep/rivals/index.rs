//! A k-d tree over the different positions of a cloud.

use std::{cmp::Ordering, num::NonZeroUsize};

use cloudtouch_geom::Point3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};

use super::RivalError;

/// The tree's tests of boxes round: it is asked a hair farther than wanted.
const SLACK: f64 = 1.0 + 1e-9;

/// Which points are near a place.
#[derive(Debug)]
pub(crate) struct Index {
    points: Vec<Point3>,
    tree: ImmutableKdTree<f64, 3>,
}

/// A point found, by its index in the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Found {
    pub index: usize,
    pub distance: f64,
}

impl Index {
    /// Builds the tree over finite points. Points that coincide count once, under the lowest index.
    pub(crate) fn try_new(points: &[Point3]) -> Result<Self, RivalError> {
        let failed = |reason: String| RivalError::Index { reason };
        let count = u32::try_from(points.len()).map_err(|error| failed(error.to_string()))?;
        let mut entries: Vec<(u32, [f64; 3])> =
            (0..count).zip(points).map(|(index, p)| (index, place(p))).collect();
        // Finite numbers without −0 have a total order.
        let by_place = |p: &[f64; 3], q: &[f64; 3]| p.partial_cmp(q).unwrap_or(Ordering::Equal);
        entries.sort_unstable_by(|(i, p), (j, q)| by_place(p, q).then(i.cmp(j)));
        entries.dedup_by(|later, first| later.1 == first.1);
        entries.sort_unstable_by_key(|entry| entry.0);
        let tree = ImmutableKdTree::new_from_entries(&entries)
            .map_err(|error| failed(error.to_string()))?;
        Ok(Self { points: points.to_vec(), tree })
    }

    /// The nearest point, when it is no farther than `limit` metres.
    pub(crate) fn nearest_within(&self, to: &Point3, limit: f64) -> Option<Found> {
        let within = squared(limit);
        let hits = self
            .tree
            .query(&place(to))
            .nearest_n::<SquaredEuclidean<f64>>(NonZeroUsize::MIN)
            .within(within)
            .execute();
        hits.first().map(|hit| self.found(hit.item, to)).filter(|found| found.distance <= limit)
    }

    /// The `count` nearest points, nearest first.
    pub(super) fn nearest(&self, to: &Point3, count: NonZeroUsize) -> Vec<Found> {
        let hits = self.tree.query(&place(to)).nearest_n::<SquaredEuclidean<f64>>(count).execute();
        hits.iter().map(|hit| self.found(hit.item, to)).collect()
    }

    /// All points no farther than `limit` metres, in no particular order.
    pub(super) fn within(&self, to: &Point3, limit: f64) -> impl Iterator<Item = Found> {
        let hits = self
            .tree
            .query(&place(to))
            .within::<SquaredEuclidean<f64>>(squared(limit))
            .unsorted()
            .execute();
        let found = hits.into_iter().map(|hit| self.found(hit.item, to));
        found.filter(move |found| found.distance <= limit).collect::<Vec<_>>().into_iter()
    }

    fn found(&self, item: u32, to: &Point3) -> Found {
        let index = item as usize;
        Found { index, distance: (self.points[index] - to).norm() }
    }
}

/// Adding zero turns −0 into 0, which is the same place.
fn place(point: &Point3) -> [f64; 3] {
    point.coords.map(|v| v + 0.0).into()
}

fn squared(limit: f64) -> f64 {
    (limit * limit * SLACK).min(f64::MAX)
}

#[cfg(test)]
mod tests {
    use cloudtouch_testkit::brute::nearest_neighbours;
    use proptest::prelude::*;

    use super::*;
    use crate::sweep::rivals::test_clouds::cloud;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        #[test]
        fn what_is_near_is_found(
            points in cloud(1..300), places in cloud(1..20), limit in 0.0..0.3_f64,
            count in 1..80_usize,
        ) {
            let index = Index::try_new(&points).unwrap();
            for place in &places {
                let order = nearest_neighbours(&points, place, points.len());
                let distance = |i: usize| (points[i] - place).norm();
                let near: Vec<usize> =
                    order.iter().copied().filter(|&i| distance(i) <= limit).collect();

                let found = index.nearest(place, NonZeroUsize::new(count).unwrap());
                prop_assert!(found.iter().map(|f| f.index).eq(order.iter().copied().take(count)));
                let mut found: Vec<Found> = index.within(place, limit).collect();
                found.sort_by(|f, g| f.distance.total_cmp(&g.distance));
                prop_assert!(found.iter().map(|f| f.index).eq(near.iter().copied()));
                let found = index.nearest_within(place, limit).map(|f| f.index);
                prop_assert_eq!(found, near.first().copied());
            }
        }
    }

    #[test]
    fn twins_are_one_point_under_the_first_index() {
        let places = [[0.0, 1.0, 2.0], [-0.0, 1.0, 2.0], [5.0, 1.0, 2.0], [0.0, 1.0, 2.0]];
        let points = places.map(Point3::from);
        let index = Index::try_new(&points).unwrap();
        let found = index.nearest(&points[3], NonZeroUsize::new(4).unwrap());
        assert_eq!(found.iter().map(|f| f.index).collect::<Vec<_>>(), [0, 2]);
    }
}
