//! From evidence to a probability: every constant of the fit, and nothing else.
//!
//! Two surfaces of log odds, fitted on generated scenes whose truth is known (`cargo xtask
//! calibrate`): one over what geometry says, and one by which the classifier revises that where it
//! leaves doubt. Both are continuous and monotone in every number.

mod fitted;
mod grid;
mod within;

use serde::{Deserialize, Serialize};

use crate::error::SettingsError;

use grid::Grid;
pub use grid::between_knots;
pub use within::WITHIN_KNOTS;
pub(crate) use within::log_odds_within;

/// Deviations beyond this say no more than these, and no fewer below: what is looked for.
pub(crate) const MOST_DEVIATIONS: f64 = 6.0;
/// Keeps the logarithm of no misclassified point finite.
const MISCLASSIFIED_FLOOR: f64 = 0.02;

/// Where the surface over geometry has its values: deviations by rows, crossing by columns.
pub const DEVIATION_KNOTS: [f64; 13] =
    [-6.0, -4.0, -2.5, -1.2, 0.0, 0.4, 0.8, 1.2, 1.7, 2.3, 3.0, 4.0, MOST_DEVIATIONS];
/// See [`DEVIATION_KNOTS`].
pub const CROSSING_KNOTS: [f64; 9] = [0.0, 0.5, 1.2, 1.8, 2.4, 3.0, 3.6, 4.2, 5.0];
/// Where the revision has its values: log odds by geometry by rows, ln(misclassified + 0.02) by
/// columns. At the first and the last row nothing is revised.
pub const DOUBT_KNOTS: [f64; 7] = [-2.2, -1.5, -0.8, 0.0, 0.8, 1.5, 2.2];
/// See [`DOUBT_KNOTS`].
pub const MISCLASSIFIED_KNOTS: [f64; 9] = [-3.92, -3.2, -2.4, -1.6, -0.8, 0.0, 1.0, 2.2, 3.6];

/// What a probability rests on. Each number is comparable between scenes: none has a unit, and none
/// grows with the area of contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactEvidence {
    /// z: the least Mahalanobis distance between two pieces of surface, one of each body, from 6 down
    /// to 0; negative, down to −6, by how deep a point of a cloud is inside a closed mesh.
    pub deviations: f64,
    /// ln(1 + s): how clearly one surface passes through the other at the place where it does so
    /// most, s being the sum of standard deviations of the crossings there, up to 6 each.
    pub crossing: f64,
    /// ΣP (eq. 16): how many points of a contact patch are expected on the wrong side of the
    /// surface that separates it best, largest over the patches, and no fewer than a point is surely
    /// inside a closed mesh (2Φ(depth in deviations) − 1); `None` where geometry leaves no doubt, or the
    /// noise is as large as the spacing of the points, and no classifier was trained.
    pub misclassified: Option<f64>,
}

impl ContactEvidence {
    /// ln(`misclassified` + 0.02), what the revision goes by; `None` where no classifier was
    /// trained.
    pub fn ln_misclassified(&self) -> Option<f64> {
        self.misclassified.map(ln_above_floor)
    }
}

fn ln_above_floor(misclassified: f64) -> f64 {
    (misclassified + MISCLASSIFIED_FLOOR).ln()
}

/// Log odds of a collision by evidence, where collisions are as frequent as not.
///
/// The default is fitted on generated scenes (docs/lab/accuracy.md says how well it fits scenes it
/// was not fitted on). Who has labelled scenes can fit another to the evidence in their reports.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Judge {
    /// At [`DEVIATION_KNOTS`] and [`CROSSING_KNOTS`]: rising with crossing, falling with deviations.
    pub by_geometry: [[f64; CROSSING_KNOTS.len()]; DEVIATION_KNOTS.len()],
    /// At [`DOUBT_KNOTS`] and [`MISCLASSIFIED_KNOTS`]: rising with both. The outermost rows have the
    /// log odds of their knots.
    pub revised: [[f64; MISCLASSIFIED_KNOTS.len()]; DOUBT_KNOTS.len()],
}

impl Default for Judge {
    fn default() -> Self {
        Self { by_geometry: fitted::BY_GEOMETRY, revised: fitted::REVISED }
    }
}

