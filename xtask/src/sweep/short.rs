//! The short sweep that CI runs: fails when accuracy gets worse than recorded.

use anyhow::{Result, bail};
use cloudtouch_testkit::family::Family;

use super::{
    OURS, SEED, answer,
    measures::{Bootstrap, Judged, Measure, measure},
    plan::Plan,
};

/// Poses of each family.
const POSES: usize = 24;
const POINTS: usize = 5_000;
const STD: f64 = 0.005;

/// A family with the least AUC and the largest Brier score that are as good as recorded.
///
/// The run is deterministic; the bounds leave room for changes that move single answers: .02 each.
const RECORDED: [(Family, f64, f64); 9] = [
    (Family::PianoRoom, 0.945, 0.125),
    (Family::Tabletop, 0.980, 0.052),
    (Family::SphereAndPlane, 0.945, 0.098),
    (Family::WedgeAndPlane, 0.959, 0.096),
    (Family::CrossingSheets, 0.966, 0.091),
    (Family::PegInHole, 0.973, 0.149),
    (Family::InterlockedTori, 0.980, 0.042),
    (Family::ThinSlab, 0.952, 0.107),
    (Family::Furniture, 0.890, 0.140),
];

/// Runs it and compares.
pub(super) fn run() -> Result<()> {
    let families = RECORDED.map(|(family, ..)| family);
    let answers = answer::all(&Plan::short(&families, POSES, POINTS, STD))?;
    let mut worse = Vec::new();
    for (family, least_auc, largest_brier) in RECORDED {
        let judged = Judged::pick(&answers, &[OURS], |c, _| c.family == family.name());
        let samples: Vec<_> = [OURS.to_owned()].into_iter().zip(judged.samples()).collect();
        let wanted = [Measure::Auc, Measure::Brier];
        let measured = measure(&samples, &wanted, &judged.clusters, Bootstrap::new(SEED));
        let value = |m| measured.estimate(OURS, m).map_or(f64::NAN, |e| e.value);
        let (auc, brier) = (value(Measure::Auc), value(Measure::Brier));
        println!(
            "{}: AUC {auc:.3} (least {least_auc}), Brier {brier:.3} (most {largest_brier})",
            family.name()
        );
        // A value that is not a number is worse, too.
        if !(auc >= least_auc && brier <= largest_brier) {
            worse.push(family.name());
        }
    }
    if !worse.is_empty() {
        bail!("less accurate than recorded in xtask/src/sweep/short.rs: {}", worse.join(", "));
    }
    Ok(())
}
