//! The paper's classifier (eq. 10 to 16) on the places where geometry leaves doubt.

use cloudtouch_geom::{Motion, Pose, Vector3};
use nalgebra::UnitQuaternion;

use crate::body::BodyRef;
use crate::classifier::{
    ClassifierSettings, PairAnswer, PairPoint, PairPoints, by_kernel, centroid,
};
use crate::error::QueryError;
use crate::judge::{DOUBT_KNOTS, JudgeOfPair};
use crate::search::{Found, Wrench, force_at};
use crate::stats::Stats;

use super::patches::patches;
use super::task::Task;

/// Relative gap of the problems that slopes are told from, and how far the points move for it: by this
/// share of how far they reach, and by as many radians.
const TIGHT: f64 = 1e-9;
/// See [`TIGHT`].
const STEP: f64 = 1e-4;

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
    const NOTHING: Self = Self {
        value: None,
        bounds: [0.0; 2],
        is_indistinct: false,
        told_by: MisclassifiedBy::Nothing,
    };

    fn known(value: f64, patch: usize) -> Self {
        let told_by = MisclassifiedBy::Patch(patch);
        Self { value: Some(value), bounds: [value; 2], told_by, ..Self::NOTHING }
    }

    /// Of a patch of so many points that nothing separates and nothing joins, or that no solver decided.
    fn indistinct(points: usize) -> Self {
        Self { bounds: [0.0, points as f64], is_indistinct: true, ..Self::NOTHING }
    }

    fn or_more(self, other: Self) -> Self {
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
    for (patch, points) in patches.iter().enumerate() {
        let count = points.a.len() + points.b.len();
        if task.clock.is_over() {
            all = all.or_more(Misclassified::indistinct(count));
            continue;
        }
        let of_patch = match by_kernel(points, &task.classifier, &task.clock, stats).answer {
            PairAnswer::Separated { a, b, .. } => {
                Misclassified::known(a.iter().chain(&b).sum(), patch)
            }
            PairAnswer::Indistinct => Misclassified::indistinct(count),
            PairAnswer::Undecided => {
                stats.undecided += 1;
                Misclassified::indistinct(count)
            }
        };
        all = all.or_more(of_patch);
        let [.., most] = DOUBT_KNOTS;
        if all.log_odds(&task.judge, by_geometry) >= most {
            // No doubt is left, and further patches could only say more of the same.
            break;
        }
    }
    Ok(all)
}

/// What the misclassified points of a patch change by as the pose does; nothing where a classifier
/// cannot tell a little aside.
///
/// ΣP is no optimum of what the classifier minimises, so that the envelope theorem does not give its
/// derivative, and the multipliers that are at a bound change with the pose: the same points are moved a
/// little and separated anew, with a tight tolerance.
pub(super) fn misclassified_by_pose(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    (found, patch): (&Found<'_>, usize),
    task: &Task<'_>,
    stats: &mut Stats,
) -> Result<Wrench, QueryError> {
    let patches = patches((a, b), a_from_b, found, task.settings.max_mesh_parts)?;
    let Some(points) = patches.get(patch) else { return Ok(Wrench::zeros()) };
    let settings = ClassifierSettings {
        relative_gap: task.classifier.relative_gap.min(TIGHT),
        ..task.classifier
    };
    let middle = centroid(&points.b);
    let reach = points.b.iter().map(|p| (p.point.mean - middle).norm()).fold(0.0, f64::max);
    let step = STEP * reach.max(f64::MIN_POSITIVE);
    let mut sum = |shift: Vector3, turn: Vector3| {
        let turn = UnitQuaternion::from_scaled_axis(turn);
        let moved = Motion::from(
            &Pose::from_translation(middle.coords + shift)
                .after(&Pose::from_translation_rotation(Vector3::zeros(), turn))
                .after(&Pose::from_translation(-middle.coords)),
        );
        let b = points.b.iter().map(|p| PairPoint { point: moved.uncertain_point(&p.point), ..*p });
        let moved = PairPoints { a: points.a.clone(), b: b.collect(), ..*points };
        match by_kernel(&moved, &settings, &task.clock, stats).answer {
            PairAnswer::Separated { a, b, .. } => Some(a.iter().chain(&b).sum::<f64>()),
            PairAnswer::Undecided | PairAnswer::Indistinct => None,
        }
    };
    let mut slope = |shift: Vector3, turn: Vector3| {
        let (above, below) = (sum(shift * step, turn * STEP)?, sum(-shift * step, -turn * STEP)?);
        Some(above - below)
    };
    let none = Vector3::zeros();
    let mut slopes = [[0.0; 3]; 2];
    for k in 0..3 {
        let axis = Vector3::ith(k, 1.0);
        let (Some(force), Some(torque)) = (slope(axis, none), slope(none, axis)) else {
            return Ok(Wrench::zeros());
        };
        (slopes[0][k], slopes[1][k]) = (force / (2.0 * step), torque / (2.0 * STEP));
    }
    let [force, torque] = slopes.map(Vector3::from);
    let mut wrench = force_at(&middle, &force);
    let mut about = wrench.fixed_rows_mut::<3>(3);
    about += torque;
    Ok(wrench)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::Judge;

    #[test]
    fn an_indistinct_patch_beside_a_clear_one_was_skipped() {
        let clear = Misclassified::known(0.001, 0);
        let all = clear.or_more(Misclassified::indistinct(40));
        assert_eq!((all.value, all.bounds), (Some(0.001), [0.001, 40.0]));
        // The clear patch alone would speak for free: what it does not speak of is left to geometry.
        let judge = Judge::default().for_noise(0.0);
        assert!(clear.log_odds(&judge, 0.0) < -0.5);
        assert_eq!(all.log_odds(&judge, 0.0), 0.0);
        assert!(judge.revise(0.0, all.bounds[1]) > 0.1);
    }

    /// A sheet within a slab is easily separated from its faces, which took its odds down.
    #[test]
    fn a_point_inside_is_misclassified_by_any_surface_between_the_samples() {
        let judge = Judge::default().for_noise(0.0);
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
        let judge = Judge::default().for_noise(0.0);
        assert_eq!(Misclassified::indistinct(12).log_odds(&judge, 0.7), 0.7);
        assert_eq!(Misclassified::NOT_ASKED.log_odds(&judge, -1.0), -1.0);
    }
}
