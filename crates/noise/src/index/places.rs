//! Which points lie where another was seen before.

use std::hash::BuildHasher;

use cloudtouch_geom::Point3;
use hashbrown::{DefaultHashBuilder, HashTable, hash_table};

/// Points whose places are compared together, on average.
const PART: usize = 2048;
/// Marks to choose among for each point: about one in so many, at most, has that of another by chance.
const MARKS: usize = 8;

/// A point, by the hash of its place and its index.
#[derive(Clone, Copy, Default)]
struct Tag {
    hash: u64,
    index: u32,
}

/// Those of some points of a cloud that lie where an earlier one of them does, to the bit, −0 and 0 being the
/// same: their indices, in order. `some` are indices, each of them once, the earliest first.
///
/// # Panics
/// When there is no point with one of the indices.
pub fn repeated(points: &[Point3], some: impl IntoIterator<Item = u32>) -> Vec<u32> {
    let place = |index: u32| points[index as usize].coords.map(|v| (v + 0.0).to_bits());
    let hasher = DefaultHashBuilder::default();
    let tag = |index: u32| Tag { hash: hasher.hash_one(place(index)), index };
    let (tags, ends) = parted(suspects(some.into_iter().map(tag).collect()));
    let (mut repeated, mut seen, mut start) = (Vec::new(), HashTable::new(), 0);
    for end in ends {
        seen.clear();
        for &own in &tags[start..end] {
            let is_here =
                |other: &Tag| other.hash == own.hash && place(other.index) == place(own.index);
            match seen.entry(own.hash, is_here, |tag| tag.hash) {
                hash_table::Entry::Occupied(_) => repeated.push(own.index),
                hash_table::Entry::Vacant(entry) => drop(entry.insert(own)),
            }
        }
        start = end;
    }
    repeated.sort_unstable();
    repeated
}

/// Those whose hash may be that of another, in the order given: most clouds have no point twice, and of these few are
/// left.
///
/// PERF: two passes over some bits for each, instead of an entry of a table.
fn suspects(tags: Vec<Tag>) -> Vec<Tag> {
    let words = (tags.len() * MARKS / 64).next_power_of_two();
    let mark = |tag: &Tag| ((tag.hash >> 38) as usize % words, 1_u64 << (tag.hash >> 32 & 63));
    // Which were met, and which of them again.
    let mut met = vec![[0_u64; 2]; words];
    for (word, bit) in tags.iter().map(mark) {
        let [once, again] = &mut met[word];
        *again |= *once & bit;
        *once |= bit;
    }
    let is_again = |tag: &Tag| {
        let (word, bit) = mark(tag);
        met[word][1] & bit != 0
    };
    tags.into_iter().filter(is_again).collect()
}

/// Tags by some bits of their hashes, which a table makes no use of, else in the order given, and where each
/// part ends.
///
/// PERF: a table for a part stays near the processor. In one for all of a million points nearly every look
/// waits for memory: three times as long.
fn parted(tags: Vec<Tag>) -> (Vec<Tag>, Vec<usize>) {
    let bits = (tags.len() / PART).checked_ilog2().unwrap_or(0);
    if bits == 0 {
        let all = tags.len();
        return (tags, vec![all]);
    }
    let part = |tag: Tag| (tag.hash >> 32) as usize % (1 << bits);
    let mut ends = vec![0; 1 << bits];
    tags.iter().for_each(|&tag| ends[part(tag)] += 1);
    let mut start = 0;
    for end in &mut ends {
        (*end, start) = (start, start + *end);
    }
    let mut parted = vec![Tag::default(); tags.len()];
    for tag in tags {
        let end = &mut ends[part(tag)];
        parted[*end] = tag;
        *end += 1;
    }
    (parted, ends)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;
    use proptest::prelude::*;

    use super::*;

    /// Those of every point that has an equal one before it.
    fn expected(points: &[Point3], some: &[u32]) -> Vec<u32> {
        let is_repeated =
            |k: &usize| some[..*k].iter().any(|&i| points[i as usize] == points[some[*k] as usize]);
        (0..some.len()).filter(is_repeated).map(|k| some[k]).collect()
    }

    proptest! {
        #[test]
        fn a_point_is_repeated_where_one_before_it_is_equal(
            points in prop::collection::vec(
                prop::array::uniform3(prop::sample::select(vec![-1.0, -0.0, 0.0, 0.5, 1e300])), 0..60),
            every in 1..4_usize,
        ) {
            let points: Vec<Point3> = points.into_iter().map(Point3::from).collect();
            let some: Vec<u32> = (0..points.len() as u32).step_by(every).collect();
            prop_assert_eq!(repeated(&points, some.iter().copied()), expected(&points, &some));
        }
    }

    /// Thousands of places, some of them many times, and one as often as all others.
    #[test]
    fn points_in_many_parts_are_compared_with_all() {
        let draw = |i: u64, most: f64| most * seed::unit(seed::derive(6, i, 0));
        let place = |i: u64| match i % 2 {
            0 => Point3::origin(),
            _ => Point3::new(1.0 + draw(i, 5000.0).floor(), 1.0, 2.0),
        };
        let points: Vec<Point3> = (0..20_000).map(place).collect();
        let mut seen = std::collections::BTreeSet::new();
        let is_repeated = |&i: &u32| !seen.insert(points[i as usize].x.to_bits());
        let expected: Vec<u32> = (0..20_000).filter(is_repeated).collect();
        assert_eq!(repeated(&points, 0..20_000), expected);
    }
}
