//! The paper's classifier (eq. 10 to 16) on the places where geometry leaves doubt.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::classifier::{PairAnswer, by_kernel};
use crate::error::QueryError;
use crate::judge::DOUBT_KNOTS;
use crate::search::Found;
use crate::stats::Stats;

use super::misclassified::Misclassified;
use super::patches::patches;
use super::task::Task;

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
    let Some(patches) = patches else { return Ok(Misclassified::NOTHING) };
    if patches.is_empty() {
        return Ok(Misclassified::NOT_ASKED);
    }
    let mut all = Misclassified::NOTHING;
    for (patch, points) in patches.into_iter().enumerate() {
        let points = points.in_order();
        let count = points.a.len() + points.b.len();
        if task.clock.is_over() {
            all = all.or_more(Misclassified::indistinct(count));
            continue;
        }
        let of_patch = match by_kernel(&points, &task.classifier, &task.clock, stats).answer {
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
