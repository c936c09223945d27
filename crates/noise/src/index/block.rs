//! The neighbours of many points that are near one another, found together.

use std::sync::Arc;

use cloudtouch_geom::{Point3, bounding_box};

use crate::finite::is_finite;
use crate::index::neighbor::{Neighbor, in_order};
use crate::index::positions::Positions;
use crate::index::ties::order_ties;
use crate::lanes::{Kernel, Lanes, Machine, Stored, WIDTH, run};

/// A block is made so wide that on a surface it holds about so many positions: enough for the
/// neighbours of many places.
const HELD: f64 = 190.0;
/// Its radius in distances of the last neighbour asked for, at least and at most. Where the noise exceeds
/// the spacing it holds as many as the cube of that, and not the square.
const REACH: [f64; 2] = [1.5, 2.5];
/// The neighbours of the next point are looked for up to so many distances of the last neighbour of
/// the one before.
const SEARCHED: f64 = 1.12;
/// Places are served together up to so many distances of the last neighbour from their middle, by what
/// is so many farther.
const GATHERED: f64 = 2.0;
const SPARE: f64 = 1.4;
/// A block made by the reach of the last place has at most so many positions, else the reach is
/// measured.
const MOST_HELD: usize = 600;
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
    /// Their coordinates in lanes.
    groups: Vec<[Stored; 3]>,
    sorted: Sorted,
}

impl Block {
    /// The `k` positions nearest to a place, without one at the place itself when it is left out, in
    /// order as [`Positions::search`] has them; fewer when there are fewer. A place that is not finite has none.
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
        let wanted = k + usize::from(leave_out_place);
        let is_same = self.cloud.as_ref().is_some_and(|id| Arc::ptr_eq(id, cloud.id()));
        if !(is_same && self.take(place, wanted, found)) {
            let reach = if is_same { self.reach } else { 0.0 };
            self.cloud = Some(cloud.id().clone());
            let [least, most] = REACH;
            let times = (HELD / wanted as f64).sqrt().clamp(least, most);
            self.fill(cloud, place, times * reach);
            if self.indices.len() > MOST_HELD || !self.take(place, wanted, found) {
                self.fill(cloud, place, times * cloud.distance_of_nearest(place, wanted));
                if !self.take(place, wanted, found) {
                    // Positions so near one another that their distances are zero.
                    cloud.search(place, k, leave_out_place, found);
                }
            }
        }
        if leave_out_place {
            let mut near = found.iter().take_while(|near| near.squared_distance == 0.0);
            if let Some(own) = near.position(|near| cloud.points()[near.index] == *place) {
                found.remove(own);
            }
        }
        order_ties(cloud.points(), place, k, found);
        found.truncate(k);
        self.reach = found.last().map_or(0.0, |last| last.squared_distance.sqrt());
    }

    /// Makes ready for the `k` neighbours of each of some places near one another, where these are not much
    /// farther apart than their neighbours reach: so far as is given (m), as the last ones did, or else as
    /// those of their middle do.
    pub(crate) fn gather(
        &mut self,
        cloud: &Positions,
        places: &[Point3],
        k: usize,
        reach: Option<f64>,
    ) {
        let corners = bounding_box(places).filter(|(low, high)| is_finite(low) && is_finite(high));
        let Some((low, high)) = corners else { return };
        let centre = low + 0.5 * (high - low);
        let is_same = self.cloud.as_ref().is_some_and(|id| Arc::ptr_eq(id, cloud.id()));
        let reach = reach
            .or((is_same && self.reach > 0.0).then_some(self.reach))
            .unwrap_or_else(|| cloud.distance_of_nearest(&centre, k + 1));
        let apart = places.iter().map(|place| (place - centre).norm()).fold(0.0, f64::max);
        if apart <= GATHERED * reach {
            self.cloud = Some(cloud.id().clone());
            self.reach = reach;
            self.fill(cloud, &centre, apart + SPARE * reach);
        }
    }

    /// Holds what is within a distance of a place from now on, which may be nothing.
    fn fill(&mut self, cloud: &Positions, place: &Point3, radius: f64) {
        let Self { indices, groups, .. } = self;
        indices.clear();
        groups.clear();
        (self.centre, self.radius) = (*place, radius);
        if radius <= 0.0 {
            return;
        }
        let points = cloud.points().as_slice();
        cloud.visit_within(place, radius * radius, |near| {
            let lane = indices.len() % WIDTH;
            if lane == 0 {
                // Lanes without a position are infinitely far away.
                groups.push([[f64::INFINITY; WIDTH]; 3]);
            }
            indices.push(near.index as u32);
            let position = &points[near.index];
            if let Some(group) = groups.last_mut() {
                for (lanes, value) in group.iter_mut().zip(position.iter()) {
                    lanes[lane] = *value;
                }
            }
        });
        if self.indices.len() == cloud.distinct() {
            self.radius = f64::INFINITY;
        }
    }

    /// Takes the neighbours out of the block, one at the place itself among them; whether it holds
    /// so many, or else all there are.
    fn take(&mut self, place: &Point3, wanted: usize, found: &mut Vec<Neighbor>) -> bool {
        let complete = (self.radius * (1.0 - ROUNDING) - (place - self.centre).norm()).max(0.0);
        let is_whole = self.radius == f64::INFINITY;
        // Most of the time a little farther than for the last point is far enough.
        let likely = Some(SEARCHED * self.reach).filter(|likely| *likely < complete);
        for within in likely.into_iter().chain([complete]) {
            let most = within.powi(2);
            run(Select { block: self, place, most });
            if self.sorted.len() >= wanted || (is_whole && within == complete) {
                self.sorted.finish(most, found);
                return true;
            }
        }
        false
    }
}

