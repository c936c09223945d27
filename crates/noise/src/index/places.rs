//! Which points lie where another was seen before.

use std::hash::BuildHasher;

use cloudtouch_geom::Point3;
use hashbrown::{DefaultHashBuilder, HashTable, hash_table};

/// The places seen so far, of the points of one cloud, by their indices: an eighth of the memory of the
/// positions themselves.
#[derive(Debug)]
pub struct Places<'a> {
    points: &'a [Point3],
    seen: HashTable<u32>,
    hasher: DefaultHashBuilder,
}

impl<'a> Places<'a> {
    /// None of these points was seen.
    pub fn of(points: &'a [Point3]) -> Self {
        let seen = HashTable::with_capacity(points.len());
        Self { points, seen, hasher: DefaultHashBuilder::default() }
    }

    /// Sees a point, and says whether it is the first at its place, to the bit, −0 and 0 being the same.
    ///
    /// # Panics
    /// When there is no point with this index.
    pub fn is_first(&mut self, index: usize) -> bool {
        let Self { points, seen, hasher } = self;
        // So many points no index can hold: they are refused elsewhere.
        let Ok(number) = u32::try_from(index) else { return true };
        let place = |index: usize| points[index].coords.map(|v| (v + 0.0).to_bits());
        let hash = |index: usize| hasher.hash_one(place(index));
        let own = place(index);
        let is_here = |other: &u32| place(*other as usize) == own;
        match seen.entry(hash(index), is_here, |&other| hash(other as usize)) {
            hash_table::Entry::Occupied(_) => false,
            hash_table::Entry::Vacant(entry) => {
                entry.insert(number);
                true
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_point_is_the_first_where_none_before_it_is_equal(
            points in prop::collection::vec(
                prop::array::uniform3(prop::sample::select(vec![-1.0, -0.0, 0.0, 0.5, 1e300])), 0..60),
        ) {
            let points: Vec<Point3> = points.into_iter().map(Point3::from).collect();
            let mut places = Places::of(&points);
            for (i, point) in points.iter().enumerate() {
                prop_assert_eq!(places.is_first(i), !points[..i].contains(point));
            }
        }
    }
}
