//! What the misclassified points of a patch change by as the pose does.

use cloudtouch_geom::{Motion, Pose, Vector3};
use nalgebra::UnitQuaternion;

use crate::body::BodyRef;
use crate::classifier::{
    ClassifierSettings, PairAnswer, PairPoint, PairPoints, by_kernel, centroid,
};
use crate::error::QueryError;
use crate::query::patches::patches;
use crate::query::task::Task;
use crate::search::{Found, Wrench, force_at};
use crate::stats::Stats;

/// Relative gap of the problems that slopes are told from, and how far the points move for it: by this
/// share of how far they reach, and by as many radians.
const TIGHT: f64 = 1e-9;
/// See [`TIGHT`].
const STEP: f64 = 1e-4;

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
    let Some(points) = patches.as_ref().and_then(|patches| patches.get(patch)) else {
        return Ok(Wrench::zeros());
    };
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
