//! A piece of surface about a sample.

use cloudtouch_geom::{Motion, UncertainPoint, UnitVector3, Vector3};
use cloudtouch_noise::Refined;

use super::edge::{DISC_SPACINGS, MOST_SINE, sine};

/// The piece of surface about a sample, in the cloud's local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surfel {
    /// Index among the points the filter kept.
    pub index: u32,
    /// Where the surface is expected, and how well that is known: less where it ends at another face.
    pub point: UncertainPoint,
    /// Where it ends, as far as that was looked for.
    pub end: End,
    /// Distance between samples there, m.
    pub spacing: f64,
    /// What no variance of `point` in any direction is above, m²; never too small by rounding.
    pub most_variance: f64,
    /// Variance across the surface as it was fitted, m²; zero where no normal was.
    pub across: f64,
    /// Unit normal of the surface there, of either sign, where one was fitted.
    pub normal: Option<Vector3>,
    /// How much of that variance the pieces beside it are off by too, from 0 to 1.
    pub shared: f64,
}

/// Whether a piece of surface ends at another face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum End {
    /// Nowhere: all of what was fitted is left.
    Nowhere,
    /// It may, which takes the fits beside it to tell: what is left is as fitted or less.
    Open,
    /// It does, and what was fitted is cut off there.
    CutOff,
}

/// Relative rounding of an eigenvalue, generously.
const ROUNDING: f64 = 1e-9;

impl Surfel {
    /// As it was fitted.
    pub(crate) fn new(index: u32, fit: &Refined) -> Self {
        let Refined { point, spacing, normal, shared } = *fit;
        let variance = |normal: UnitVector3| point.covariance.variance_along(&normal);
        Self {
            index,
            point,
            end: End::Nowhere,
            spacing,
            most_variance: point.covariance.max_std().powi(2) * (1.0 + ROUNDING),
            across: normal.map_or(0.0, variance),
            normal: normal.map(UnitVector3::into_inner),
            shared,
        }
    }

    /// Whether it is open where it ends.
    pub(crate) fn may_end(&self) -> bool {
        self.end == End::Open
    }

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
}
