//! Whether a point is far off its surface by chance.

use crate::surface::Surface;
use crate::surface::patch::Patch;

/// A point up to so many standard deviations off may be there by chance, ...
const CHANCE_OFFSET: f64 = 4.0;
/// ... if no neighbour is so many off on the same side.
const BESIDE_OFFSET: f64 = 3.0;

/// Whether a point may well be so far off its surface by chance: there is no other as far on that side, of which a
/// thing there would have more than one. `variance` is that of the heights of points above the surface, m².
pub(super) fn is_chance(surface: &Surface, patch: &Patch, variance: f64) -> bool {
    let within = |height: f64, stds: f64| height * height <= stds * stds * variance;
    let height = |rank: usize| surface.height - surface.normal.dot(&patch.offset(rank));
    let is_beside = |height: f64| height * surface.height > 0.0 && !within(height, BESIDE_OFFSET);
    within(surface.height, CHANCE_OFFSET) && !(0..patch.len()).map(height).any(is_beside)
}
