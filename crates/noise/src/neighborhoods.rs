//! The neighbours of a point.

use std::sync::{Arc, OnceLock};

use cloudtouch_geom::Point3;

use crate::error::NoiseError;
use crate::finite::is_finite;
use crate::index::density::{Density, densest_first};
use crate::index::neighbor::Neighbor;
use crate::index::positions::Positions;
use crate::index::thinned::Thinned;
use crate::scratch::Scratch;

/// An index over a cloud that answers which points are nearest.
///
/// Exact duplicates count once, under their lowest index: a scanner that reports a point twice has
/// not seen more of the surface, and a cloud stored twice should look like the cloud. Points that
/// are not finite are nobody's neighbour. Thousands of points sharing a coordinate do no harm.
#[derive(Debug)]
pub struct Neighborhoods {
    positions: Positions,
    /// Their indices in order of density, the densest first and each position once; known when first asked for.
    densest_first: OnceLock<Vec<u32>>,
    /// A part of them, for fits to many; made when first asked for.
    thinned: OnceLock<Vec<Thinned>>,
}

impl Neighborhoods {
    /// Builds the index; O(n log n).
    ///
    /// # Errors
    /// When there are more points than an index can hold (2³² − 1), or a finite coordinate is
    /// beyond 1e150, where squared distances overflow.
    pub fn new(points: Vec<Point3>) -> Result<Self, NoiseError> {
        Self::sharing(points.into())
    }

    /// The same of points that the caller keeps too, without a copy.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn sharing(points: Arc<Vec<Point3>>) -> Result<Self, NoiseError> {
        Ok(Self::of(Positions::new(points)?))
    }

    /// The index of what the cloud became, which shares most of this one and finds the same as one that is
    /// built anew: `before` says of each point which index it had, if it is where it was. `None` where
    /// building is better: where positions coincide, a coordinate is not usable, or more than a fourth of
    /// the points came or went since an index was built. O(n), many times as fast as building.
    ///
    /// # Errors
    /// As [`Self::new`].
    ///
    /// # Panics
    /// When there is not one entry for each point.
    pub fn changed(
        &self,
        points: Arc<Vec<Point3>>,
        before: &[Option<u32>],
    ) -> Result<Option<Self>, NoiseError> {
        assert_eq!(points.len(), before.len(), "one entry for each point");
        let positions = self.positions.changed(points, before)?;
        Ok(positions.map(Self::of))
    }

    fn of(positions: Positions) -> Self {
        Self { positions, densest_first: OnceLock::new(), thinned: OnceLock::new() }
    }

    /// The points it was built from, in the order given.
    pub fn points(&self) -> &[Point3] {
        self.positions.points()
    }

    /// The same, for who keeps them longer without a copy.
    pub fn shared_points(&self) -> Arc<Vec<Point3>> {
        self.positions.points().clone()
    }

    /// How many different finite positions there are.
    pub fn distinct(&self) -> usize {
        self.positions.distinct()
    }

    pub(crate) fn positions(&self) -> &Positions {
        &self.positions
    }

    /// A fourth and a sixteenth of them.
    pub(crate) fn thinned(&self) -> &[Thinned] {
        self.thinned.get_or_init(|| {
            // One after the other: whoever waits here for other threads may be given another point to
            // refine meanwhile, which would wait for this.
            let densest_first = self.densest_first.get_or_init(|| {
                densest_first(self.points(), &Density::everywhere_on_this_thread(&self.positions))
            });
            Thinned::fourth_and_sixteenth(&self.positions, densest_first)
        })
    }

    /// How dense the samples are about every point, on all threads of the pool, and the order of the
    /// indices by that, each position once.
    pub(crate) fn densities(&self) -> (Vec<Density>, &[u32]) {
        let densities = Density::everywhere(&self.positions);
        let order = self.densest_first.get_or_init(|| densest_first(self.points(), &densities));
        (densities, order)
    }

    /// The `k` positions nearest to point `index` other than its own, fewer when there are fewer,
    /// in order of distance, of what is as near (to 1e-7) in that of x, y and z.
    ///
    /// # Panics
    /// When `index` is out of range.
    pub fn nearest(&self, index: usize, k: usize) -> Vec<Neighbor> {
        let mut found = Vec::new();
        self.nearest_into(index, k, &mut found);
        found
    }

    /// [`Self::nearest`] with buffers: many times as fast for points near the last one.
    ///
    /// # Panics
    /// When `index` is out of range.
    pub fn nearest_with<'a>(
        &self,
        index: usize,
        k: usize,
        scratch: &'a mut Scratch,
    ) -> &'a [Neighbor] {
        let Scratch { few_block, neighbors, .. } = scratch;
        few_block.nearest_into(&self.positions, &self.points()[index], k, true, neighbors);
        neighbors
    }

    /// Finds the neighbours of a point, by the block that the last one had.
    pub(crate) fn look_around(&self, index: usize, k: usize, scratch: &mut Scratch) {
        let Scratch { block, neighbors, .. } = scratch;
        block.nearest_into(&self.positions, &self.points()[index], k, true, neighbors);
    }

    /// Makes buffers ready for [`Self::nearest_with`] of some points near one another.
    ///
    /// # Panics
    /// When an index is out of range.
    pub fn gather(&self, indices: impl Iterator<Item = usize>, k: usize, scratch: &mut Scratch) {
        let Scratch { few_block, places, .. } = scratch;
        places.clear();
        places.extend(indices.map(|index| self.points()[index]));
        few_block.gather(&self.positions, places, k, None);
    }

    /// The `k` positions nearest to any place, fewer when there are fewer, in order of distance,
    /// as [`Self::nearest`] has them. A place that is not finite has none.
    pub fn nearest_to(&self, place: &Point3, k: usize) -> Vec<Neighbor> {
        let mut found = Vec::new();
        self.positions.search(place, k, false, &mut found);
        found
    }

    /// Calls `visit` with the positions at most so far from a place, m, in an order that follows from the
    /// cloud and the place; with none within a negative distance, or about a place that is not finite.
    pub fn visit_within(&self, place: &Point3, distance: f64, visit: impl FnMut(Neighbor)) {
        if is_finite(place) && distance >= 0.0 {
            self.positions.visit_within(place, distance * distance, visit);
        }
    }

    /// Whether any position is at most so far from a place, m, which is soon known where none is; not
    /// within a negative distance, or about a place that is not finite.
    pub fn is_any_within(&self, place: &Point3, distance: f64) -> bool {
        is_finite(place)
            && distance >= 0.0
            && !self.positions.hits_within(place, distance * distance).is_empty()
    }

    /// [`Self::nearest`] into a buffer, whose old content is dropped.
    pub(crate) fn nearest_into(&self, index: usize, k: usize, found: &mut Vec<Neighbor>) {
        self.positions.search(&self.points()[index], k, true, found);
    }
}
