//! What pieces of surface say together at each of the places where they are.

use std::ops::Range;

use cloudtouch_geom::{Point3, Vector3, bounding_box};

use crate::cells::cell;

/// So many cells side by side are as long as the median reach: where they are fewer, many pieces lie on the rim
/// of what one reaches; where they are more, asking the cells takes longer than asking what is in them.
const CELLS_OF_REACH: f64 = 2.0;

/// A witness at its place, with its clearness by sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heard {
    /// Its middle, not where it crosses best: that may move out of reach of others as more crossings are
    /// found, and together they would say less than before.
    pub(super) place: Point3,
    /// The farthest that one of its crossings reaches, m.
    pub(super) reach: f64,
    pub(super) clearness: [f64; 2],
}

/// Pieces by the cells of a grid.
#[derive(Debug)]
pub(super) struct Places {
    /// Those of a cell side by side.
    heard: Vec<Heard>,
    /// The cells that hold some, in order.
    cells: Vec<Cell>,
    /// Length of an edge of a cell, m.
    size: f64,
}

/// Along x, y and z.
type Name = [i64; 3];

/// What is in a cell.
#[derive(Debug)]
struct Cell {
    name: Name,
    pieces: Range<usize>,
    /// The corners of the box of their places.
    low: Point3,
    high: Point3,
    /// That of all of them, by sides.
    clearness: [f64; 2],
}

impl Heard {
    pub(super) fn reaches(&self, place: &Point3) -> bool {
        self.reaches_by(&(place - self.place))
    }

    /// Whether something is within reach that is so far away along each axis, m.
    fn reaches_by(&self, way: &Vector3) -> bool {
        way.norm_squared() <= self.reach * self.reach
    }
}

impl Places {
    pub(super) fn new(heard: &[Heard]) -> Self {
        let size = (median_reach(heard) / CELLS_OF_REACH).max(f64::MIN_POSITIVE);
        let mut by_name: Vec<(Name, Heard)> =
            heard.iter().map(|one| (cell(&one.place, 0.0, size), *one)).collect();
        by_name.sort_unstable_by(|(p, one), (q, other)| {
            let along = |k: usize| one.place[k].total_cmp(&other.place[k]);
            p.cmp(q).then_with(|| along(0)).then_with(|| along(1)).then_with(|| along(2))
        });
        let of_each = by_name.chunk_by(|(p, _), (q, _)| p == q);
        let cells = of_each.scan(0, |begin, pieces| {
            let cell = Cell::new(pieces, *begin);
            *begin = cell.pieces.end;
            Some(cell)
        });
        let cells = cells.collect();
        Self { heard: by_name.into_iter().map(|(_, heard)| heard).collect(), cells, size }
    }

    /// Calls `visit` with each piece and the clearness by sides of all that are within its reach.
    pub(super) fn visit(&self, mut visit: impl FnMut(&Heard, [f64; 2])) {
        let mut near = Vec::new();
        for cell in &self.cells {
            let pieces = &self.heard[cell.pieces.clone()];
            near.clear();
            self.add_cells_about(pieces, &mut near);
            for one in pieces {
                visit(one, self.within_reach(one, &near));
            }
        }
    }

