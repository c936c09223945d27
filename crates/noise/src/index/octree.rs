//! Points along a curve of Morton, on which every cell of an octree holds a range of them.

use std::ops::Range;

use cloudtouch_geom::{Point3, Vector3, bounding_box};

use crate::index::morton::{coordinates, interleaved};

/// Halvings of the box around all points, along each axis.
const LEVELS: u32 = 20;
/// Points that the box about most of them is told from, at most.
const SAMPLE: usize = 1024;
/// Rounding of coordinates in the cells, and of distances, in parts of a width, generously.
const ROUNDING: f64 = 1e-8;

/// Points in the order of their cells.
#[derive(Debug)]
pub(crate) struct Octree {
    /// Their places on the curve, three bits for each level.
    keys: Vec<u64>,
    /// Their indices, in the same order.
    indices: Vec<u32>,
    /// Their positions, in the same order.
    points: Vec<Point3>,
    /// Side of a cell that is not halved any more, m.
    finest: f64,
}

/// A cell with points in it.
#[derive(Debug, Clone)]
pub(crate) struct Cell {
    /// So many times as wide as the finest, as a power of two.
    level: u32,
    /// Which places on the curve it holds.
    pub(crate) range: Range<usize>,
}

impl Octree {
    /// Of points named by their indices, all of them finite.
    pub(crate) fn of(points: &[Point3], indices: &[u32]) -> Self {
        let (low, high) = box_about_most(points, indices);
        let longest = (high - low).max();
        let last = f64::from((1_u32 << LEVELS) - 1);
        let scale = last / longest;
        // Points that are all but at one place are not told apart by cells.
        let scale = if scale.is_finite() { scale } else { 0.0 };
        // Who is beyond the box is in the cells at its border: nearer to those inside than it is, so that it is among
        // what is around them wherever it is so near.
        let key = |point: &Point3| {
            interleaved([0, 1, 2].map(|axis| ((point[axis] - low[axis]) * scale).min(last) as u64))
        };
        let keyed =
            |&index: &u32| u128::from(key(&points[index as usize])) << 32 | u128::from(index);
        let mut order: Vec<u128> = indices.iter().map(keyed).collect();
        order.sort_unstable();
        let indices: Vec<u32> = order.iter().map(|&keyed| keyed as u32).collect();
        Self {
            keys: order.iter().map(|keyed| (keyed >> 32) as u64).collect(),
            points: indices.iter().map(|&index| points[index as usize]).collect(),
            indices,
            finest: if scale > 0.0 { 1.0 / scale } else { f64::INFINITY },
        }
    }

    /// The indices, in the order of the cells.
    pub(crate) fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// The positions, in the order of the cells.
    pub(crate) fn points(&self) -> &[Point3] {
        &self.points
    }

    /// The largest cells that hold no more than so many points, and the finest where these hold more,
    /// in order.
    pub(crate) fn leaves(&self, most: usize) -> Vec<Cell> {
        let mut leaves = Vec::new();
        let mut stack = vec![Cell { level: LEVELS, range: 0..self.keys.len() }];
        while let Some(cell) = stack.pop() {
            if cell.range.len() <= most || cell.level == 0 {
                leaves.push(cell);
                continue;
            }
            let level = cell.level - 1;
            // The last comes first off the stack.
            let mut end = cell.range.end;
            while end > cell.range.start {
                let first = self.keys[end - 1] >> (3 * level) << (3 * level);
                let start = cell.range.start
                    + self.keys[cell.range.start..end].partition_point(|&key| key < first);
                stack.push(Cell { level, range: start..end });
                end = start;
            }
        }
        leaves
    }

    /// The cell twice as wide that a cell is part of.
    pub(crate) fn parent(&self, cell: &Cell) -> Cell {
        let level = (cell.level + 1).min(LEVELS);
        Cell { level, range: self.range(self.keys[cell.range.start] >> (3 * level), level) }
    }

    /// Calls `visit` with the points of a cell and then of those beside it, of its width, and says how far
    /// about each point of the cell they leave none out, m; `None` where the cells twice as wide about it
    /// hold more than so many, which are not visited then.
    pub(crate) fn visit_around(
        &self,
        cell: &Cell,
        most: usize,
        mut visit: impl FnMut(&Point3),
    ) -> Option<f64> {
        if cell.level >= LEVELS - 1 {
            if self.points.len() > most {
                return None;
            }
            self.points.iter().for_each(visit);
            return Some(f64::INFINITY);
        }
        let own = self.keys[cell.range.start] >> (3 * cell.level);
        let about = self.about(own, cell.level);
        if about.iter().map(Range::len).sum::<usize>() > most {
            return None;
        }
        // PERF: those of the cell first, which are nearest, so that few of the others seem to be near.
        let [parent, about @ ..] = about;
        for range in
            [cell.range.clone(), parent.start..cell.range.start, cell.range.end..parent.end]
        {
            self.points[range].iter().for_each(&mut visit);
        }
        for (beside, range) in (1..).zip(about) {
            // Of one that is beside on an axis the half that is nearer: where the cell is in the other.
            for (&key, point) in self.keys[range.clone()].iter().zip(&self.points[range]) {
                if (key >> (3 * cell.level) ^ own) & beside == beside {
                    visit(point);
                }
            }
        }
        Some(self.finest * f64::from(1_u32 << cell.level) * (1.0 - ROUNDING))
    }

