//! Neighbours that a block gives, put in order.

use crate::index::neighbor::{Neighbor, in_order};

/// Buckets that neighbours are sorted by.
const BUCKETS: usize = 64;
/// Numbers from here on, up to its double, are one apart.
const LARGE: f64 = (1_u64 << 52) as f64;
/// So few are put in order without buckets.
const MOST_INSERTED: usize = 20;
/// More are sorted by comparison.
const MOST_BUCKETED: usize = 4 * BUCKETS;

/// Sorts neighbours by distance, then index. On a surface their squared distances are spread evenly,
/// so that each bucket gets about one.
#[derive(Debug, Default)]
pub(crate) struct Sorted {
    hits: Vec<Neighbor>,
    count: usize,
}

impl Sorted {
    /// Forgets them, and makes room for so many.
    #[inline(always)]
    pub(crate) fn clear(&mut self, room: usize) {
        self.count = 0;
        if self.hits.len() < room {
            self.hits.resize(room, Neighbor { index: 0, squared_distance: 0.0 });
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Adds a neighbour, or not, without a branch: which it is is hard to foresee.
    #[inline(always)]
    pub(crate) fn push_if(&mut self, is_hit: bool, index: u32, squared_distance: f64) {
        if let Some(slot) = self.hits.get_mut(self.count) {
            *slot = Neighbor { index: index as usize, squared_distance };
        }
        self.count += usize::from(is_hit);
    }

    /// Puts them in order into a buffer; none is farther than the squared distance `most`.
    pub(crate) fn finish(&mut self, most: f64, sorted: &mut Vec<Neighbor>) {
        let hits = &self.hits[..self.count];
        sorted.clear();
        sorted.extend_from_slice(hits);
        if hits.len() <= MOST_INSERTED {
            insert_in_order(sorted);
            return;
        }
        let scale = BUCKETS as f64 / most;
        if hits.len() > MOST_BUCKETED || !scale.is_finite() {
            sorted.sort_unstable_by(in_order);
            return;
        }
        // PERF: the integer part, rounded, are the last bits of a number so large.
        let bucket = |hit: &Neighbor| {
            let rounded = (hit.squared_distance * scale + LARGE).to_bits() as usize;
            (rounded & (2 * BUCKETS - 1)).min(BUCKETS - 1)
        };
        let mut starts = [0_u16; BUCKETS + 1];
        for hit in hits {
            starts[bucket(hit) + 1] += 1;
        }
        for b in 0..BUCKETS {
            starts[b + 1] += starts[b];
        }
        for hit in hits {
            let start = &mut starts[bucket(hit)];
            sorted[usize::from(*start)] = *hit;
            *start += 1;
        }
        insert_in_order(sorted);
    }
}

/// Puts neighbours in order that are nearly so, or few.
fn insert_in_order(sorted: &mut [Neighbor]) {
    for at in 1..sorted.len() {
        let hit = sorted[at];
        let mut to = at;
        while to > 0 && is_before(&hit, &sorted[to - 1]) {
            sorted[to] = sorted[to - 1];
            to -= 1;
        }
        sorted[to] = hit;
    }
}

/// [`in_order`] for squares, which are neither negative nor NaN.
fn is_before(a: &Neighbor, b: &Neighbor) -> bool {
    a.squared_distance < b.squared_distance
        || (a.squared_distance == b.squared_distance && a.index < b.index)
}