    /// Adds the cells that pieces of a cell may reach.
    fn add_cells_about<'c>(&'c self, pieces: &[Heard], near: &mut Vec<&'c Cell>) {
        let ends =
            |by: f64| pieces.iter().map(move |one| cell(&one.place, by * one.reach, self.size));
        let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
        for k in 0..3 {
            ends(-1.0).for_each(|end| low[k] = low[k].min(end[k]));
            ends(1.0).for_each(|end| high[k] = high[k].max(end[k]));
        }
        let is_between = |name: &Name| (1..3).all(|k| (low[k]..=high[k]).contains(&name[k]));
        let mut from = self.cells.partition_point(|cell| cell.name < low);
        while let Some(cell) = self.cells.get(from).filter(|cell| cell.name[0] <= high[0]) {
            // Cells of one x at a time.
            let x = cell.name[0];
            let begin = [x, low[1], low[2]];
            from += self.cells[from..].partition_point(|cell| cell.name < begin);
            let of_x = self.cells[from..].iter();
            let of_x = of_x.take_while(|cell| cell.name[0] == x && cell.name[1] <= high[1]);
            near.extend(of_x.filter(|cell| is_between(&cell.name)));
            from += self.cells[from..].partition_point(|cell| cell.name[0] <= x);
        }
    }

    /// Clearness by sides of all that are in these cells and within reach of a piece.
    fn within_reach(&self, one: &Heard, near: &[&Cell]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        let mut add = |of: &[f64; 2], counts: bool| {
            sums[0] += if counts { of[0] } else { 0.0 };
            sums[1] += if counts { of[1] } else { 0.0 };
        };
        for cell in near {
            if !one.reaches(&cell.nearest_to(&one.place)) {
                continue;
            }
            if one.reaches_by(&cell.farthest_from(&one.place)) {
                add(&cell.clearness, true);
                continue;
            }
            for other in &self.heard[cell.pieces.clone()] {
                add(&other.clearness, one.reaches(&other.place));
            }
        }
        sums
    }
}

impl Cell {
    /// Of pieces, the first of which has that number.
    fn new(pieces: &[(Name, Heard)], begin: usize) -> Self {
        let places = pieces.iter().map(|(_, one)| &one.place);
        let (low, high) = bounding_box(places).unwrap_or_default();
        let clearness = pieces
            .iter()
            .fold([0.0; 2], |sums, (_, one)| [0, 1].map(|side| sums[side] + one.clearness[side]));
        Self { name: pieces[0].0, pieces: begin..begin + pieces.len(), low, high, clearness }
    }

    /// The place in the box of its pieces that is nearest to another.
    fn nearest_to(&self, place: &Point3) -> Point3 {
        Point3::from(place.coords.sup(&self.low.coords).inf(&self.high.coords))
    }

    /// Along each axis, how far the farther side of the box of its pieces is from a place, m.
    fn farthest_from(&self, place: &Point3) -> Vector3 {
        (place - self.low).abs().sup(&(place - self.high).abs())
    }
}

/// Half of them reach no farther, m.
fn median_reach(heard: &[Heard]) -> f64 {
    let mut reaches: Vec<f64> = heard.iter().map(|one| one.reach).collect();
    let middle = reaches.len() / 2;
    if reaches.is_empty() {
        return 0.0;
    }
    *reaches.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Few and many, near and far, with reaches far from one another: what each reaches, asked one by one.
        #[test]
        fn each_is_told_what_all_within_its_reach_say(
            pieces in prop::collection::vec(
                (
                    prop::array::uniform3(-1.0..1.0_f64),
                    prop_oneof![4 => 0.2..0.4_f64, 1 => 0.0..3.0_f64],
                    prop::array::uniform2(0.0..6.0_f64),
                ),
                1..200,
            ),
            thickness in prop_oneof![Just(0.0), Just(1e-3), Just(1.0)],
            offset in prop_oneof![Just(0.0), Just(1e6)],
        ) {
            let heard = pieces.into_iter().map(|([x, y, z], reach, clearness)| Heard {
                place: Point3::new(x + offset, y, thickness * z),
                reach,
                clearness,
            });
            let heard: Vec<Heard> = heard.collect();
            let mut told = 0;
            let mut wrong = None;
            Places::new(&heard).visit(|one, sums| {
                let mut expected = [0.0; 2];
                for other in heard.iter().filter(|other| one.reaches(&other.place)) {
                    expected = [0, 1].map(|side| expected[side] + other.clearness[side]);
                }
                let is_same = (0..2).all(|k| (sums[k] - expected[k]).abs() <= 1e-12 * (1.0 + expected[k]));
                told += 1;
                if !is_same {
                    wrong = Some((*one, sums, expected));
                }
            });
            prop_assert!(wrong.is_none(), "{wrong:?}");
            prop_assert_eq!(told, heard.len());
        }
    }
}
