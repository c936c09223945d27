//! The distance between two clouds as they were measured: the smallest, or the k-th smallest,
//! which a single bad point cannot move.

use std::time::Instant;

use super::index::Index;
use super::observed::spread;
use super::smallest::Smallest;
use super::{Answer, Observed, RivalError, micros_since};

/// The smallest distances from points of B to the cloud A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CloudDistance {
    rank: usize,
}

/// Distances between two clouds, and what they cost.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Distances {
    /// The smallest of the distances from a point of B to the nearest of A, over different points
    /// of B, ascending, m.
    pub ascending: Vec<f64>,
    /// Time of the query, µs.
    pub micros: f64,
    /// Time of the preparation, µs.
    pub prepare_micros: f64,
}

impl CloudDistance {
    /// Distances up to that of `rank`: 1 for the minimum alone.
    pub(crate) fn new(rank: usize) -> Self {
        Self { rank }
    }

    /// Prepares a k-d tree over A, transforms B, and looks for the nearest of A to every point of
    /// B, no farther away than the largest of the `rank` distances so far.
    ///
    /// The minimum does not depend on which cloud is A; the larger ranks may.
    ///
    /// # Errors
    /// When the rank is 0 or B has fewer different points.
    pub(crate) fn measure(&self, observed: &Observed<'_>) -> Result<Distances, RivalError> {
        let start = Instant::now();
        let index = Index::try_new(observed.a())?;
        let prepare_micros = micros_since(start);

        let start = Instant::now();
        let b = observed.b_in_a();
        let mut smallest = Smallest::new(self.rank);
        for i in spread(b.len()) {
            if let Some(nearest) = index.nearest_within(&b[i], smallest.bound()) {
                smallest.take(nearest.distance, b[i]);
            }
        }
        let ascending = smallest.distances();
        let micros = micros_since(start);
        Distances { ascending, micros, prepare_micros }.reaching(self.rank)
    }
}

impl Distances {
    /// Minus the distance of `rank` (from 1), m.
    ///
    /// # Errors
    /// When the rank is not among those measured.
    pub(crate) fn answer(&self, rank: usize) -> Result<Answer, RivalError> {
        self.in_units_of(rank, 1.0)
    }

    /// Minus the distance of `rank` (from 1) in units of `scale` metres, the standard deviation
    /// of a difference: it makes clouds of unlike noise and spacing comparable.
    ///
    /// # Errors
    /// When the rank is not among those measured.
    pub(crate) fn in_units_of(&self, rank: usize, scale: f64) -> Result<Answer, RivalError> {
        let points = self.ascending.len();
        let distance = rank.checked_sub(1).and_then(|i| self.ascending.get(i));
        let distance = distance.ok_or(RivalError::Rank { rank, points })?;
        Ok(Answer {
            score: -distance / scale,
            probability: None,
            micros: self.micros,
            prepare_micros: self.prepare_micros,
        })
    }

    /// The same, when there are as many as wanted.
    pub(super) fn reaching(self, rank: usize) -> Result<Self, RivalError> {
        self.answer(rank).map(|_| self)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Point3, Pose};
    use cloudtouch_testkit::brute;
    use proptest::prelude::*;

    use super::*;
    use crate::sweep::rivals::test_clouds::{cloud, pose};

    fn measured(a: &[Point3], b: &[Point3], pose: &Pose, rank: usize) -> Vec<f64> {
        let observed = Observed::try_new(a, b, pose, 0.0).unwrap();
        CloudDistance::new(rank).measure(&observed).unwrap().ascending
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        #[test]
        fn ranks_agree_with_every_pair(
            a in cloud(1..200), b in cloud(5..200), pose in pose(),
        ) {
            let mut all: Vec<f64> = b
                .iter()
                .map(|q| brute::minimum_distance(&a, &[pose.transform_point(q)]))
                .collect();
            all.sort_by(f64::total_cmp);
            let found = measured(&a, &b, &pose, 5);
            prop_assert_eq!(found.len(), 5);
            for (found, expected) in found.iter().zip(&all) {
                prop_assert!((found - expected).abs() <= 1e-14, "{} {}", found, expected);
            }
            prop_assert_eq!(measured(&a, &b, &pose, 1)[0], found[0]);
        }

        #[test]
        fn the_minimum_is_symmetric(a in cloud(1..200), b in cloud(1..200), pose in pose()) {
            let there = measured(&a, &b, &pose, 1)[0];
            let back = measured(&b, &a, &pose.inverse(), 1)[0];
            prop_assert!((there - back).abs() <= 1e-14);
        }
    }

    #[test]
    fn repeated_points_count_once() {
        let a = [Point3::origin()];
        let b: Vec<Point3> =
            [1.0, 2.0, 3.0].iter().flat_map(|&x| [Point3::new(x, 0.0, 0.0); 500]).collect();
        assert_eq!(measured(&a, &b, &Pose::identity(), 3), [1.0, 2.0, 3.0]);
        assert_eq!(measured(&b, &b, &Pose::identity(), 3), [0.0, 0.0, 0.0]);
        let here = Pose::identity();
        let observed = Observed::try_new(&a, &b, &here, 0.0).unwrap();
        let too_many = CloudDistance::new(4).measure(&observed);
        assert_eq!(too_many.unwrap_err(), RivalError::Rank { rank: 4, points: 3 });
        assert!(CloudDistance::new(0).measure(&observed).is_err());
    }

    #[test]
    fn thousands_of_points_may_share_a_coordinate() {
        let grid: Vec<Point3> = (0..4096)
            .map(|i| Point3::new(f64::from(i % 64) * 0.01, f64::from(i / 64) * 0.01, 0.0))
            .collect();
        let above = Pose::from_translation(cloudtouch_geom::Vector3::new(0.0, 0.0, 0.25));
        assert_eq!(measured(&grid, &grid, &above, 5), [0.25; 5]);
    }
}
