//! How many points are on the wrong side of the surface that a classifier draws, and what that says.

use crate::judge::JudgeOfPair;

/// ΣP, largest over the patches, and between what bounds it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Misclassified {
    /// `None` where no classifier could tell.
    pub value: Option<f64>,
    pub bounds: [f64; 2],
    /// Whether a patch was left to geometry: the noise is as large as it, or it was not solved.
    is_indistinct: bool,
    /// What has that value.
    pub told_by: MisclassifiedBy,
}

/// Who tells how many points are misclassified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MisclassifiedBy {
    /// Nothing that changes with the pose.
    Nothing,
    /// A patch, by its place among all.
    Patch(usize),
    /// The point that is most clearly inside a closed mesh.
    Inside,
}

impl Misclassified {
    /// Anything may be found by a classifier that was not asked.
    pub(super) const NOT_ASKED: Self = Self { bounds: [0.0, f64::INFINITY], ..Self::NOTHING };
    pub(super) const NOTHING: Self = Self {
        value: None,
        bounds: [0.0; 2],
        is_indistinct: false,
        told_by: MisclassifiedBy::Nothing,
    };

    pub(super) fn known(value: f64, patch: usize) -> Self {
        let told_by = MisclassifiedBy::Patch(patch);
        Self { value: Some(value), bounds: [value; 2], told_by, ..Self::NOTHING }
    }

    /// Of a patch of so many points that nothing separates and nothing joins, or that no solver decided.
    pub(super) fn indistinct(points: usize) -> Self {
        Self { bounds: [0.0, points as f64], is_indistinct: true, ..Self::NOTHING }
    }

    pub(super) fn or_more(self, other: Self) -> Self {
        let [[low, high], [other_low, other_high]] = [self.bounds, other.bounds];
        let larger = |p: f64, q: f64| p.max(q);
        let (value, told_by) = match (self.value, other.value) {
            (Some(p), Some(q)) if q > p => (other.value, other.told_by),
            (None, _) => (other.value, other.told_by),
            _ => (self.value, self.told_by),
        };
        Self {
            value,
            told_by,
            bounds: [larger(low, other_low), larger(high, other_high)],
            is_indistinct: self.is_indistinct || other.is_indistinct,
        }
    }

    /// The same where a point is inside a closed mesh as surely as that, from 0 to 1: whatever surface
    /// parts the samples, it is on the wrong side.
    pub(super) fn or_inside(self, surely: f64) -> Self {
        match self.value {
            Some(value) if value < surely => {
                let bounds = self.bounds.map(|bound| bound.max(surely));
                Self { value: Some(surely), bounds, told_by: MisclassifiedBy::Inside, ..self }
            }
            _ => self,
        }
    }

    /// The log odds with what is known; where a patch was left to geometry, at least those of it.
    pub(super) fn log_odds(&self, judge: &JudgeOfPair, by_geometry: f64) -> f64 {
        match self.value {
            None => by_geometry,
            Some(count) if self.is_indistinct => judge.revise(by_geometry, count).max(by_geometry),
            Some(count) => judge.revise(by_geometry, count),
        }
    }

    /// What these log odds change by with those by geometry and with the misclassified points.
    pub(super) fn slopes(&self, judge: &JudgeOfPair, by_geometry: f64) -> [f64; 2] {
        match self.value {
            Some(count)
                if self.log_odds(judge, by_geometry) == judge.revise(by_geometry, count) =>
            {
                judge.slopes_of_revision(by_geometry, count)
            }
            _ => [1.0, 0.0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::{Blur, Judge};

    #[test]
    fn an_indistinct_patch_beside_a_clear_one_was_skipped() {
        let clear = Misclassified::known(0.001, 0);
        let all = clear.or_more(Misclassified::indistinct(40));
        assert_eq!((all.value, all.bounds), (Some(0.001), [0.001, 40.0]));
        // The clear patch alone would speak for free: what it does not speak of is left to geometry.
        let judge = Judge::default().for_blur(Blur::shown(0.0));
        assert!(clear.log_odds(&judge, 0.0) < -0.5);
        assert_eq!(all.log_odds(&judge, 0.0), 0.0);
        assert!(judge.revise(0.0, all.bounds[1]) > 0.1);
    }

    /// A sheet within a slab is easily separated from its faces, which took its odds down.
    #[test]
    fn a_point_inside_is_misclassified_by_any_surface_between_the_samples() {
        let judge = Judge::default().for_blur(Blur::shown(0.0));
        let clear = Misclassified::known(0.001, 0);
        let inside = clear.or_inside(0.9);
        assert_eq!((inside.value, inside.bounds), (Some(0.9), [0.9; 2]));
        assert!(inside.log_odds(&judge, 0.0) > 0.3 + clear.log_odds(&judge, 0.0));
        assert_eq!(clear.or_inside(0.0), clear);
        assert_eq!(Misclassified::known(3.0, 1).or_inside(0.9).value, Some(3.0));
        assert_eq!(Misclassified::NOT_ASKED.or_inside(0.9), Misclassified::NOT_ASKED);
    }

    #[test]
    fn without_an_answer_geometry_has_to_do() {
        let judge = Judge::default().for_blur(Blur::shown(0.0));
        assert_eq!(Misclassified::indistinct(12).log_odds(&judge, 0.7), 0.7);
        assert_eq!(Misclassified::NOT_ASKED.log_odds(&judge, -1.0), -1.0);
    }
}
