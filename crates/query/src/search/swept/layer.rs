//! Between which heights all of a leaf is: most of what another leaf has is beyond them.

use super::course::Course;
use super::pieces::turned_variance;
use super::track::{Direction, Track};
use crate::cloud::Surfel;
use crate::search::compare::meeting::LEAST_STD;

/// What heights are rounded by, relative.
const ROUNDING: f64 = 1e-9;

/// From the lowest to the highest of heights that change by so much; never too narrow by rounding.
pub(super) fn span(heights: impl Iterator<Item = (f64, f64)>) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (at, by) in heights {
        (low, high) = (low.min(at - by), high.max(at + by));
    }
    let room = ROUNDING * low.abs().max(high.abs());
    [low - room, high + room]
}

/// Between which heights the pieces of a leaf are along the direction it is thinnest, and how well they are
/// known along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layer {
    direction: Direction,
    low: f64,
    high: f64,
    /// The largest variance along it, m².
    variance: f64,
}

impl Layer {
    pub(super) fn around(surfels: &[Surfel], direction: Direction) -> Self {
        let mut layer =
            Self { direction, low: f64::INFINITY, high: f64::NEG_INFINITY, variance: 0.0 };
        for Surfel { point, .. } in surfels {
            let height = direction.n.dot(&point.mean.coords);
            let variance = point.covariance.variance_along(&direction.n);
            layer.low = layer.low.min(height);
            layer.high = layer.high.max(height);
            layer.variance = layer.variance.max(variance);
        }
        layer
    }

    /// No piece of the leaf has fewer deviations along its direction to a piece of the other body, which has
    /// so large a variance at any turn.
    pub(super) fn deviations(&self, track: &Track, variance: impl Fn(&Direction) -> f64) -> f64 {
        let height = self.direction.n.dot(&track.place.coords);
        let gap = (height - self.high).max(self.low - height) - track.along(&self.direction);
        if gap <= 0.0 { 0.0 } else { gap / (self.variance + variance(&self.direction)).sqrt() }
    }
}

/// Between which heights the facets of a leaf are along the normal of one of them: most leaves are flat.
#[derive(Debug, Clone, Copy)]
pub(super) struct ExactLayer {
    direction: Direction,
    still: [f64; 2],
    on_the_way: [f64; 2],
}

impl ExactLayer {
    /// Around the corners of facets.
    pub(super) fn around(corners: &[[Track; 3]], direction: Direction) -> Self {
        let height = |corner: &Track| direction.n.dot(&corner.place.coords);
        let corners = || corners.iter().flatten();
        let still = span(corners().map(|corner| (height(corner), 0.0)));
        let on_the_way = span(corners().map(|corner| (height(corner), corner.along(&direction))));
        Self { direction, still, on_the_way }
    }

    /// No facet has fewer deviations along the direction to a piece of a cloud. `is_still`: whether the piece
    /// drifts so, and not the facets.
    pub(super) fn deviations(
        &self,
        (surfel, track): (&Surfel, &Track),
        is_still: bool,
        drift: &Course,
    ) -> f64 {
        let direction = &self.direction;
        let height = direction.n.dot(&track.place.coords);
        let ([low, high], by, variance) = match is_still {
            true => (self.still, track.along(direction), turned_variance(surfel, direction, drift)),
            false => (self.on_the_way, 0.0, surfel.point.covariance.variance_along(&direction.n)),
        };
        let gap = (height - high).max(low - height) - by;
        if gap <= 0.0 { 0.0 } else { gap / variance.max(LEAST_STD.powi(2)).sqrt() }
    }
}
