//! From a probability, its upper bound and what speaks against them to a verdict.

use crate::doubt::undecided::Undecided;
use crate::report::Verdict;

/// Where probabilities become verdicts.
pub(super) struct Thresholds {
    /// Above it the pair collides.
    pub accept: f64,
    /// Below it, bounds included, the pair is free.
    pub reject: f64,
}

impl Thresholds {
    /// The verdict, and why it is [`Verdict::Undecided`] where it is; `unsolved` counts the classifiers
    /// that could not be trained.
    pub(super) fn decide(
        &self,
        probability: f64,
        upper: f64,
        unsolved: usize,
        doubt: Option<Undecided>,
    ) -> (Verdict, Option<Undecided>) {
        let of_search = if unsolved == 0 { Undecided::Bounds } else { Undecided::Unsolved };
        let undecided = (Verdict::Undecided, Some(doubt.unwrap_or(of_search)));
        if probability > self.accept {
            (Verdict::InCollision, None)
        } else if doubt.is_some() {
            // The number says nothing of what was not seen, or nothing at all.
            undecided
        } else if probability < self.reject && upper < self.reject && unsolved == 0 {
            (Verdict::Free, None)
        } else if probability < self.reject || unsolved > 0 {
            // What was culled, left out or not solved could still collide.
            undecided
        } else {
            // NaN would end here too, and not at free.
            (Verdict::Uncertain, None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_sure_is_free() {
        use Undecided::{Bounds, Enclosed, Unseen, Unsolved};
        let thresholds = Thresholds { accept: 0.5, reject: 0.1 };
        let undecided = |by| (Verdict::Undecided, Some(by));
        for (probability, upper, unsolved, doubt, expected) in [
            (0.05, 0.05, 0, None, (Verdict::Free, None)),
            // A threshold itself is neither free nor in collision.
            (0.1, 0.1, 0, None, (Verdict::Uncertain, None)),
            (0.5, 0.5, 0, None, (Verdict::Uncertain, None)),
            (0.51, 1.0, 0, None, (Verdict::InCollision, None)),
            (0.05, 0.1, 0, None, undecided(Bounds)),
            (0.05, 0.05, 1, None, undecided(Unsolved)),
            (0.3, 0.3, 1, None, undecided(Unsolved)),
            // Doubts widen the upper bound to 1.
            (0.05, 1.0, 0, Some(Unseen), undecided(Unseen)),
            (0.3, 1.0, 0, Some(Unseen), undecided(Unseen)),
            (0.51, 1.0, 0, Some(Unseen), (Verdict::InCollision, None)),
            (0.3, 1.0, 0, Some(Enclosed), undecided(Enclosed)),
            (0.51, 1.0, 1, Some(Enclosed), (Verdict::InCollision, None)),
            (f64::NAN, f64::NAN, 0, None, (Verdict::Uncertain, None)),
            // Whatever the bound says.
            (f64::NAN, 0.05, 0, None, (Verdict::Uncertain, None)),
        ] {
            let found = thresholds.decide(probability, upper, unsolved, doubt);
            assert_eq!(found, expected, "{probability} {upper} {unsolved} {doubt:?}");
        }
    }
}
