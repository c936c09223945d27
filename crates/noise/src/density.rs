//! How dense the samples of a cloud are about each of them.

use crate::block::Block;
use crate::positions::{Neighbor, Positions};
use crate::spacing::{SPACING_NEIGHBORS, spacing_around};
use crate::spatial_order::{in_spatial_order, spatial_order};

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
        in_spatial_order(cloud.points(), |index, buffers| Self::around(cloud, index, buffers))
    }

    /// The same on this thread.
    pub(crate) fn everywhere_on_this_thread(cloud: &Positions) -> Vec<Self> {
        let mut buffers = Buffers::default();
        let nowhere = Self { spacing: f64::INFINITY, squares: 0.0 };
        let mut densities = vec![nowhere; cloud.points().len()];
        for index in spatial_order(cloud.points()) {
            densities[index as usize] = Self::around(cloud, index as usize, &mut buffers);
        }
        densities
    }
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
    use cloudtouch_geom::{Point3, seed};

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
