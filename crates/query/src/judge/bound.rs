//! What no evidence that is left open can make of evidence that is known.

use super::of_pair::{JudgeOfPair, probability};

/// What sums in another order may differ by, in log odds.
const ROUNDING: f64 = 1e-9;

impl JudgeOfPair {
    /// The probability where there are no fewer deviations and crossings are no clearer, whatever the
    /// extent is and a classifier says.
    pub(crate) fn at_most(&self, prior: f64, deviations: f64, clearness: f64) -> f64 {
        let by_place = self.log_odds_by_place(deviations, clearness.ln_1p());
        let [_, by_geometry] = self.with_any_extent(by_place);
        let revised = self.revise(by_geometry, f64::INFINITY).max(by_geometry);
        probability(revised + ROUNDING, prior)
    }
}
