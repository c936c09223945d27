//! From evidence to a probability: every constant of the fit, and nothing else.
//!
//! Surfaces of log odds, fitted on generated scenes whose truth is known (`cargo xtask calibrate`): one
//! over what geometry says of the place of contact, for every noise, one by which its extent changes that,
//! and one by which the classifier revises it where doubt is left. All are continuous, and monotone in what
//! is evidence.

mod bound;
// Made by a command, a row a line.
#[rustfmt::skip]
mod fitted;
mod grid;
mod knots;
mod of_pair;
mod within;

use serde::{Deserialize, Serialize};

use crate::error::SettingsError;

pub use grid::between_knots;
pub(crate) use knots::MOST_DEVIATIONS;
pub use knots::{
    CROSSING_KNOTS, DEVIATION_KNOTS, DOUBT_KNOTS, EXTENT_KNOTS, EXTENT_NOISES, MISCLASSIFIED_KNOTS,
    NOISE_KNOTS, ODDS_KNOTS, OverDoubt, OverExtent, OverGeometry,
};
pub use of_pair::sharp_extent;
pub(crate) use of_pair::{Blur, JudgeOfPair, probability};
pub(crate) use within::log_odds_within;
pub use within::{WITHIN_KNOTS, WITHIN_NOISES};

/// What a probability rests on. Each number is comparable between scenes: none has a unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactEvidence {
    /// z: the least Mahalanobis distance between two pieces of surface, one of each body, from 6 down
    /// to 0; negative, down to −6, by how deep a point of a cloud is inside a closed mesh.
    pub deviations: f64,
    /// ln(1 + s): how clearly one surface passes through the other at the place where it does so
    /// most, s being the sum of standard deviations of the crossings there, up to 6 each.
    pub crossing: f64,
    /// n: over how many pieces of surface the bodies are about as near as where they are nearest, and yet
    /// apart; of two clouds the fewer. A piece with up to 1.5 deviations more than the nearest counts in full,
    /// one with 2.5 more not at all. Each is weighed by how surely it is on one side of the other surface,
    /// 2Φ(z) − 1, and by the part of its error that it does not share with the pieces about it; one inside of a closed
    /// mesh is subtracted. The sum is large where faces lie along one another: the least of many distances is less, by chance,
    /// than the distance of the surfaces. `None` where that changes nothing: surfaces that clearly cross, and
    /// a search that was cut short.
    pub extent: Option<f64>,
    /// ΣP (eq. 16): how many points of a contact patch are expected on the wrong side of the
    /// surface that separates it best, largest over the patches, and no fewer than a point is surely
    /// inside a closed mesh (2Φ(depth in deviations) − 1); `None` where geometry leaves no doubt, or the
    /// noise is as large as the spacing of the points, and no classifier was trained.
    pub misclassified: Option<f64>,
    /// How blurred the samples are: standard deviation of the noise over their spacing, both in the median
    /// of a body, of both bodies together (the root of the sum of their squares); 0 of exact ones. It is no
    /// evidence itself, but says what the rest is worth.
    pub noise_over_spacing: f64,
    /// The same as far as the points scatter by the noise that is stated. What they do not show is an error that
    /// they share, or is not there: then none of many is near by chance. Told of more than a half; below it is the noise.
    pub scatter_over_spacing: f64,
}

impl ContactEvidence {
    /// ln(`misclassified` + 0.02), what the revision goes by; `None` where no classifier was
    /// trained.
    pub fn ln_misclassified(&self) -> Option<f64> {
        self.misclassified.map(of_pair::ln_above_floor)
    }

    pub(crate) fn blur(&self) -> Blur {
        Blur { noise: self.noise_over_spacing, scatter: self.scatter_over_spacing }
    }
}

/// Log odds of a collision by evidence, where collisions are as frequent as not.
///
/// The default is fitted on generated scenes (docs/lab/accuracy.md says how well it fits scenes it
/// was not fitted on). Who has labelled scenes can fit another to the evidence in their reports.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Judge {
    /// At [`NOISE_KNOTS`], [`DEVIATION_KNOTS`] and [`CROSSING_KNOTS`]: rising with crossing, falling with
    /// deviations.
    pub by_geometry: [OverGeometry; NOISE_KNOTS.len()],
    /// At the first [`EXTENT_NOISES`] of [`NOISE_KNOTS`], [`ODDS_KNOTS`] and [`EXTENT_KNOTS`], less and less from the
    /// last of these to the next, from which on nothing is changed: rising with the log odds by the place of
    /// contact, and where fewer pieces are as near. The outermost rows have the log odds of their knots.
    pub over_extent: [OverExtent; EXTENT_NOISES],
    /// At [`DOUBT_KNOTS`] and [`MISCLASSIFIED_KNOTS`]: rising with both. The outermost rows have the
    /// log odds of their knots.
    pub revised: OverDoubt,
}

impl Default for Judge {
    fn default() -> Self {
        Self {
            by_geometry: fitted::BY_GEOMETRY,
            over_extent: fitted::OVER_EXTENT,
            revised: fitted::REVISED,
        }
    }
}