impl Judge {
    /// Checks every value.
    ///
    /// # Errors
    /// When one is not finite, or goes against its evidence: more crossing, fewer deviations and
    /// more misclassified points must not make a collision less probable. Bounds rest on that.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let mut all = self.by_geometry.as_flattened().iter().chain(self.revised.as_flattened());
        if let Some(&value) = all.find(|value| !value.is_finite()) {
            return Err(SettingsError::NotFinite { name: "judge", value });
        }
        let rises = |row: &[f64]| row.is_sorted();
        let below = |(low, high): (&[f64], &[f64])| low.iter().zip(high).all(|(a, b)| a <= b);
        let geometry = self.by_geometry.each_ref().map(|row| &row[..]);
        let revised = self.revised.each_ref().map(|row| &row[..]);
        for (name, holds) in [
            ("crossing", geometry.iter().all(|row| rises(row))),
            ("deviations", geometry.windows(2).all(|pair| below((pair[1], pair[0])))),
            ("misclassified", revised.iter().all(|row| rises(row))),
            ("geometry", revised.windows(2).all(|pair| below((pair[0], pair[1])))),
        ] {
            if !holds {
                return Err(SettingsError::Slope { name });
            }
        }
        for k in [0, DOUBT_KNOTS.len() - 1] {
            if self.revised[k].iter().any(|&value| value != DOUBT_KNOTS[k]) {
                return Err(SettingsError::Revision { at: DOUBT_KNOTS[k] });
            }
        }
        Ok(())
    }

    /// The same without the classifier: it is never asked.
    pub fn without_classifier(self) -> Self {
        self.trusting(0.0)
    }

    /// The same with this share, from 0 to 1, of what the classifier revises.
    pub(crate) fn trusting(mut self, share: f64) -> Self {
        for (row, knot) in self.revised.iter_mut().zip(DOUBT_KNOTS) {
            for value in row {
                *value = share * *value + (1.0 - share) * knot;
            }
        }
        self
    }

    /// Whether a classifier can change log odds by geometry.
    pub(crate) fn is_open(&self, by_geometry: f64) -> bool {
        self.revise(by_geometry, 0.0) < self.revise(by_geometry, f64::INFINITY)
    }

    /// Log odds given the geometry alone.
    pub fn log_odds_by_geometry(&self, deviations: f64, crossing: f64) -> f64 {
        self.geometry().at(deviations, crossing)
    }

    /// What log odds by geometry change by with the deviations and with the crossing.
    pub(crate) fn slopes_by_geometry(&self, deviations: f64, crossing: f64) -> [f64; 2] {
        self.geometry().slopes(deviations, crossing)
    }

    fn geometry(&self) -> Grid<'_, { DEVIATION_KNOTS.len() }, { CROSSING_KNOTS.len() }> {
        Grid { rows: &DEVIATION_KNOTS, columns: &CROSSING_KNOTS, values: &self.by_geometry }
    }

    /// Log odds given what a classifier said too; the same again where geometry leaves no doubt.
    pub fn revise(&self, by_geometry: f64, misclassified: f64) -> f64 {
        if Self::leaves_no_doubt(by_geometry) {
            return by_geometry;
        }
        self.revision().at(by_geometry, ln_above_floor(misclassified))
    }

    /// What revised log odds change by with those by geometry and with the misclassified points.
    pub(crate) fn slopes_of_revision(&self, by_geometry: f64, misclassified: f64) -> [f64; 2] {
        if Self::leaves_no_doubt(by_geometry) {
            return [1.0, 0.0];
        }
        let slopes = self.revision().slopes(by_geometry, ln_above_floor(misclassified));
        [slopes[0], slopes[1] / (misclassified + MISCLASSIFIED_FLOOR)]
    }

    fn leaves_no_doubt(by_geometry: f64) -> bool {
        let [least, .., most] = DOUBT_KNOTS;
        by_geometry <= least || by_geometry >= most
    }

    fn revision(&self) -> Grid<'_, { DOUBT_KNOTS.len() }, { MISCLASSIFIED_KNOTS.len() }> {
        Grid { rows: &DOUBT_KNOTS, columns: &MISCLASSIFIED_KNOTS, values: &self.revised }
    }
}