    /// What the cells twice as wide hold that all beside a cell is in: the one that it is part of, and on
    /// each axis the one beside that which is nearer to the cell, by three bits that say beside on which.
    fn about(&self, own: u64, level: u32) -> [Range<usize>; 8] {
        let at = coordinates(own >> 3);
        let cells = 1 << (LEVELS - level - 1);
        std::array::from_fn(|beside| {
            let at = [0, 1, 2].map(|axis| {
                let bit = 2 - axis;
                match (beside >> bit & 1, own >> bit & 1) {
                    (0, _) => at[axis],
                    (_, 0) => at[axis].wrapping_sub(1),
                    _ => at[axis] + 1,
                }
            });
            let is_inside = at.iter().all(|&at| at < cells);
            if is_inside { self.range(interleaved(at), level + 1) } else { 0..0 }
        })
    }

    /// What a cell of a level holds, by its place among those of its level.
    fn range(&self, cell: u64, level: u32) -> Range<usize> {
        let (first, next) = (cell << (3 * level), (cell + 1) << (3 * level));
        let start = self.keys.partition_point(|&key| key < first);
        start..start + self.keys[start..].partition_point(|&key| key < next)
    }
}

/// Corners of a box about all points but those that are far beyond nearly all others: with these in it cells would be too
/// wide to tell the rest apart.
fn box_about_most(points: &[Point3], indices: &[u32]) -> (Point3, Point3) {
    let of_all = indices.iter().map(|&index| &points[index as usize]);
    let (low, high) = bounding_box(of_all).unwrap_or_default();
    let some = indices.iter().step_by(indices.len().div_ceil(SAMPLE).max(1));
    let some: Vec<&Point3> = some.map(|&index| &points[index as usize]).collect();
    let rank = some.len() / 100;
    if rank == 0 {
        return (low, high);
    }
    let mut most = [low, high];
    for axis in 0..3 {
        let mut along: Vec<f64> = some.iter().map(|point| point[axis]).collect();
        along.sort_unstable_by(f64::total_cmp);
        (most[0][axis], most[1][axis]) = (along[rank], along[along.len() - 1 - rank]);
    }
    let width = (most[1] - most[0]).max();
    if width <= 0.0 {
        return (low, high);
    }
    let room = Vector3::repeat(width);
    (low.sup(&(most[0] - room)), high.inf(&(most[1] + room)))
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    /// Some dense and some far, and a place where many are.
    fn points() -> Vec<Point3> {
        let unit = |i: u64, k| seed::unit(seed::derive(5, i, k));
        let place = |i: u64| Point3::from([0, 1, 2].map(|k| 0.3 + unit(i, k) * unit(i, 3).powi(6)));
        (0..3000).map(|i| if i % 30 == 0 { place(0) } else { place(i) }).collect()
    }

    #[test]
    fn leaves_hold_every_point_once_and_no_more_than_asked_for_where_cells_can_be_halved() {
        let points = points();
        let tree = Octree::of(&points, &(0..3000).collect::<Vec<_>>());
        let leaves = tree.leaves(20);
        let ends = leaves.iter().map(|leaf| leaf.range.end);
        let starts = leaves.iter().map(|leaf| leaf.range.start);
        assert!(starts.chain([3000]).eq([0].into_iter().chain(ends)));
        for leaf in &leaves {
            assert!(leaf.range.len() <= 20 || leaf.level == 0, "{leaf:?}");
            let parent = tree.parent(leaf);
            assert!(parent.range.len() > 20 && parent.range.start <= leaf.range.start);
            assert!(parent.range.end >= leaf.range.end);
        }
        assert!(tree.points().iter().zip(tree.indices()).all(|(p, &i)| *p == points[i as usize]));
    }

    #[test]
    fn what_is_around_a_cell_leaves_none_out_that_is_so_near() {
        let with_strays = |strays: &[f64]| {
            let mut points = points();
            points.extend(strays.iter().map(|&far| Point3::new(0.4, far, -far)));
            points
        };
        let tree_of =
            |points: &[Point3]| Octree::of(points, &(0..points.len() as u32).collect::<Vec<_>>());
        let alone = tree_of(&points());
        // Some beyond the box are as near to those inside as these to one another.
        for strays in [&[][..], &[1e6], &[-1e6, 3.0, 3.001, 8.0, 8.0, 8.002]] {
            let tree = tree_of(&with_strays(strays));
            assert!(tree.finest < 4.0 * alone.finest);
            what_is_around_leaves_none_out(&tree);
        }
    }

    fn what_is_around_leaves_none_out(tree: &Octree) {
        for cell in tree.leaves(20).iter().flat_map(|leaf| [leaf.clone(), tree.parent(leaf)]) {
            let mut around = Vec::new();
            let radius = tree.visit_around(&cell, 4000, |point| around.push(*point)).unwrap();
            for own in &tree.points()[cell.range] {
                let is_near = |other: &&Point3| (*other - own).norm() <= radius;
                let near = |all: &[Point3]| all.iter().filter(is_near).count();
                assert_eq!(near(&around), near(tree.points()));
            }
        }
    }
}
