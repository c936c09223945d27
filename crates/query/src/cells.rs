//! Places in cells, so that those within a distance are found without asking all.

use std::collections::BTreeMap;

use cloudtouch_geom::Point3;

/// Fewer places are asked one by one, and are in no cell.
const FEW: usize = 64;

/// Places by their numbers, from 0 on, and by the cells of a grid that they are in.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    places: Vec<Point3>,
    /// Length of an edge, m: how far the first place looked.
    size: f64,
    cells: BTreeMap<[i64; 3], Vec<usize>>,
}

impl Cells {
    /// Puts the next number at a place that looks so far, m.
    pub(crate) fn push(&mut self, place: &Point3, reach: f64) {
        if self.places.is_empty() {
            self.size = reach.max(f64::MIN_POSITIVE);
        }
        self.places.push(*place);
        let count = self.places.len();
        // PERF: most searches find few, and put none in cells.
        let new = if count == FEW { 0..count } else { count - 1..count };
        for number in new.filter(|_| count >= FEW) {
            self.cells.entry(cell(&self.places[number], 0.0, self.size)).or_default().push(number);
        }
    }

    /// Calls `visit` with the numbers of all places within a distance (m) of one, and of some that are not.
    pub(crate) fn visit_near(&self, place: &Point3, reach: f64, mut visit: impl FnMut(usize)) {
        let [low, high] = [-reach, reach].map(|by| cell(place, by, self.size));
        let rows = (high[0].saturating_sub(low[0])).saturating_add(1) as f64
            * (high[1].saturating_sub(low[1])).saturating_add(1) as f64;
        if self.places.len() < FEW || rows > self.cells.len() as f64 {
            return (0..self.places.len()).for_each(visit);
        }
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                let row = self.cells.range([x, y, low[2]]..=[x, y, high[2]]);
                row.flat_map(|(_, numbers)| numbers).for_each(|&number| visit(number));
            }
        }
    }
}

/// The cell, of edges so long (m), of a place that is moved so far along all axes.
pub(crate) fn cell(place: &Point3, by: f64, size: f64) -> [i64; 3] {
    [place.x, place.y, place.z].map(|x| ((x + by) / size).floor() as i64)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Cells far smaller and far larger than what is looked for.
        #[test]
        fn all_places_within_a_distance_are_found(
            places in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..200),
            first_reach in prop_oneof![Just(0.0), 1e-6..3.0_f64],
            reach in 0.0..2.0_f64,
        ) {
            let places: Vec<Point3> = places.into_iter().map(Point3::from).collect();
            let mut cells = Cells::default();
            places.iter().for_each(|place| cells.push(place, first_reach));
            for at in &places {
                let mut found = BTreeSet::new();
                cells.visit_near(at, reach, |number| assert!(found.insert(number), "twice"));
                let is_missing = |&number: &usize| {
                    (places[number] - at).norm() <= reach && !found.contains(&number)
                };
                prop_assert_eq!((0..places.len()).find(is_missing), None);
            }
        }
    }
}
