//! A piece of surface about a sample.

use cloudtouch_geom::{Motion, UncertainPoint, Vector3};

use super::edge::{DISC_SPACINGS, MOST_SINE, sine};

/// The piece of surface about a sample, in the cloud's local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surfel {
    /// Index among the points the filter kept.
    pub index: u32,
    /// Where the surface is expected, and how well that is known.
    pub point: UncertainPoint,
    /// Distance between samples there, m.
    pub spacing: f64,
    /// The largest variance of `point` in any direction, m²; never too small by rounding.
    pub most_variance: f64,
    /// Unit normal of the surface there, of either sign, where one was fitted.
    pub normal: Option<Vector3>,
}

impl Surfel {
    /// The same piece in another frame.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        Self {
            point: motion.uncertain_point(&self.point),
            normal: self.normal.map(|normal| motion.vector(&normal)),
            ..*self
        }
    }

    /// How far its disc reaches along any unit vector at most, m.
    pub(crate) fn most_disc_reach(&self) -> f64 {
        DISC_SPACINGS * self.spacing * MOST_SINE
    }

    /// How far its disc reaches along a unit vector, m; never too little by rounding. `None` where no normal
    /// was fitted.
    pub(crate) fn disc_reach(&self, along: &Vector3) -> Option<f64> {
        let radius = DISC_SPACINGS * self.spacing;
        self.normal.map(|normal| radius * sine(&normal, along))
    }

    /// Variance of the position across the surface, m²; zero where no normal was fitted.
    pub(crate) fn variance_across(&self) -> f64 {
        self.normal.map_or(0.0, |normal| self.point.covariance.variance_along(&normal))
    }
}