impl Judge {
    /// Checks every value.
    ///
    /// # Errors
    /// When one is not finite, or goes against its evidence: more crossing, fewer deviations and
    /// more misclassified points must not make a collision less probable. Bounds rest on that.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let geometry = self.by_geometry.as_flattened().as_flattened();
        let extent = self.over_extent.as_flattened().as_flattened();
        let mut all = geometry.iter().chain(extent).chain(self.revised.as_flattened());
        if let Some(&value) = all.find(|value| !value.is_finite()) {
            return Err(SettingsError::NotFinite { name: "judge", value });
        }
        let rises = |row: &[f64]| row.is_sorted();
        let below = |(low, high): (&[f64], &[f64])| low.iter().zip(high).all(|(a, b)| a <= b);
        let climbs = |rows: &[f64], width: usize| {
            let rows: Vec<&[f64]> = rows.chunks(width).collect();
            rows.windows(2).all(|pair| below((pair[0], pair[1])))
        };
        let falls = |rows: &OverGeometry| rows.windows(2).all(|pair| below((&pair[1], &pair[0])));
        for (name, holds) in [
            ("crossing", self.by_geometry.as_flattened().iter().all(|row| rises(row))),
            ("deviations", self.by_geometry.iter().all(falls)),
            ("extent", self.over_extent.as_flattened().iter().all(|row| rises(row))),
            (
                "contact",
                self.over_extent.iter().all(|of| climbs(of.as_flattened(), EXTENT_KNOTS.len())),
            ),
            ("misclassified", self.revised.iter().all(|row| rises(row))),
            ("geometry", climbs(self.revised.as_flattened(), MISCLASSIFIED_KNOTS.len())),
        ] {
            if !holds {
                return Err(SettingsError::Slope { name });
            }
        }
        let ends = |knots: usize| [0, knots - 1];
        let revised = ends(DOUBT_KNOTS.len()).map(|k| (DOUBT_KNOTS[k], &self.revised[k][..]));
        let of_extent = self
            .over_extent
            .iter()
            .flat_map(|of| ends(ODDS_KNOTS.len()).map(|k| (ODDS_KNOTS[k], &of[k][..])));
        for (at, row) in of_extent.chain(revised) {
            if row.iter().any(|&value| value != at) {
                return Err(SettingsError::Revision { at });
            }
        }
        Ok(())
    }

    /// The same without the classifier: it is never asked.
    #[must_use]
    pub fn without_classifier(mut self) -> Self {
        for (row, knot) in self.revised.iter_mut().zip(DOUBT_KNOTS) {
            row.fill(knot);
        }
        self
    }

    /// The same without the extent: how many pieces of surface are as near says nothing.
    #[must_use]
    pub fn without_extent(mut self) -> Self {
        for of_noise in &mut self.over_extent {
            for (row, knot) in of_noise.iter_mut().zip(ODDS_KNOTS) {
                row.fill(knot);
            }
        }
        self
    }

    /// Log odds given all evidence: what a report has as its
    /// [`log_likelihood_ratio`](crate::Report::log_likelihood_ratio), but where the noise is as large as a
    /// patch that the classifier was asked about: then they are no less than those by geometry.
    pub fn log_odds(&self, evidence: &ContactEvidence) -> f64 {
        let by_geometry = self.log_odds_by_geometry(evidence);
        let of_pair = self.for_blur(evidence.blur());
        evidence.misclassified.map_or(by_geometry, |count| of_pair.revise(by_geometry, count))
    }

    /// Log odds given the geometry alone.
    pub fn log_odds_by_geometry(&self, evidence: &ContactEvidence) -> f64 {
        let of_pair = self.for_blur(evidence.blur());
        of_pair.with_extent(self.log_odds_by_place(evidence), evidence.extent)
    }

    /// Log odds given what geometry says of the place of contact.
    pub fn log_odds_by_place(&self, evidence: &ContactEvidence) -> f64 {
        let ContactEvidence { deviations, crossing, .. } = *evidence;
        self.for_blur(evidence.blur()).log_odds_by_place(deviations, crossing)
    }

    /// The judge for bodies that are so blurred.
    pub(crate) fn for_blur(&self, blur: Blur) -> JudgeOfPair {
        let Self { by_geometry, over_extent, revised } = self;
        JudgeOfPair::new(by_geometry, over_extent, revised, blur)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_passes_its_own_check() {
        assert_eq!(Judge::default().validate(), Ok(()));
    }

    /// A fit to ordinary scenes alone repeats its last surface for all that is noisier.
    #[test]
    fn noise_beyond_that_of_ordinary_scenes_was_fitted_too() {
        let [.., before, noisiest] = Judge::default().by_geometry;
        assert_ne!(before, noisiest, "run the second command in the head of fitted.rs as well");
    }

    #[test]
    fn values_against_the_evidence_and_nan_are_refused() {
        let good = Judge::default();
        for noise in 0..NOISE_KNOTS.len() {
            let mut falls = good;
            falls.by_geometry[noise][3][4] = falls.by_geometry[noise][3][3] - 1.0;
            assert_eq!(falls.validate(), Err(SettingsError::Slope { name: "crossing" }));
            let mut rises = good;
            rises.by_geometry[noise][4][8] = rises.by_geometry[noise][3][8] + 1.0;
            assert_eq!(rises.validate(), Err(SettingsError::Slope { name: "deviations" }));
        }
        let mut jumps = good;
        jumps.revised[0][8] = -2.0;
        assert_eq!(jumps.validate(), Err(SettingsError::Revision { at: -2.2 }));
        let mut climbs = good;
        climbs.over_extent[1][3][5] = climbs.over_extent[1][3][6] + 1.0;
        assert_eq!(climbs.validate(), Err(SettingsError::Slope { name: "extent" }));
        let mut falls = good;
        falls.over_extent[1][4].fill(-5.0);
        assert_eq!(falls.validate(), Err(SettingsError::Slope { name: "contact" }));
        let mut ends = good;
        ends.over_extent[1][0][0] = -6.0;
        assert_eq!(ends.validate(), Err(SettingsError::Revision { at: -5.0 }));
        let mut unknown = good;
        unknown.revised[2][2] = f64::NAN;
        assert!(unknown.validate().is_err());
    }
}
