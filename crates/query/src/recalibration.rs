//! From evidence to a probability: logistic regressions fitted on scenes whose truth is known.

use serde::Serialize;

use crate::error::SettingsError;

/// Deviations beyond this say no more than these.
pub(crate) const MOST_DEVIATIONS: f64 = 6.0;
/// Geometry alone is not believed beyond this, so that a search may end there and miss nothing: by
/// the fits hardly more than one in a hundred such poses is free.
pub(crate) const MOST_CERTAIN: f64 = 0.95;
/// Keeps the logarithm of no misclassified point finite.
const MISCLASSIFIED_FLOOR: f64 = 0.02;

/// What the probability of two clouds rests on in the calibrated mode.
///
/// Each number is comparable between scenes: none has a unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactEvidence {
    /// z: the least Mahalanobis distance between two pieces of surface, one of each cloud; at most
    /// 3.
    pub deviations: f64,
    /// ln(1 + Σs): how clearly edges between neighbours of one cloud pass through the surface of
    /// the other, s being standard deviations of each crossing, up to 6.
    pub crossing: f64,
    /// ΣP (eq. 16): how many points of a contact patch are expected on the wrong side of the
    /// surface that separates it best, largest over the patches; `None` where the other two leave
    /// no doubt and no classifier was trained.
    pub misclassified: Option<f64>,
    /// X.
    pub features: [f64; 12],
}

/// Two logistic regressions from [`ContactEvidence`] to a probability: by geometry alone, and with
/// the classifier.
///
/// The default is fitted on generated scenes (`cargo xtask calibrate`; docs/lab/accuracy.md says how
/// well it fits scenes it was not fitted on). Who has labelled scenes can fit another to the
/// evidence in their reports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recalibration {
    /// Intercept, and slopes of `crossing` (0 or more) and `deviations` (0 or less).
    pub by_geometry: [f64; 3],
    /// Intercept, and slopes of `crossing` (0 or more), `deviations` (0 or less) and
    /// ln(`misclassified` + 0.02) (0 or more).
    pub by_all: [f64; 4],
}

impl Default for Recalibration {
    fn default() -> Self {
        Self { by_geometry: [0.173, 0.613, -1.868], by_all: [-0.98, 0.608, -0.398, 0.734] }
    }
}

impl ContactEvidence {
    /// ln(`misclassified` + 0.02), what the second regression takes; `None` where no classifier was
    /// trained.
    pub fn ln_misclassified(&self) -> Option<f64> {
        self.misclassified.map(ln_above_floor)
    }
}

fn ln_above_floor(misclassified: f64) -> f64 {
    (misclassified + MISCLASSIFIED_FLOOR).ln()
}

impl Recalibration {
    /// Checks every coefficient.
    ///
    /// # Errors
    /// When one is not finite, or its sign is not that of evidence: more crossing, fewer deviations
    /// and more misclassified points must not make a collision less probable. Bounds rest on that.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let [_, crossing, deviations] = self.by_geometry;
        let [_, crossing_too, deviations_too, misclassified] = self.by_all;
        for (name, value) in [
            ("crossing", crossing),
            ("crossing", crossing_too),
            ("deviations", -deviations),
            ("deviations", -deviations_too),
            ("misclassified", misclassified),
        ] {
            if value < 0.0 {
                return Err(SettingsError::Slope { name });
            }
        }
        match self.by_geometry.iter().chain(&self.by_all).find(|value| !value.is_finite()) {
            Some(&value) => Err(SettingsError::NotFinite { name: "recalibration", value }),
            None => Ok(()),
        }
    }

    /// The probability given the geometry alone, at most [`MOST_CERTAIN`]. It grows with every
    /// crossing found and every deviation less.
    pub(crate) fn probability_by_geometry(&self, deviations: f64, crossing: f64) -> f64 {
        let [intercept, on_crossing, on_deviations] = self.by_geometry;
        logistic(intercept + on_crossing * crossing + on_deviations * deviations).min(MOST_CERTAIN)
    }

    /// The probability given the classifier too.
    pub(crate) fn probability_by_all(
        &self,
        deviations: f64,
        crossing: f64,
        misclassified: f64,
    ) -> f64 {
        let [intercept, on_crossing, on_deviations, on_misclassified] = self.by_all;
        logistic(
            intercept
                + on_crossing * crossing
                + on_deviations * deviations
                + on_misclassified * ln_above_floor(misclassified),
        )
    }
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_passes_its_own_check() {
        assert_eq!(Recalibration::default().validate(), Ok(()));
    }

    #[test]
    fn slopes_against_the_evidence_and_nan_are_refused() {
        let good = Recalibration { by_geometry: [0.0, 1.0, -1.0], by_all: [0.0, 1.0, -1.0, 1.0] };
        assert_eq!(good.validate(), Ok(()));
        let more_crossing_is_less = Recalibration { by_geometry: [0.0, -1.0, -1.0], ..good };
        let error = more_crossing_is_less.validate().unwrap_err();
        assert_eq!(error, SettingsError::Slope { name: "crossing" });
        for by_all in [[0.0, 1.0, 1.0, 1.0], [f64::NAN, 1.0, -1.0, 1.0]] {
            assert!(Recalibration { by_all, ..good }.validate().is_err(), "{by_all:?}");
        }
    }

    #[test]
    fn nothing_found_is_improbable_and_everything_is_not() {
        let default = Recalibration::default();
        assert!(default.probability_by_geometry(MOST_DEVIATIONS, 0.0) < 0.02);
        assert_eq!(default.probability_by_geometry(0.0, 6.0), MOST_CERTAIN);
        assert_eq!(default.probability_by_geometry(0.0, 1e3), MOST_CERTAIN);
        assert!(default.probability_by_all(0.0, 6.0, 30.0) > 0.95);
    }
}
