//! The neighbours of many points that are near one another, found together.

use std::num::NonZeroUsize;
use std::sync::Arc;

use cloudtouch_geom::{Point3, bounding_box};

use crate::finite::is_finite;
use crate::index::neighbor::Neighbor;
use crate::index::positions::Positions;
use crate::index::sorted::Sorted;
use crate::index::ties::{order_ties, widened};
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
/// A block has at most so many positions, or twice as many as are asked for at once: about a lone place a few distances
/// of its last neighbour may hold the whole cloud.
const MOST_HELD: usize = 600;
/// After too many were listed, for each so many of them one block is made with care, so that all that is listed in vain
/// is no more than so many for each block.
const PER_CAUTIOUS: usize = 100;
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
    /// So many times what it is to hold is listed with care not to list too many, which takes longer.
    cautious: usize,
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
            self.fill(cloud, place, times * reach, wanted);
            if !self.take(place, wanted, found) {
                self.fill(cloud, place, times * cloud.distance_of_nearest(place, wanted), wanted);
                if !self.take(place, wanted, found) {
                    // Positions so near one another that their distances are zero, or too many as near as the last.
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
            self.fill(cloud, &centre, apart + SPARE * reach, k + 1);
        }
    }

    /// Holds what is within a distance of a place from now on, which may be nothing; of too many, those nearest to it.
    fn fill(&mut self, cloud: &Positions, place: &Point3, radius: f64, wanted: usize) {
        (self.centre, self.radius) = (*place, radius);
        self.clear();
        if radius <= 0.0 {
            return;
        }
        let most = MOST_HELD.max(wanted.saturating_mul(2)).min(cloud.distinct());
        let (points, square) = (cloud.points(), radius * radius);
        let is_cautious = self.cautious > 0;
        let mut count = 0;
        if !is_cautious {
            cloud.visit_within(place, square, |near| {
                count += 1;
                if count <= most {
                    self.push(near.index, &points[near.index]);
                }
            });
        }
        self.cautious = self.cautious.saturating_sub(1);
        if count > most {
            self.cautious = count / PER_CAUTIOUS;
            self.clear();
        }
        if is_cautious || count > most {
            let most = NonZeroUsize::MIN.saturating_add(most);
            let push = |near: Neighbor| self.push(near.index, &points[near.index]);
            if let Some(complete) = cloud.visit_most_within(place, square, most, push) {
                self.radius = complete.sqrt();
            }
        }
        if self.indices.len() == cloud.distinct() {
            self.radius = f64::INFINITY;
        }
    }

    fn clear(&mut self) {
        self.indices.clear();
        self.groups.clear();
    }

    #[inline(always)]
    fn push(&mut self, index: usize, position: &Point3) {
        let lane = self.indices.len() % WIDTH;
        if lane == 0 {
            // Lanes without a position are infinitely far away.
            self.groups.push([[f64::INFINITY; WIDTH]; 3]);
        }
        self.indices.push(index as u32);
        if let Some(group) = self.groups.last_mut() {
            for (lanes, value) in group.iter_mut().zip(position.iter()) {
                lanes[lane] = *value;
            }
        }
    }

    /// Takes the neighbours out of the block, one at the place itself among them; whether it holds
    /// so many, or else all there are.
    fn take(&mut self, place: &Point3, wanted: usize, found: &mut Vec<Neighbor>) -> bool {
        let complete = (self.radius * (1.0 - ROUNDING) - (place - self.centre).norm()).max(0.0);
        let is_whole = self.radius == f64::INFINITY;
        // Most of the time a little farther than for the last point is far enough.
        let likely = Some(SEARCHED * self.reach).filter(|likely| *likely < complete);
        for within in likely.into_iter().chain([complete]).filter(|within| *within > 0.0) {
            let most = within.powi(2);
            run(Select { block: self, place, most });
            let is_all = is_whole && within == complete;
            if self.sorted.len() >= wanted || is_all {
                self.sorted.finish(most, found);
                // What is as near as the last may not be in reach.
                let is_told = |last: &Neighbor| widened(last.squared_distance) <= most;
                if is_all || found.get(wanted - 1).is_some_and(is_told) {
                    return true;
                }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn found(block: &mut Block, cloud: &Positions, place: &Point3, k: usize) -> Vec<Neighbor> {
        let mut found = Vec::new();
        block.nearest_into(cloud, place, k, true, &mut found);
        found
    }

    fn searched(cloud: &Positions, place: &Point3, k: usize) -> Vec<Neighbor> {
        let mut found = Vec::new();
        cloud.search(place, k, true, &mut found);
        found
    }

    /// Once a sheet was in reach of a lone place all of it was listed, there and at the next place of the sheet.
    #[test]
    fn a_few_lone_places_held_the_whole_cloud() {
        let mut points: Vec<Point3> = (0..10_000)
            .map(|i| Point3::new(f64::from(i % 100) * 0.01, f64::from(i / 100) * 0.01, 0.0))
            .collect();
        points.extend(
            (0..50).map(|i| Point3::new(0.1 * f64::from(i % 7), 0.5, 1.0 + 0.02 * f64::from(i))),
        );
        let cloud = Positions::new(points.clone()).unwrap();
        let mut block = Block::default();
        // Of the fifty it is one place and another, and between these one of the sheet.
        for index in (10_000..10_050).flat_map(|lone| [lone, lone - 5000, lone - 9000]) {
            let place = &points[index];
            assert_eq!(
                found(&mut block, &cloud, place, 60),
                searched(&cloud, place, 60),
                "{index}"
            );
            assert!(block.indices.len() <= MOST_HELD + 1, "{index}: {}", block.indices.len());
        }
    }

    /// The one in reach was the answer, and not the one as near that comes before it.
    #[test]
    fn the_edge_of_a_block_cut_through_what_was_as_near() {
        let along = |x: f64| Point3::new(x, 0.0, 0.0);
        let cloud = Positions::new([0.0, 1.0, -1.0 - 2e-8, 5.0].map(along).to_vec()).unwrap();
        let (mut block, place) = (Block::default(), Point3::origin());
        block.cloud = Some(cloud.id().clone());
        block.fill(&cloud, &place, 1.0 + 1.5e-8, 2);
        assert_eq!(block.indices.len(), 2);
        assert_eq!(searched(&cloud, &place, 1)[0].index, 2);
        assert_eq!(found(&mut block, &cloud, &place, 1), searched(&cloud, &place, 1));
    }

    /// A block has more than a search fetches: what was as near as one that was as near as the last came first.
    #[test]
    fn what_was_nearly_as_near_as_a_tie_was_one_of_it_in_a_block() {
        let along = |x: f64| Point3::new(x, 0.0, 0.0);
        let places = [0.0, 1.0, 1.0 + 4e-8, -1.0 - 8e-8, 5.0].map(along).to_vec();
        let (cloud, place) = (Positions::new(places).unwrap(), Point3::origin());
        let expected = searched(&cloud, &place, 1);
        assert_eq!(expected[0].index, 1);
        assert_eq!(found(&mut Block::default(), &cloud, &place, 1), expected);
    }
}
