//! Measures of answers against the truth, each once, with intervals and paired differences.

mod bootstrap;
mod calibration;
mod rank;
mod sample;
mod surface;

pub use bootstrap::{Clusters, Estimate};
pub use calibration::{Bin, brier, calibration_error, chance_error, observed_within, reliability};
pub use rank::{auc, false_stops, wrong_from};
pub use sample::Sample;
pub use surface::{Axis, Sample as SurfaceSample, border, fit_surface};

/// What a method can be judged by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// Area under the ROC curve: how well it ranks.
    Auc,
    /// Mean squared error of its probability.
    Brier,
    /// Expected calibration error.
    CalibrationError,
    /// Free poses stopped while at most this share of the collisions is missed.
    FalseStops(f64),
    /// Free poses stopped from such a score on.
    Stops(f64),
    /// Collisions below such a score.
    Misses(f64),
}

impl Measure {
    /// Its value; `weights` say how often each answer counts.
    pub fn of(self, sample: &Sample, weights: &[f64]) -> f64 {
        let share = |[some, all]: [f64; 2]| some / all;
        match self {
            Self::Auc => auc(sample, weights),
            Self::Brier => brier(sample, weights),
            Self::CalibrationError => calibration_error(sample, weights),
            Self::FalseStops(rate) => false_stops(sample, weights, rate),
            Self::Stops(from) => share(wrong_from(sample, weights, from)[0]),
            Self::Misses(from) => share(wrong_from(sample, weights, from)[1]),
        }
    }
}
