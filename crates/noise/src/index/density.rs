//! How dense the samples of a cloud are about each of them.

use std::cmp::Ordering;

use cloudtouch_geom::Point3;
use rayon::prelude::*;

use crate::index::block::Block;
use crate::index::held::{Held, NEAREST};
use crate::index::neighbor::Neighbor;
use crate::index::octree::{Cell, Octree};
use crate::index::positions::Positions;
use crate::index::spacing::{SPACING_NEIGHBORS, spacing_of_rank};

/// How dense the samples are about a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Density {
    /// The distance between them, m; infinite for one alone.
    pub(crate) spacing: f64,
    /// The sum of the squared distances of the nearest, m². Two points that are each other's sixth
    /// neighbour have the same spacing, but not the same sum: which comes first must not hang on
    /// rounding.
    pub(crate) squares: f64,
}

/// Points of a cell are served together; more than so many are told apart by smaller cells.
const SERVED: usize = 16;
/// Cells are widened so often, ...
const WIDENED: usize = 2;
/// ... and until so many positions are about them, before the points left are looked at one by one.
const MOST_HELD: usize = 1000;
/// Cells that a thread takes at a time.
const CHUNK: usize = 64;

impl Density {
    const NOWHERE: Self = Self { spacing: f64::INFINITY, squares: 0.0 };

    /// About one point.
    pub(crate) fn around(cloud: &Positions, index: usize, buffers: &mut Buffers) -> Self {
        let (block, found) = buffers;
        block.nearest_into(cloud, &cloud.points()[index], SPACING_NEIGHBORS, true, found);
        Self::of(found.iter().map(|near| near.squared_distance))
    }

    /// Of the squared distances of the nearest, m², in order.
    fn of(squares: impl ExactSizeIterator<Item = f64> + Clone) -> Self {
        let rank = squares.len();
        squares.clone().last().map_or(Self::NOWHERE, |last| Self {
            spacing: spacing_of_rank(last.sqrt(), rank),
            squares: squares.sum(),
        })
    }

    /// About every point, on all threads of the pool.
    pub(crate) fn everywhere(cloud: &Positions) -> Vec<Self> {
        let cells = Cells::of(cloud);
        let chunks = cells.leaves.par_chunks(CHUNK);
        let of_chunks: Vec<Vec<Self>> = chunks.map(|chunk| cells.densities(chunk)).collect();
        cells.in_place(of_chunks.into_iter().flatten())
    }

    /// The same on this thread.
    pub(crate) fn everywhere_on_this_thread(cloud: &Positions) -> Vec<Self> {
        let cells = Cells::of(cloud);
        let densities = cells.densities(&cells.leaves);
        cells.in_place(densities.into_iter())
    }
}

/// What the neighbours of a point are found with.
type Buffers = (Block, Vec<Neighbor>);

/// The cells that a cloud is served by.
struct Cells<'a> {
    cloud: &'a Positions,
    tree: Octree,
    leaves: Vec<Cell>,
}

impl<'a> Cells<'a> {
    fn of(cloud: &'a Positions) -> Self {
        let tree = Octree::of(cloud.points(), &cloud.distinct_indices());
        let leaves = tree.leaves(SERVED);
        Self { cloud, tree, leaves }
    }

    /// About the points of some cells, in the order of the tree.
    fn densities(&self, cells: &[Cell]) -> Vec<Density> {
        let (Some(first), Some(last)) = (cells.first(), cells.last()) else { return Vec::new() };
        let start = first.range.start;
        let mut densities = vec![Density::NOWHERE; last.range.end - start];
        let (mut held, mut left) = (Held::default(), Vec::new());
        let mut buffers = Buffers::default();
        for cell in cells {
            left.clear();
            left.extend(cell.range.clone());
            let mut cell = cell.clone();
            for _ in 0..WIDENED {
                if !held.hold(&self.tree, &cell, MOST_HELD) {
                    break;
                }
                left.retain(|&place| {
                    let nearest = held.nearest(&self.tree.points()[place]);
                    // The nearest of all is the point itself.
                    let others = |nearest: [f64; NEAREST]| nearest.into_iter().skip(1);
                    let density = nearest.map(|nearest| Density::of(others(nearest)));
                    densities[place - start] = density.unwrap_or(Density::NOWHERE);
                    density.is_none()
                });
                if left.is_empty() {
                    break;
                }
                cell = self.tree.parent(&cell);
            }
            for &place in &left {
                let index = self.tree.indices()[place] as usize;
                densities[place - start] = Density::around(self.cloud, index, &mut buffers);
            }
        }
        densities
    }

