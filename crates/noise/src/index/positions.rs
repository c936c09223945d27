//! A k-d tree over the distinct positions of a cloud.

use std::num::NonZeroUsize;
use std::sync::Arc;

use cloudtouch_geom::Point3;
use kiddo::SquaredEuclidean;

use crate::error::NoiseError;
use crate::finite::is_finite;
use crate::index::entries::{PointTree, Threads, tree_of};
use crate::index::neighbor::{Neighbor, in_order};
use crate::index::overlay::{GONE, Overlay};
use crate::index::places::repeated;
use crate::index::ties::{are_tied, order_ties, widened};

/// Squares of differences of such coordinates, and sums of three, are still finite.
const LARGEST_COORDINATE: f64 = 1e150;

/// Positions whose squared distance (m²) is no more may be the same.
const SAME_PLACE: f64 = 1e-300;

/// The distinct positions of a cloud, and which are nearest to a place.
#[derive(Debug)]
pub(crate) struct Positions {
    points: Arc<Vec<Point3>>,
    distinct: usize,
    /// Of the positions when the tree was last built.
    tree: Arc<PointTree>,
    /// What became of them since.
    overlay: Option<Overlay>,
    /// Tells it from any other while somebody keeps this.
    id: Arc<()>,
}

impl Positions {
    pub(crate) fn new(points: impl Into<Arc<Vec<Point3>>>) -> Result<Self, NoiseError> {
        Self::built(points.into(), Threads::All)
    }

    /// The same by the caller alone, who may have what others wait for.
    pub(crate) fn on_this_thread(points: Vec<Point3>) -> Result<Self, NoiseError> {
        Self::built(points.into(), Threads::This)
    }

    fn built(points: Arc<Vec<Point3>>, by: Threads) -> Result<Self, NoiseError> {
        if u32::try_from(points.len()).is_err() {
            return Err(NoiseError::TooManyPoints { points: points.len() });
        }
        let too_far = |p: &Point3| is_finite(p) && p.coords.amax() > LARGEST_COORDINATE;
        if let Some(index) = points.iter().position(too_far) {
            return Err(NoiseError::CoordinateRange { index, point: points[index] });
        }
        let indices = distinct_indices(&points);
        let tree = Arc::new(tree_of(&points, &indices, by)?);
        Ok(Self { points, distinct: indices.len(), tree, overlay: None, id: Arc::default() })
    }

    /// The index of what the cloud became: `before` says which index each point had, if it is where it
    /// was. It shares the tree of this one. `None` where a new one is better: where positions coincide or
    /// are not finite, or too much has changed since the tree was built.
    pub(crate) fn changed(
        &self,
        points: Arc<Vec<Point3>>,
        before: &[Option<u32>],
    ) -> Result<Option<Self>, NoiseError> {
        if self.distinct != self.points.len() {
            return Ok(None);
        }
        let is_usable = |p: &Point3| is_finite(p) && p.coords.amax() <= LARGEST_COORDINATE;
        let new = || (0..).zip(before).filter(|(_, before)| before.is_none()).map(|(i, _)| i);
        if !new().all(|index: usize| is_usable(&points[index])) {
            return Ok(None);
        }
        let earlier = self.overlay.as_ref();
        let overlay = Overlay::after(earlier, self.distinct, &points, before)?;
        if overlay.is_none() {
            return Ok(None);
        }
        let (distinct, tree) = (points.len(), self.tree.clone());
        let changed = Self { points, distinct, tree, overlay, id: Arc::default() };
        let is_alone = |place: &Point3| changed.hits_within(place, SAME_PLACE).len() == 1;
        if !new().all(|index: usize| is_alone(&changed.points[index])) {
            return Ok(None);
        }
        Ok(Some(changed))
    }

    /// The points it was built from, in the order given.
    pub(crate) fn points(&self) -> &Arc<Vec<Point3>> {
        &self.points
    }

    /// How many different finite positions there are.
    pub(crate) fn distinct(&self) -> usize {
        self.distinct
    }

    /// The lowest indices of these, in order.
    pub(crate) fn distinct_indices(&self) -> Vec<u32> {
        if self.distinct == self.points.len() {
            return (0..self.points.len() as u32).collect();
        }
        distinct_indices(&self.points)
    }

    /// The same for no other index that is still in use.
    pub(crate) fn id(&self) -> &Arc<()> {
        &self.id
    }

    /// Every position within a distance of point `index` other than its own, in order of distance,
    /// then index.
    pub(crate) fn within(&self, index: usize, squared_distance: f64) -> Vec<Neighbor> {
        let place = self.points[index];
        if !is_finite(&place) {
            return Vec::new();
        }
        let mut found = self.hits_within(&place, squared_distance);
        found.retain(|near| self.points[near.index] != place);
        found.sort_unstable_by(in_order);
        found
    }

    /// The positions within a distance of a place, in no order.
    pub(crate) fn hits_within(&self, place: &Point3, squared_distance: f64) -> Vec<Neighbor> {
        let mut found = Vec::new();
        self.visit_within(place, squared_distance, |near| found.push(near));
        found
    }

    /// The same one by one.
    pub(crate) fn visit_within(
        &self,
        place: &Point3,
        squared_distance: f64,
        mut visit: impl FnMut(Neighbor),
    ) {
        let mut within = |tree: &PointTree, now: &[u32]| {
            let query: [f64; 3] = place.coords.into();
            // The slack keeps the tree's box tests, which round, from losing one.
            tree.query(&query)
                .within::<SquaredEuclidean<f64>>(squared_distance * (1.0 + 1e-9))
                .unsorted()
                .visit(|hit| {
                    if hit.distance <= squared_distance
                        && let Some(near) = neighbor(hit.item, hit.distance, now)
                    {
                        visit(near);
                    }
                });
        };
        match &self.overlay {
            None => within(&self.tree, &[]),
            Some(overlay) => {
                within(&self.tree, &overlay.now);
                within(&overlay.added, &[]);
            }
        }
    }

