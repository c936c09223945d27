//! Whether stated clearances hold the true distance of the surfaces.

use super::{OURS, judged::Judged, tables::ordinary};
use crate::{
    answers::{Answers, Pair, Question, Said},
    targets::Target,
};

/// Poses within this of contact are judged, m.
const NEAR: f64 = 0.05;
/// A clearance is right within so many of its standard deviations, in so many of a hundred.
const DEVIATIONS: f64 = 2.0;
const RIGHT: f64 = 90.0;

/// Of one kind of pair: clearances within two deviations of the truth, and lower bounds below it.
pub(super) fn targets(answers: &Answers, pair: Pair) -> [Target; 2] {
    let judged = Judged::pick(answers, &[OURS], |q: &Question| {
        ordinary(pair)(q) && q.signed_distance.abs() <= NEAR
    });
    let truths = judged.questions().iter().map(|q| q.signed_distance);
    let all: Vec<(&Said, f64)> = judged.said(OURS).iter().zip(truths).collect();
    let told: Vec<bool> = all.iter().filter_map(|(said, truth)| is_right(said, *truth)).collect();
    let percent = |count: usize, of: usize| 100.0 * count as f64 / of as f64;
    let right = percent(told.iter().filter(|right| **right).count(), told.len());
    let what = format!(
        "{}: within 5 cm of contact, clearance within {DEVIATIONS} deviations in {RIGHT} %",
        pair.name()
    );
    let shown =
        format!("{right:.0} % of {}; told in {:.0} %", told.len(), percent(told.len(), all.len()));
    let above = all
        .iter()
        .filter(|(said, truth)| said.clearance_at_least.is_some_and(|least| least > *truth));
    let above = above.count();
    let bound = format!("{}: no lower bound on the clearance above the truth", pair.name());
    [
        Target::new(what, shown, right >= RIGHT),
        Target::new(bound, format!("{above} of {}", all.len()), above == 0 && !all.is_empty()),
    ]
}

/// Whether the truth is where a clearance says, or deeper where it says so; `None` where it says
/// nothing.
fn is_right(said: &Said, truth: f64) -> Option<bool> {
    let clearance = said.clearance?;
    let (off, allowed) = (truth - clearance.mean, DEVIATIONS * clearance.std);
    Some(off <= allowed && (clearance.is_bound || off >= -allowed))
}
