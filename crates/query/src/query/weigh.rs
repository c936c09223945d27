//! The evidence of one pair of bodies: the search, and the classifier where that leaves doubt.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::{ContactEvidence, MOST_DEVIATIONS, probability};
use crate::search::{Found, Looked, look_inside, search};
use crate::stats::Stats;

use super::classify::ask_classifier;
use super::misclassified::Misclassified;
use super::steering::{Steering, is_enough};
use super::task::Task;

/// What a probability rests on, and where that was found.
#[derive(Debug)]
pub(super) struct Weighed<'a> {
    pub found: Found<'a>,
    pub looked: Looked,
    /// Without what the classifier says.
    pub of_geometry: ContactEvidence,
    /// Log odds by the place of contact, and by all of that.
    pub by_place: f64,
    pub by_geometry: f64,
    pub misclassified: Misclassified,
    /// Whether what was left out can change nothing.
    pub is_complete: bool,
    /// Whether the extent was not asked for, since the pair is free whatever it is.
    pub is_extent_open: bool,
    /// Whether the time was over before anything was looked at.
    pub is_too_late: bool,
}

impl Weighed<'_> {
    /// Where nothing was looked at: as where nothing was found, but that anything may be there.
    fn too_late(task: &Task<'_>) -> Self {
        let of_geometry = ContactEvidence {
            deviations: MOST_DEVIATIONS,
            crossing: 0.0,
            extent: None,
            misclassified: None,
            noise_over_spacing: task.blur.noise,
            scatter_over_spacing: task.blur.scatter,
        };
        let by_place = task.judge.log_odds_by_place(MOST_DEVIATIONS, 0.0);
        Self {
            found: Found::default(),
            looked: Looked::default(),
            of_geometry,
            by_place,
            by_geometry: by_place,
            misclassified: Misclassified::NOT_ASKED,
            is_complete: false,
            is_extent_open: false,
            is_too_late: true,
        }
    }
}

/// Gathers the evidence of two bodies, of which one is a cloud.
pub(super) fn weigh<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    task: &Task<'_>,
    stats: &mut Stats,
) -> Result<Weighed<'a>, QueryError> {
    if task.clock.is_over() {
        return Ok(Weighed::too_late(task));
    }
    let judge = &task.judge;
    let looked =
        look_inside((a, b), a_from_b, &task.clock, |deviations| is_enough(deviations, 0.0, task));
    stats.nodes_visited += looked.nodes_visited;
    stats.leaves_prepared += looked.leaves_prepared;
    let (found, is_extent_open) = search_beyond(&looked, (a, b), a_from_b, task, stats)?;
    let mut of_geometry = ContactEvidence {
        deviations: looked.deviations_given(found.deviations),
        crossing: found.crossings.clearness().ln_1p(),
        extent: None,
        misclassified: None,
        noise_over_spacing: task.blur.noise,
        scatter_over_spacing: task.blur.scatter,
    };
    let by_place = judge.log_odds_by_place(of_geometry.deviations, of_geometry.crossing);
    let is_complete = found.is_complete && !looked.is_cut_short;
    if is_complete && !is_extent_open && judge.may_change_with_extent(by_place) {
        of_geometry.extent = Some(found.extent((a, b), a_from_b));
    }
    let by_geometry = match is_extent_open {
        true => judge.with_any_extent(by_place)[1],
        false => judge.with_extent(by_place, of_geometry.extent),
    };
    let misclassified = if is_complete && is_in_doubt(by_geometry, task) {
        ask_classifier((a, b), a_from_b, &found, by_geometry, task, stats)?
            .or_inside(looked.surely_inside())
    } else {
        Misclassified::NOT_ASKED
    };
    Ok(Weighed {
        found,
        looked,
        of_geometry,
        by_place,
        by_geometry,
        misclassified,
        is_complete,
        is_extent_open,
        is_too_late: false,
    })
}

/// Searches the surfaces after a look inside, until what both say is enough; and whether it looked for no more than
/// where they are nearest.
fn search_beyond<'a>(
    looked: &Looked,
    bodies: (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    task: &Task<'_>,
    stats: &mut Stats,
) -> Result<(Found<'a>, bool), QueryError> {
    let mut look = |steering: &Steering<'_>| {
        search(bodies, a_from_b, |progress| steering.course(progress), stats)
    };
    let steering = Steering::as_asked(looked, task);
    let found = look(&steering)?;
    if steering.has_sufficed(&found) {
        let is_narrow = steering.is_narrow(&found);
        return Ok((found, is_narrow));
    }
    Ok((look(&Steering::wide(looked, task))?, false))
}

/// Whether a classifier is to be asked: it may move the odds by geometry, and what is asked hangs on it.
fn is_in_doubt(by_geometry: f64, task: &Task<'_>) -> bool {
    let (settings, judge) = (task.settings, &task.judge);
    let of = |log_odds| probability(log_odds, settings.prior);
    // Whatever a classifier says, the answer is the same.
    let is_settled = |decided| {
        of(judge.revise(by_geometry, f64::INFINITY)) < settings.reject
            || of(judge.revise(by_geometry, 0.0)) > decided
    };
    judge.is_open(by_geometry) && !settings.decided_above().is_some_and(is_settled)
}