    /// The same, of many no more than about the nearest so many: where any may be left out, the squared distance up to
    /// which none is.
    pub(crate) fn visit_most_within(
        &self,
        place: &Point3,
        squared_distance: f64,
        most: NonZeroUsize,
        mut visit: impl FnMut(Neighbor),
    ) -> Option<f64> {
        let query: [f64; 3] = place.coords.into();
        let mut within = |tree: &PointTree, now: &[u32]| {
            let nearest = tree.query(&query).nearest_n::<SquaredEuclidean<f64>>(most);
            let hits = nearest.within(squared_distance * (1.0 + 1e-9)).unsorted().execute();
            let near = hits.iter().filter_map(|hit| neighbor(hit.item, hit.distance, now));
            near.for_each(&mut visit);
            let farthest = hits.iter().map(|hit| hit.distance).fold(0.0, f64::max);
            (hits.len() == most.get()).then_some(farthest)
        };
        match &self.overlay {
            None => within(&self.tree, &[]),
            Some(overlay) => {
                let cut = [within(&self.tree, &overlay.now), within(&overlay.added, &[])];
                cut.into_iter().flatten().reduce(f64::min)
            }
        }
    }

    /// The distance of the position that is `k`-th nearest to a place, or of the last, m.
    pub(crate) fn distance_of_nearest(&self, place: &Point3, k: usize) -> f64 {
        let Some(wanted) = NonZeroUsize::new(k.min(self.distinct)) else { return 0.0 };
        let mut found = Vec::new();
        self.nearest(place, wanted, &mut found);
        let distances = found.iter().take(wanted.get()).map(|near| near.squared_distance);
        distances.fold(0.0, f64::max).sqrt()
    }

    /// The positions nearest to a place, in order of distance: so many at least, or all.
    fn nearest(&self, place: &Point3, wanted: NonZeroUsize, found: &mut Vec<Neighbor>) {
        let query: [f64; 3] = place.coords.into();
        let nearest = |tree: &PointTree, most: NonZeroUsize| {
            tree.query(&query).nearest_n::<SquaredEuclidean<f64>>(most).execute()
        };
        let Some(overlay) = &self.overlay else {
            let hits = nearest(&self.tree, wanted);
            found.extend(hits.iter().filter_map(|hit| neighbor(hit.item, hit.distance, &[])));
            return;
        };
        let mut came = Vec::new();
        if let Some(wanted) = NonZeroUsize::new(wanted.get().min(overlay.added_count)) {
            let hits = nearest(&overlay.added, wanted);
            came.extend(hits.iter().filter_map(|hit| neighbor(hit.item, hit.distance, &[])));
        }
        let (mut most, all) = (wanted, overlay.now.len());
        loop {
            found.clear();
            let hits = nearest(&self.tree, most);
            let now = &overlay.now;
            found.extend(hits.iter().filter_map(|hit| neighbor(hit.item, hit.distance, now)));
            let is_all = found.len() >= wanted.get() || most.get() >= all;
            found.extend(&came);
            found.sort_unstable_by(in_order);
            if is_all {
                return;
            }
            if let Some(last) = found.get(wanted.get() - 1) {
                // Those that are gone took the places of others, which are no farther than these.
                *found = self.hits_within(place, last.squared_distance);
                found.sort_unstable_by(in_order);
                return;
            }
            most = most.saturating_mul(NonZeroUsize::MIN.saturating_add(1));
        }
    }

    /// The `k` positions nearest to a place, with or without one at the place itself, in order of
    /// distance, of what is as near in that of x, y and z.
    pub(crate) fn search(
        &self,
        place: &Point3,
        k: usize,
        leave_out_place: bool,
        found: &mut Vec<Neighbor>,
    ) {
        found.clear();
        // One more than asked for shows whether a tie was cut, and one more makes up for `place`.
        let wanted = self.distinct.min(k.saturating_add(1 + usize::from(leave_out_place)));
        let Some(wanted) = NonZeroUsize::new(wanted).filter(|_| k > 0 && is_finite(place)) else {
            return;
        };
        let is_taken = |near: &Neighbor| !leave_out_place || self.points[near.index] != *place;
        self.nearest(place, wanted, found);
        found.retain(is_taken);
        if let (Some(last), Some(next)) = (found.get(k - 1), found.get(k))
            && are_tied(last, next)
        {
            // Which of the tied ones the tree returned is its own affair, so all of them are
            // fetched.
            *found = self.hits_within(place, widened(last.squared_distance));
            found.retain(is_taken);
        }
        found.sort_unstable_by(in_order);
        order_ties(&self.points, place, k, found);
        found.truncate(k);
    }
}

/// What a tree has under an item, where that is still there: under the index that it has `now`, if any
/// index changed.
fn neighbor(item: u32, squared_distance: f64, now: &[u32]) -> Option<Neighbor> {
    let index = now.get(item as usize).copied().unwrap_or(item);
    (index != GONE).then_some(Neighbor { index: index as usize, squared_distance })
}

/// The lowest index of every finite position, in order.
fn distinct_indices(points: &[Point3]) -> Vec<u32> {
    let finite = (0_u32..).zip(points).filter(|(_, point)| is_finite(point));
    let mut indices: Vec<u32> = finite.map(|(index, _)| index).collect();
    let mut repeated = repeated(points, indices.iter().copied()).into_iter().peekable();
    indices.retain(|index| repeated.next_if_eq(index).is_none());
    indices
}
