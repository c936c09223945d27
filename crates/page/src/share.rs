//! How much of each body is drawn.

use std::collections::BTreeMap;

use crate::MOST_POINTS;
use crate::body::{Body, Shape};
use crate::page::Page;
use crate::thin::drawn;

/// How much of something each body may have, where all together may have no more than a limit.
pub(crate) struct Share {
    total: usize,
    limit: usize,
}

impl Share {
    pub(crate) fn of(counts: impl Iterator<Item = usize>, limit: usize) -> Self {
        Self { total: counts.sum(), limit }
    }

    pub(crate) fn of_one(&self, count: usize) -> usize {
        if self.total <= self.limit {
            return count;
        }
        (count as u128 * self.limit as u128 / self.total as u128) as usize
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
