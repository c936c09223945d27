//! The paper's classifier (eq. 10 to 16) on the places where geometry leaves doubt.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::classifier::{PairAnswer, by_kernel};
use crate::error::QueryError;
use crate::judge::{DOUBT_KNOTS, Judge};
use crate::report::Stats;
use crate::search::Found;

use super::patches::patches;
use super::task::Task;

/// ΣP, largest over the patches, and between what bounds it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Misclassified {
    /// `None` where no classifier could tell.
    pub value: Option<f64>,
    pub bounds: [f64; 2],
    /// Whether a patch was left to geometry: the noise is as large as it.
    is_indistinct: bool,
}

impl Misclassified {
    /// Anything may be found by a classifier that was not asked.
    pub(super) const NOT_ASKED: Self =
        Self { value: None, bounds: [0.0, f64::INFINITY], is_indistinct: false };
    const NOTHING: Self = Self { value: None, bounds: [0.0; 2], is_indistinct: false };

    fn known(value: f64) -> Self {
        Self { value: Some(value), bounds: [value; 2], is_indistinct: false }
    }

    /// Of a patch of so many points that no solver could decide.
    fn undecided(points: usize) -> Self {
        let points = points as f64;
        Self { value: Some(0.5 * points), bounds: [0.0, points], is_indistinct: false }
    }

    /// Of a patch of so many points that nothing separates and nothing joins.
    fn indistinct(points: usize) -> Self {
        Self { value: None, bounds: [0.0, points as f64], is_indistinct: true }
    }

    fn or_more(self, other: Self) -> Self {
        let [[low, high], [other_low, other_high]] = [self.bounds, other.bounds];
        let larger = |p: f64, q: f64| p.max(q);
        Self {
            value: match (self.value, other.value) {
                (Some(p), Some(q)) => Some(larger(p, q)),
                (value, None) | (None, value) => value,
            },
            bounds: [larger(low, other_low), larger(high, other_high)],
            is_indistinct: self.is_indistinct || other.is_indistinct,
        }
    }

    /// The log odds with what is known; where a patch was left to geometry, at least those of it.
    pub(super) fn log_odds(&self, judge: &Judge, by_geometry: f64) -> f64 {
        match self.value {
            None => by_geometry,
            Some(count) if self.is_indistinct => judge.revise(by_geometry, count).max(by_geometry),
            Some(count) => judge.revise(by_geometry, count),
        }
    }
}

/// What the classifier says of the patches. Every patch that it cannot decide, or that the time does
/// not suffice for, widens the bounds.
pub(super) fn ask_classifier(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    found: &Found<'_>,
    by_geometry: f64,
    task: &Task<'_>,
    stats: &mut Stats,
) -> Result<Misclassified, QueryError> {
    let patches = patches((a, b), a_from_b, found, task.settings.max_mesh_parts)?;
    if patches.is_empty() {
        return Ok(Misclassified::NOT_ASKED);
    }
    let mut all = Misclassified::NOTHING;
    for points in patches {
        let count = points.a.len() + points.b.len();
        if task.clock.is_over() {
            all = all.or_more(Misclassified::indistinct(count));
            continue;
        }
        let of_patch = match by_kernel(&points, &task.classifier, &task.clock, stats).answer {
            PairAnswer::Separated { a, b, .. } => Misclassified::known(a.iter().chain(&b).sum()),
            PairAnswer::Undecided => Misclassified::undecided(count),
            PairAnswer::Indistinct => Misclassified::indistinct(count),
        };
        all = all.or_more(of_patch);
        let [.., most] = DOUBT_KNOTS;
        if all.log_odds(&task.settings.judge, by_geometry) >= most {
            // No doubt is left, and further patches could only say more of the same.
            break;
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_indistinct_patch_beside_a_clear_one_was_skipped() {
        let clear = Misclassified::known(0.001);
        let all = clear.or_more(Misclassified::indistinct(40));
        assert_eq!((all.value, all.bounds), (Some(0.001), [0.001, 40.0]));
        // The clear patch alone would speak for free: what it does not speak of is left to geometry.
        let judge = Judge::default();
        assert!(clear.log_odds(&judge, 0.0) < -0.5);
        assert_eq!(all.log_odds(&judge, 0.0), 0.0);
        assert!(judge.revise(0.0, all.bounds[1]) > 0.1);
    }

    #[test]
    fn without_an_answer_geometry_has_to_do() {
        let judge = Judge::default();
        assert_eq!(Misclassified::indistinct(12).log_odds(&judge, 0.7), 0.7);
        assert_eq!(Misclassified::NOT_ASKED.log_odds(&judge, -1.0), -1.0);
    }
}
