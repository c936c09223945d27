//! The neighbours of many points that are near one another, found together.

use std::sync::Arc;

use cloudtouch_geom::Point3;

use crate::finite::is_finite;
use crate::positions::{Neighbor, Positions, in_order};

/// How far a block reaches beyond the neighbours it was made for, in distances of the last of them.
const REACH: f64 = 1.75;
/// The neighbours of the next point are looked for up to so many distances of the last neighbour of
/// the one before.
const SEARCHED: f64 = 1.12;
/// A block holds at most so many times the neighbours asked for, else it is made smaller.
const MOST_TIMES: usize = 8;
/// The slack that takes up rounding of distances: a block is complete up to a little less.
const ROUNDING: f64 = 1e-9;

/// All positions of a cloud within a distance of a place, from which the neighbours of places nearby
/// are taken: the same, to the last bit, as those found one by one.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// Of the cloud that it holds a part of.
    cloud: Option<Arc<()>>,
    centre: Point3,
    /// No position is nearer to the centre than this and not in the block, m; infinite when all are
    /// in it.
    radius: f64,
    /// Distance of the last neighbour found, m.
    reach: f64,
    indices: Vec<u32>,
    coordinates: [Vec<f64>; 3],
    /// Of each position from the place in question, m².
    squares: Vec<f64>,
    sorted: Sorted,
}

impl Block {
    /// The `k` positions nearest to a place, without one at the place itself when it is left out, in
    /// order of distance, then index; fewer when there are fewer. A place that is not finite has none.
    pub(crate) fn nearest_into(
        &mut self,
        cloud: &Positions,
        place: &Point3,
        k: usize,
        leave_out_place: bool,
        found: &mut Vec<Neighbor>,
    ) {
        found.clear();
        if k == 0 || !is_finite(place) {
            return;
        }
        let is_same = self.cloud.as_ref().is_some_and(|id| Arc::ptr_eq(id, cloud.id()));
        if !(is_same && self.take(cloud, place, k, leave_out_place, found)) {
            let guess = if is_same { REACH * self.reach } else { 0.0 };
            self.cloud = Some(cloud.id().clone());
            let wanted = k + usize::from(leave_out_place);
            if !self.fill(cloud, place, guess) || self.indices.len() > MOST_TIMES * wanted
                || !self.take(cloud, place, k, leave_out_place, found)
            {
                let last = cloud.distance_of_nearest(place, wanted);
                self.fill(cloud, place, REACH * last);
                if !self.take(cloud, place, k, leave_out_place, found) {
                    // Not even the neighbours are told apart by their distances.
                    found.clear();
                    cloud.search(place, k, leave_out_place, found);
                }
            }
        }
        self.reach = found.last().map_or(0.0, |last| last.squared_distance.sqrt());
    }

    /// Holds what is within a distance of a place from now on; whether there can be anything.
    fn fill(&mut self, cloud: &Positions, place: &Point3, radius: f64) -> bool {
        self.indices.clear();
        self.coordinates.iter_mut().for_each(Vec::clear);
        (self.centre, self.radius) = (*place, radius);
        if radius <= 0.0 {
            return false;
        }
        for near in cloud.hits_within(place, radius * radius) {
            self.indices.push(near.index as u32);
            let position = cloud.points()[near.index];
            for (values, value) in self.coordinates.iter_mut().zip(position.iter()) {
                values.push(*value);
            }
        }
        if self.indices.len() == cloud.distinct() {
            self.radius = f64::INFINITY;
        }
        true
    }

    /// Takes the neighbours out of the block; whether it holds all of them.
    fn take(
        &mut self,
        cloud: &Positions,
        place: &Point3,
        k: usize,
        leave_out_place: bool,
        found: &mut Vec<Neighbor>,
    ) -> bool {
        let complete = (self.radius * (1.0 - ROUNDING) - (place - self.centre).norm()).max(0.0);
        let searched = SEARCHED * self.reach;
        self.measure(place);
        let is_whole = self.radius == f64::INFINITY;
        // Most of the time a little farther than for the last point is far enough.
        for within in [searched, complete] {
            let within = within.min(complete);
            self.sorted.clear();
            for (&index, &square) in self.indices.iter().zip(&self.squares) {
                self.sorted.push_if(square <= within * within, index, square);
            }
            let has_place = leave_out_place
                && self.sorted.hits().any(|hit| {
                    hit.squared_distance == 0.0 && cloud.points()[hit.index] == *place
                });
            let others = self.sorted.len() - usize::from(has_place);
            if others >= k || (is_whole && within == complete) {
                self.sorted.finish(within * within, found);
                if has_place {
                    found.retain(|near| {
                        near.squared_distance > 0.0 || cloud.points()[near.index] != *place
                    });
                }
                found.truncate(k);
                return true;
            }
        }
        false
    }

    fn measure(&mut self, place: &Point3) {
        let [x, y, z] = &self.coordinates;
        self.squares.clear();
        self.squares.extend(x.iter().zip(y).zip(z).map(|((x, y), z)| {
            let [dx, dy, dz] = [x - place.x, y - place.y, z - place.z];
            dx * dx + dy * dy + dz * dz
        }));
    }
}

/// Buckets that neighbours are sorted by.
const BUCKETS: usize = 64;
/// More are sorted by comparison.
const MOST_BUCKETED: usize = 4 * BUCKETS;

/// Sorts neighbours by distance, then index. On a surface their squared distances are spread evenly,
/// so that each bucket gets about one.
#[derive(Debug, Default)]
struct Sorted {
    hits: Vec<Neighbor>,
    count: usize,
}

impl Sorted {
    fn clear(&mut self) {
        self.count = 0;
    }

    fn len(&self) -> usize {
        self.count
    }

    fn hits(&self) -> impl Iterator<Item = &Neighbor> {
        self.hits[..self.count].iter()
    }

    /// Adds a neighbour, or not, without a branch: which it is is hard to foresee.
    #[inline(always)]
    fn push_if(&mut self, is_hit: bool, index: u32, squared_distance: f64) {
        let hit = Neighbor { index: index as usize, squared_distance };
        match self.hits.get_mut(self.count) {
            Some(slot) => *slot = hit,
            None => self.hits.push(hit),
        }
        self.count += usize::from(is_hit);
    }

    /// Puts them in order into a buffer; none is farther than the squared distance `most`.
    fn finish(&mut self, most: f64, sorted: &mut Vec<Neighbor>) {
        let hits = &self.hits[..self.count];
        sorted.clear();
        sorted.extend_from_slice(hits);
        let scale = BUCKETS as f64 / most;
        if hits.len() > MOST_BUCKETED || !scale.is_finite() {
            sorted.sort_unstable_by(in_order);
            return;
        }
        let bucket = |hit: &Neighbor| ((hit.squared_distance * scale) as usize).min(BUCKETS - 1);
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
        for at in 1..sorted.len() {
            let hit = sorted[at];
            let mut to = at;
            while to > 0 && in_order(&hit, &sorted[to - 1]).is_lt() {
                sorted[to] = sorted[to - 1];
                to -= 1;
            }
            sorted[to] = hit;
        }
    }
}
