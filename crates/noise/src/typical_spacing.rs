//! How far apart the samples of a cloud are.

use crate::index::spacing::{SPACING_NEIGHBORS, spacing_around};
use crate::neighborhoods::Neighborhoods;

/// The typical spacing of a cloud, m: the median over `sample` points, evenly spread over the
/// indices, of dₖ √(π/k) with dₖ the distance to the sixth neighbour.
///
/// On a surface with one sample in every square of side h it is about h. Noise larger than the
/// spacing thickens the surface and makes it too large. Zero when no sampled point has a
/// neighbour; all points are sampled when there are fewer than `sample`.
pub fn typical_spacing(neighborhoods: &Neighborhoods, sample: usize) -> f64 {
    let count = neighborhoods.points().len();
    let sample = sample.min(count);
    // The product fits: an index holds at most 2³² points.
    let index = |s: usize| (s as u64 * count as u64 / sample as u64) as usize;
    typical_of_spacings(&spacings_at(neighborhoods, (0..sample).map(index)))
}

/// The spacing about each of these points, m; infinite without a neighbour.
pub fn spacings_at(
    neighborhoods: &Neighborhoods,
    indices: impl Iterator<Item = usize>,
) -> Vec<f64> {
    let mut found = Vec::new();
    let spacing = |index| {
        neighborhoods.nearest_into(index, SPACING_NEIGHBORS, &mut found);
        spacing_around(&found).unwrap_or(f64::INFINITY)
    };
    indices.map(spacing).collect()
}

/// The [typical spacing](typical_spacing) by those about some points.
pub fn typical_of_spacings(spacings: &[f64]) -> f64 {
    let mut spacings: Vec<f64> =
        spacings.iter().copied().filter(|spacing| spacing.is_finite()).collect();
    if spacings.is_empty() {
        return 0.0;
    }
    let middle = spacings.len() / 2;
    *spacings.select_nth_unstable_by(middle, f64::total_cmp).1
}
