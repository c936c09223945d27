//! All that one of the paths is asked about two bodies.

use anyhow::Result;
use cloudtouch::paper::LeafClassifier;
use cloudtouch::{
    Penetration, Placement, PoseDistribution, PoseGradient, Report, UnderPoses, Verdict,
};
use cloudtouch_cli::numbers::PoseStd;

use super::question::Question;
use crate::body;
use crate::margin::Nearness;

/// What the path says, as far as it was asked for.
pub(super) struct Found {
    pub report: Report,
    pub placement: Placement,
    pub nearness: Option<Nearness>,
    pub classifiers: Vec<LeafClassifier>,
    pub pose_uncertainty: Option<UnderPoses>,
    pub gradient: Option<PoseGradient>,
    /// Asked for, and found.
    pub penetration: Option<Option<Penetration>>,
}

pub(super) fn ask<P: body::Estimator>(
    query: &P,
    question: &Question<'_, P::Cloud>,
) -> Result<Found> {
    let Question { arguments, scene, object, pose, .. } = question;
    let (scene, object) = (&scene.body, &object.body);
    let (report, classifiers, nearness) = if arguments.explain {
        let (report, classifiers) = query.explain(scene, object, pose)?;
        (report, classifiers, None)
    } else {
        let (report, nearness) =
            query.ask_within(scene, object, pose, arguments.asked.mode.margin)?;
        (report, Vec::new(), nearness)
    };
    let placement = query.place(scene, object, pose);
    let pose_uncertainty = match arguments.pose.pose_std {
        Some(PoseStd(stds)) => {
            query.uncertain(scene, object, &PoseDistribution::from_std(*pose, stds))?
        }
        None => None,
    };
    if report.verdict == Verdict::Free
        && let Some(over) = &pose_uncertainty
        && over.bounds[1] >= arguments.asked.common.query_settings().reject
    {
        tracing::warn!(
            "the verdict is of the pose given: over those that --pose-std allows, a collision has up to {:.3}",
            over.bounds[1]
        );
    }
    let gradient = match arguments.gradient {
        true => query.slopes(scene, object, pose)?,
        false => None,
    };
    let way_out = |probability| query.way_out(scene, object, pose, probability);
    let penetration = arguments.penetration.map(way_out).transpose()?;
    Ok(Found { report, placement, nearness, classifiers, pose_uncertainty, gradient, penetration })
}
