//! A ball around pieces of surface.

use cloudtouch_geom::{Motion, Point3, Vector3};

use super::surfel::Surfel;

/// What all pieces of a leaf are in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ball {
    pub middle: Point3,
    /// How far the mean of a piece is from there at most, m.
    pub radius: f64,
    /// The largest variance of a piece in any direction, m².
    pub variance: f64,
    /// The largest spacing, m.
    pub spacing: f64,
}

impl Ball {
    /// Around exact places, which have no spacing.
    pub(crate) fn around_points<'p>(points: impl Iterator<Item = &'p Point3> + Clone) -> Self {
        let count = points.clone().count().max(1);
        let sum: Vector3 = points.clone().map(|p| p.coords).sum();
        let middle = Point3::from(sum / count as f64);
        let radius = points.map(|p| (p - middle).norm()).fold(0.0, f64::max);
        Self { middle, radius, variance: 0.0, spacing: 0.0 }
    }

    pub(super) fn around(surfels: &[Surfel]) -> Self {
        let places = surfels.iter().map(|surfel| &surfel.point.mean);
        let most = |of: fn(&Surfel) -> f64| surfels.iter().map(of).fold(0.0, f64::max);
        let (variance, spacing) = (most(|s| s.most_variance), most(|s| s.spacing));
        Self { variance, spacing, ..Self::around_points(places) }
    }

    /// The same ball in another frame.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        Self { middle: motion.point(&self.middle), ..*self }
    }

    /// The same ball in the frame that was moved.
    pub(crate) fn moved_back(&self, motion: &Motion) -> Self {
        Self { middle: motion.point_back(&self.middle), ..*self }
    }

    /// Whether a place is at most so far from some place in the ball; never no by rounding.
    pub(crate) fn is_within(&self, place: &Point3, distance: f64) -> bool {
        const ROUNDING: f64 = 1e-9;
        let reach = (self.radius + distance) * (1.0 + ROUNDING);
        (place - self.middle).norm_squared() <= reach * reach
    }
}
