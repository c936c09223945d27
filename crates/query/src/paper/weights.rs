//! The weights of coverage (section 5): how much surface a point stands for.

use std::f64::consts::PI;

use cloudtouch_noise::Neighborhoods;

/// w(xᵢ): the area of the sphere that reaches to the `neighbors`-th nearest other position, as a
/// disc, m²; to the farthest where there are fewer, and 0 where there is none.
pub(super) fn sphere_area(cloud: &Neighborhoods, index: usize, neighbors: usize) -> f64 {
    cloud.nearest(index, neighbors).last().map_or(0.0, |farthest| PI * farthest.squared_distance)
}