/// Selects what is within a squared distance of a place.
struct Select<'a> {
    block: &'a mut Block,
    place: &'a Point3,
    most: f64,
}

impl Kernel for Select<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Machine>(self, machine: S) {
        let Self { block: Block { groups, indices, sorted, .. }, place, most } = self;
        sorted.clear(indices.len());
        for (group, indices) in groups.iter().zip(indices.chunks(WIDTH)) {
            let [x, y, z] = *group;
            let from = |values, value| Lanes::load(machine, values) - Lanes::splat(machine, value);
            let [x, y, z] = [from(x, place.x), from(y, place.y), from(z, place.z)];
            let squares = (x * x + y * y + z * z).stored();
            // PERF: those of a group are near one another, so that mostly all of them are too far.
            let [p, q, r, s] = squares;
            if !((p <= most) | (q <= most) | (r <= most) | (s <= most)) {
                continue;
            }
            for (index, square) in indices.iter().zip(squares) {
                sorted.push_if(square <= most, *index, square);
            }
        }
    }
}

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
struct Sorted {
    hits: Vec<Neighbor>,
    count: usize,
}

impl Sorted {
    /// Forgets them, and makes room for so many.
    #[inline(always)]
    fn clear(&mut self, room: usize) {
        self.count = 0;
        if self.hits.len() < room {
            self.hits.resize(room, Neighbor { index: 0, squared_distance: 0.0 });
        }
    }

    fn len(&self) -> usize {
        self.count
    }

    /// Adds a neighbour, or not, without a branch: which it is is hard to foresee.
    #[inline(always)]
    fn push_if(&mut self, is_hit: bool, index: u32, squared_distance: f64) {
        if let Some(slot) = self.hits.get_mut(self.count) {
            *slot = Neighbor { index: index as usize, squared_distance };
        }
        self.count += usize::from(is_hit);
    }

    /// Puts them in order into a buffer; none is farther than the squared distance `most`.
    fn finish(&mut self, most: f64, sorted: &mut Vec<Neighbor>) {
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
