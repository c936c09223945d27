//! A k-d tree over the distinct positions of a cloud.

use std::cmp::Ordering;
use std::num::NonZeroUsize;
use std::sync::Arc;

use cloudtouch_geom::Point3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};

use crate::error::NoiseError;
use crate::finite::is_finite;

/// Squares of differences of such coordinates, and sums of three, are still finite.
const LARGEST_COORDINATE: f64 = 1e150;

/// A nearby point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbor {
    /// Its index in the cloud.
    pub index: usize,
    /// Its squared distance, m².
    pub squared_distance: f64,
}

/// The distinct positions of a cloud, and which are nearest to a place.
#[derive(Debug)]
pub(crate) struct Positions {
    points: Vec<Point3>,
    distinct: usize,
    tree: ImmutableKdTree<f64, 3>,
    /// Tells it from any other while somebody keeps this.
    id: Arc<()>,
}

impl Positions {
    pub(crate) fn try_new(points: Vec<Point3>) -> Result<Self, NoiseError> {
        if u32::try_from(points.len()).is_err() {
            return Err(NoiseError::TooManyPoints { points: points.len() });
        }
        let too_far = |p: &Point3| is_finite(p) && p.coords.amax() > LARGEST_COORDINATE;
        if let Some(index) = points.iter().position(too_far) {
            return Err(NoiseError::CoordinateRange { index, point: points[index] });
        }
        let entries = distinct_entries(&points);
        let tree = ImmutableKdTree::new_from_entries(&entries).map_err(|error| {
            NoiseError::Index { points: points.len(), reason: error.to_string() }
        })?;
        Ok(Self { points, distinct: entries.len(), tree, id: Arc::default() })
    }

    /// The points it was built from, in the order given.
    pub(crate) fn points(&self) -> &[Point3] {
        &self.points
    }

    /// How many different finite positions there are.
    pub(crate) fn distinct(&self) -> usize {
        self.distinct
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
        let query: [f64; 3] = place.coords.into();
        // The slack keeps the tree's box tests, which round, from losing one.
        let within = self
            .tree
            .query(&query)
            .within::<SquaredEuclidean<f64>>(squared_distance * (1.0 + 1e-9))
            .unsorted()
            .execute();
        within
            .iter()
            .filter(|hit| hit.distance <= squared_distance)
            .map(|hit| Neighbor { index: hit.item as usize, squared_distance: hit.distance })
            .collect()
    }

    /// The distance of the position that is `k`-th nearest to a place, or of the last, m.
    pub(crate) fn distance_of_nearest(&self, place: &Point3, k: usize) -> f64 {
        let Some(wanted) = NonZeroUsize::new(k.min(self.distinct)) else { return 0.0 };
        let query: [f64; 3] = place.coords.into();
        let nearest = self.tree.query(&query).nearest_n::<SquaredEuclidean<f64>>(wanted).execute();
        nearest.iter().map(|hit| hit.distance).fold(0.0, f64::max).sqrt()
    }

    /// The `k` positions nearest to a place, with or without one at the place itself, in order of
    /// distance, then index.
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
        let query: [f64; 3] = place.coords.into();
        let take = |item: u32, squared_distance: f64| {
            let index = item as usize;
            let left_out = leave_out_place && self.points[index] == *place;
            (!left_out).then_some(Neighbor { index, squared_distance })
        };
        let nearest = self.tree.query(&query).nearest_n::<SquaredEuclidean<f64>>(wanted).execute();
        found.extend(nearest.iter().filter_map(|hit| take(hit.item, hit.distance)));
        if let (Some(last), Some(next)) = (found.get(k - 1), found.get(k))
            && last.squared_distance == next.squared_distance
        {
            // Which of the tied ones the tree returned is its own affair, so all of them are
            // fetched.
            let all = self.hits_within(place, last.squared_distance);
            found.clear();
            found.extend(
                all.iter().filter_map(|near| take(near.index as u32, near.squared_distance)),
            );
        }
        found.sort_unstable_by(in_order);
        found.truncate(k);
    }
}

pub(crate) fn in_order(a: &Neighbor, b: &Neighbor) -> Ordering {
    a.squared_distance.total_cmp(&b.squared_distance).then(a.index.cmp(&b.index))
}

/// Every finite position once, with the lowest index that has it, in the order of these indices.
fn distinct_entries(points: &[Point3]) -> Vec<(u32, [f64; 3])> {
    let mut entries: Vec<(u32, [f64; 3])> = (0_u32..)
        .zip(points)
        .filter(|(_, point)| is_finite(point))
        // Adding zero turns -0 into 0, which is the same place.
        .map(|(index, point)| (index, point.coords.map(|v| v + 0.0).into()))
        .collect();
    // Equal positions have equal keys; different ones hardly ever have, so most of the time there is
    // nothing to be looked at twice.
    let mut keys: Vec<(u64, u32)> =
        entries.iter().zip(0..).map(|((_, position), place)| (key(position), place)).collect();
    keys.sort_unstable();
    let mut is_copy = vec![false; entries.len()];
    for equal in keys.chunk_by_mut(|a, b| a.0 == b.0).filter(|equal| equal.len() > 1) {
        let entry = |place: u32| &entries[place as usize].1;
        equal.sort_by(|&(_, i), &(_, j)| {
            let [x, y, z] = [0, 1, 2].map(|axis| entry(i)[axis].total_cmp(&entry(j)[axis]));
            x.then(y).then(z).then(i.cmp(&j))
        });
        for pair in equal.windows(2) {
            is_copy[pair[1].1 as usize] = entry(pair[0].1) == entry(pair[1].1);
        }
    }
    let mut is_copy = is_copy.into_iter();
    entries.retain(|_| is_copy.next() == Some(false));
    entries
}

/// A number that is the same for the same position.
fn key(position: &[f64; 3]) -> u64 {
    // Multipliers without a pattern: 2⁶⁴ over the golden ratio, made odd.
    let mixed = |state: u64, value: f64| {
        (state ^ value.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29)
    };
    position.iter().fold(0, |state, &value| mixed(state, value))
}