/// The probability at a log likelihood ratio where this share of poses collides beforehand.
pub(crate) fn probability(log_likelihood_ratio: f64, prior: f64) -> f64 {
    let log_odds = log_likelihood_ratio + (prior / (1.0 - prior)).ln();
    1.0 / (1.0 + (-log_odds).exp())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_default_passes_its_own_check() {
        assert_eq!(Judge::default().validate(), Ok(()));
    }

    #[test]
    fn values_against_the_evidence_and_nan_are_refused() {
        let good = Judge::default();
        let mut falls = good;
        falls.by_geometry[3][4] = falls.by_geometry[3][3] - 1.0;
        assert_eq!(falls.validate(), Err(SettingsError::Slope { name: "crossing" }));
        let mut jumps = good;
        jumps.revised[0][8] = -2.0;
        assert_eq!(jumps.validate(), Err(SettingsError::Revision { at: -2.2 }));
        let mut unknown = good;
        unknown.revised[2][2] = f64::NAN;
        assert!(unknown.validate().is_err());
    }

    #[test]
    fn nothing_found_is_improbable_and_everything_is_not() {
        let judge = Judge::default();
        assert!(probability(judge.log_odds_by_geometry(MOST_DEVIATIONS, 0.0), 0.5) < 0.005);
        assert!(probability(judge.log_odds_by_geometry(0.0, 6.0), 0.5) > 0.99);
        assert!(probability(judge.log_odds_by_geometry(-MOST_DEVIATIONS, 0.0), 0.5) > 0.99);
    }

    #[test]
    fn a_prior_of_one_half_changes_nothing_and_others_move_the_odds() {
        assert_eq!(probability(0.0, 0.5), 0.5);
        assert!((probability(0.0, 0.1) - 0.1).abs() < 1e-15);
        assert!((probability(9.0_f64.ln(), 0.1) - 0.5).abs() < 1e-15);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn more_evidence_never_makes_a_collision_less_probable(
            z in -7.0..7.0_f64, c in 0.0..6.0_f64, m in 0.0..40.0_f64,
            step in (0.0..1.0_f64, 0.0..1.0_f64, 0.0..5.0_f64),
        ) {
            let judge = Judge::default();
            let of = |z, c, m| judge.revise(judge.log_odds_by_geometry(z, c), m);
            prop_assert!(of(z - step.0, c + step.1, m + step.2) >= of(z, c, m) - 1e-12);
        }

        #[test]
        fn slopes_are_what_a_small_step_changes(
            z in -7.0..7.0_f64, c in 0.01..6.0_f64, m in 0.01..40.0_f64,
        ) {
            const STEP: f64 = 1e-7;
            let judge = Judge::default();
            let geometry = |z, c| judge.log_odds_by_geometry(z, c);
            let by_geometry = geometry(z, c);
            let [by_z, by_c] = judge.slopes_by_geometry(z, c);
            let [by_odds, by_m] = judge.slopes_of_revision(by_geometry, m);
            // A step over a knot has two slopes, of which either is right.
            let is_of = |slope: f64, above: f64, below: f64, here: f64| {
                let (above, below) = ((above - here) / STEP, (here - below) / STEP);
                (slope - above).abs().min((slope - below).abs()) < 1e-4 * (1.0 + slope.abs())
            };
            let revised = |odds, m| judge.revise(odds, m);
            prop_assert!(is_of(by_z, geometry(z + STEP, c), geometry(z - STEP, c), by_geometry));
            prop_assert!(is_of(by_c, geometry(z, c + STEP), geometry(z, c - STEP), by_geometry));
            let here = revised(by_geometry, m);
            let odds = [by_geometry + STEP, by_geometry - STEP].map(|odds| revised(odds, m));
            prop_assert!(is_of(by_odds, odds[0], odds[1], here));
            let counts = [m + STEP, m - STEP].map(|m| revised(by_geometry, m));
            prop_assert!(is_of(by_m, counts[0], counts[1], here));
        }

        #[test]
        fn a_little_more_evidence_says_a_little_more(
            z in -7.0..7.0_f64, c in 0.0..6.0_f64, m in 0.0..40.0_f64,
        ) {
            let judge = Judge::default();
            let of = |z, c, m| judge.revise(judge.log_odds_by_geometry(z, c), m);
            for near in [of(z + 1e-6, c, m), of(z, c + 1e-6, m), of(z, c, m + 1e-6)] {
                prop_assert!((near - of(z, c, m)).abs() < 1e-3);
            }
        }
    }
}