    /// What comes in the order of the tree, by index; points that are not in it are looked at now.
    fn in_place(&self, ordered: impl Iterator<Item = Density>) -> Vec<Density> {
        let mut densities = vec![None; self.cloud.points().len()];
        for (&index, density) in self.tree.indices().iter().zip(ordered) {
            densities[index as usize] = Some(density);
        }
        let mut buffers = Buffers::default();
        let mut around = |index| Density::around(self.cloud, index, &mut buffers);
        let known = densities.into_iter().enumerate();
        known.map(|(index, density)| density.unwrap_or_else(|| around(index))).collect()
    }
}

/// The indices of points of these densities, the densest first, each position once; of what is as dense, as nearly all
/// of a grid is, in order of x, y and z, so that the order does not hang on how the points are numbered.
pub(crate) fn densest_first(points: &[Point3], densities: &[Density]) -> Vec<u32> {
    let mut order: Vec<(u64, u32)> =
        densities.iter().zip(0..).map(|(density, i)| (rounded(density.squares), i)).collect();
    let place = |(_, index): &(u64, u32)| points[*index as usize];
    order.sort_unstable_by(|one, other| {
        let by_place = || in_order_of_place(&place(one), &place(other)).then(one.1.cmp(&other.1));
        one.0.cmp(&other.0).then_with(by_place)
    });
    // Copies of a position have the same neighbours, and so stand together.
    order.dedup_by(|later, first| place(later) == place(first));
    order.into_iter().map(|(_, index)| index).collect()
}

/// A number that is not negative to 2⁻³² of itself, in the order of such numbers.
fn rounded(value: f64) -> u64 {
    const DROPPED: u32 = f64::MANTISSA_DIGITS - 1 - 32;
    // The bits of numbers that are not negative are in their order.
    (value.to_bits() + (1 << (DROPPED - 1))) >> DROPPED
}

/// By x, y and z, −0 and 0 being the same.
fn in_order_of_place(one: &Point3, other: &Point3) -> Ordering {
    let by_axis = |axis: usize| (one[axis] + 0.0).total_cmp(&(other[axis] + 0.0));
    by_axis(0).then_with(|| by_axis(1)).then_with(|| by_axis(2))
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;
    use crate::index::spacing::spacing_around;

    fn unit(i: u64, k: u64) -> f64 {
        seed::unit(seed::derive(8, i, k))
    }

    /// A noisy sheet, some of it stored twice, and a return that is missing.
    fn sheet() -> Vec<Point3> {
        let mut points: Vec<Point3> =
            (0..900).map(|i| Point3::new(unit(i, 0), unit(i, 1), 0.05 * unit(i, 2))).collect();
        points.extend_from_within(100..150);
        points[17].x = f64::NAN;
        points
    }

    /// Thousands in a speck, and some far away.
    fn speck() -> Vec<Point3> {
        let size = |i: u64| if i.is_multiple_of(40) { 5.0 } else { 1e-7 };
        (0..2400).map(|i| Point3::from([0, 1, 2].map(|k| size(i) * unit(i, k)))).collect()
    }

    #[test]
    fn densities_are_those_of_neighbours_found_one_by_one() {
        let few = speck().split_off(2395);
        for points in [sheet(), speck(), few, Vec::new()] {
            let cloud = Positions::new(points).unwrap();
            let mut found = Vec::new();
            let mut one_by_one = |place: &Point3| {
                cloud.search(place, SPACING_NEIGHBORS, true, &mut found);
                Density {
                    spacing: spacing_around(&found).unwrap_or(f64::INFINITY),
                    squares: found.iter().map(|near| near.squared_distance).sum(),
                }
            };
            let expected: Vec<Density> = cloud.points().iter().map(&mut one_by_one).collect();
            assert_eq!(Density::everywhere(&cloud), expected);
            assert_eq!(Density::everywhere_on_this_thread(&cloud), expected);
        }
    }
}
