//! How dense the samples of a cloud are about each of them.

use crate::positions::{Neighbor, Positions};
use crate::spacing::{SPACING_NEIGHBORS, spacing_around};
use crate::spatial_order::in_spatial_order;

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
    pub(crate) fn around(cloud: &Positions, index: usize, found: &mut Vec<Neighbor>) -> Self {
        // So few are found faster one by one than in blocks.
        cloud.search(&cloud.points()[index], SPACING_NEIGHBORS, true, found);
        Self {
            spacing: spacing_around(found).unwrap_or(f64::INFINITY),
            squares: found.iter().map(|near| near.squared_distance).sum(),
        }
    }

    /// About every point.
    pub(crate) fn everywhere(cloud: &Positions) -> Vec<Self> {
        in_spatial_order(cloud.points(), |index, found| Self::around(cloud, index, found))
    }
}

/// The indices of points of these densities, the densest first.
pub(crate) fn densest_first(densities: &[Density]) -> Vec<u32> {
    let mut order: Vec<(u64, u32)> =
        densities.iter().zip(0..).map(|(density, i)| (density.squares.to_bits(), i)).collect();
    // The bits of numbers that are not negative are in their order.
    order.sort_unstable();
    order.into_iter().map(|(_, index)| index).collect()
}
