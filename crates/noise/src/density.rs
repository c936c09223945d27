//! How dense the samples of a cloud are about each of them.

use cloudtouch_geom::Point3;
use rayon::prelude::*;

use crate::block::Block;
use crate::positions::{Neighbor, Positions};
use crate::spacing::{SPACING_NEIGHBORS, spacing_around};
use crate::spatial_order::spatial_order;

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

impl Density {
    /// About one point.
    pub(crate) fn around(cloud: &Positions, index: usize, buffers: &mut Buffers) -> Self {
        let (block, found) = buffers;
        block.nearest_into(cloud, &cloud.points()[index], SPACING_NEIGHBORS, true, found);
        Self {
            spacing: spacing_around(found).unwrap_or(f64::INFINITY),
            squares: found.iter().map(|near| near.squared_distance).sum(),
        }
    }

    /// About every point, on all threads of the pool.
    pub(crate) fn everywhere(cloud: &Positions) -> Vec<Self> {
        let order = spatial_order(cloud.points());
        let groups = order.par_chunks(GROUP);
        let of_groups: Vec<Vec<Self>> =
            groups.map_init(Buffers::default, |b, group| Self::of_group(cloud, group, b)).collect();
        in_place(&order, of_groups.into_iter().flatten())
    }

    /// The same on this thread.
    pub(crate) fn everywhere_on_this_thread(cloud: &Positions) -> Vec<Self> {
        let (order, mut buffers) = (spatial_order(cloud.points()), Buffers::default());
        let groups = order.chunks(GROUP);
        in_place(&order, groups.flat_map(|group| Self::of_group(cloud, group, &mut buffers)))
    }

    /// About points near one another.
    fn of_group(cloud: &Positions, group: &[u32], buffers: &mut Buffers) -> Vec<Self> {
        let places: Vec<Point3> = group.iter().map(|&i| cloud.points()[i as usize]).collect();
        buffers.0.gather(cloud, &places, SPACING_NEIGHBORS, None);
        group.iter().map(|&index| Self::around(cloud, index as usize, buffers)).collect()
    }
}

/// How many points are served together.
const GROUP: usize = 8;

/// What comes in an order of indices, by index.
fn in_place(order: &[u32], ordered: impl Iterator<Item = Density>) -> Vec<Density> {
    let nowhere = Density { spacing: f64::INFINITY, squares: 0.0 };
    let mut densities = vec![nowhere; order.len()];
    for (&index, density) in order.iter().zip(ordered) {
        densities[index as usize] = density;
    }
    densities
}

/// What the neighbours of points near one another are found with.
type Buffers = (Block, Vec<Neighbor>);

/// The indices of points of these densities, the densest first.
pub(crate) fn densest_first(densities: &[Density]) -> Vec<u32> {
    let mut order: Vec<(u64, u32)> =
        densities.iter().zip(0..).map(|(density, i)| (density.squares.to_bits(), i)).collect();
    // The bits of numbers that are not negative are in their order.
    order.sort_unstable();
    order.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    /// A noisy sheet, some of it stored twice, and a return that is missing.
    #[test]
    fn densities_are_those_of_neighbours_found_one_by_one() {
        let unit = |i: u64, k| seed::unit(seed::derive(8, i, k));
        let mut points: Vec<Point3> =
            (0..900).map(|i| Point3::new(unit(i, 0), unit(i, 1), 0.05 * unit(i, 2))).collect();
        points.extend_from_within(100..150);
        points[17].x = f64::NAN;
        let cloud = Positions::try_new(points).unwrap();
        let mut found = Vec::new();
        let mut one_by_one = |index: usize| {
            cloud.search(&cloud.points()[index], SPACING_NEIGHBORS, true, &mut found);
            Density {
                spacing: spacing_around(&found).unwrap_or(f64::INFINITY),
                squares: found.iter().map(|near| near.squared_distance).sum(),
            }
        };
        let expected: Vec<Density> = (0..950).map(&mut one_by_one).collect();
        assert_eq!(Density::everywhere(&cloud), expected);
        assert_eq!(Density::everywhere_on_this_thread(&cloud), expected);
    }
}
