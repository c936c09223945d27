//! How much of each body is drawn.

use std::collections::BTreeMap;

use crate::MOST_POINTS;
use crate::body::{Body, Shape};
use crate::page::Page;
use crate::thin::drawn;

/// How much of something each body may have, where all together may have no more than a limit.
pub(crate) struct Share {
    limit: usize,
    /// So much of each body is drawn before the rest is shared: else of a box in a scene of millions of
    /// triangles there would be none.
    least: usize,
    /// What all have beyond it, and how much of that may be drawn.
    beyond: usize,
    rest: usize,
    total: usize,
}

/// One part in so many of the limit is given out evenly.
const EVEN: usize = 4;

impl Share {
    pub(crate) fn of(counts: impl Iterator<Item = usize>, limit: usize) -> Self {
        let counts: Vec<usize> = counts.collect();
        let bodies = counts.iter().filter(|&&count| count > 0).count();
        let least = limit / (EVEN * bodies.max(1));
        let given: usize = counts.iter().map(|count| count.min(&least)).sum();
        let total: usize = counts.iter().sum();
        Self { limit, least, beyond: total - given, rest: limit - given, total }
    }

    pub(crate) fn of_one(&self, count: usize) -> usize {
        if self.total <= self.limit {
            return count;
        }
        let least = count.min(self.least);
        least + ((count - least) as u128 * self.rest as u128 / self.beyond as u128) as usize
    }
}

/// For every body the indices of the points that are drawn.
pub(crate) fn choose(
    page: &Page<'_>,
    listed: &[[Vec<(usize, f64)>; 2]],
    notes: &mut Vec<String>,
) -> Vec<Vec<usize>> {
    let mut likely: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); page.bodies.len()];
    for (view, points) in page.views.iter().zip(listed) {
        for (standing, points) in view.pair().into_iter().flatten().zip(points) {
            let Some(likely) = likely.get_mut(standing.body) else { continue };
            for &(index, p) in points {
                let most = likely.entry(index).or_insert(p);
                *most = most.max(p);
            }
        }
    }
    let count = |body: &Body| match &body.shape {
        Shape::Cloud { points, .. } => points.len(),
        Shape::Mesh { .. } => 0,
    };
    let share = Share::of(page.bodies.iter().map(count), MOST_POINTS);
    let chosen = page.bodies.iter().zip(likely).map(|(body, likely)| {
        let (all, limit) = (count(body), share.of_one(count(body)));
        if limit < all {
            notes.push(format!(
                "{}: {limit} of {all} points are drawn; all were used for the answer.",
                body.name
            ));
        }
        drawn(all, limit, &likely.into_iter().collect::<Vec<_>>())
    });
    chosen.collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_box_vanished_beside_a_mesh_of_millions_of_triangles() {
        let share = Share::of([5_000_000, 12].into_iter(), 150_000);
        assert_eq!(share.of_one(12), 12);
        assert!(share.of_one(5_000_000) > 149_000);
    }

    proptest! {
        #[test]
        fn all_together_stay_within_the_limit_and_use_it(
            counts in prop::collection::vec(0_usize..5_000, 1..8),
            limit in 0_usize..8_000,
        ) {
            let share = Share::of(counts.iter().copied(), limit);
            let drawn: Vec<usize> = counts.iter().map(|&count| share.of_one(count)).collect();
            let (drawn_of_all, all): (usize, usize) = (drawn.iter().sum(), counts.iter().sum());
            prop_assert!(drawn.iter().zip(&counts).all(|(drawn, count)| drawn <= count));
            prop_assert!(drawn_of_all <= limit && drawn_of_all + counts.len() >= limit.min(all));
        }
    }
}
