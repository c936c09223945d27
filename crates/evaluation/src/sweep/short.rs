//! The short sweep that CI runs: fails when accuracy gets worse than recorded.

use anyhow::{Result, bail};
use cloudtouch_testkit::family::Family;

use super::{
    OURS,
    ask::{Asked, ask},
    judged::Judged,
    plan::Plan,
};
use crate::{
    answers::{Pair, Question},
    measures::Measure,
    methods::Ours,
};

const DRAWS: u32 = 2;
const POSES: usize = 28;
const POINTS: usize = 5_000;
const STD: f64 = 0.005;

/// A family, and for two clouds and for a cloud and a mesh the least AUC and the largest Brier
/// score that are as good as recorded.
///
/// The run is deterministic; the bounds leave room for changes that move single answers: .01 each.
const RECORDED: [(Family, [[f64; 2]; 2]); 16] = [
    (Family::PianoRoom, [[0.976, 0.082], [0.966, 0.154]]),
    (Family::Tabletop, [[0.984, 0.058], [0.989, 0.066]]),
    (Family::SphereAndPlane, [[0.959, 0.082], [0.964, 0.084]]),
    (Family::WedgeAndPlane, [[0.986, 0.062], [0.987, 0.080]]),
    (Family::CrossingSheets, [[0.990, 0.033], [0.990, 0.077]]),
    (Family::PegInHole, [[0.990, 0.110], [0.990, 0.029]]),
    (Family::InterlockedTori, [[0.987, 0.035], [0.987, 0.037]]),
    (Family::ThinSlab, [[0.954, 0.117], [0.976, 0.092]]),
    (Family::Furniture, [[0.907, 0.134], [0.949, 0.130]]),
    (Family::LivingRoom, [[0.962, 0.099], [0.953, 0.180]]),
    (Family::Desk, [[0.970, 0.112], [0.975, 0.184]]),
    (Family::Kitchen, [[0.975, 0.074], [0.976, 0.076]]),
    (Family::Workbench, [[0.950, 0.101], [0.945, 0.158]]),
    (Family::BoxesInBin, [[0.990, 0.034], [0.990, 0.036]]),
    (Family::Doorway, [[0.956, 0.080], [0.977, 0.077]]),
    (Family::Staircase, [[0.931, 0.110], [0.926, 0.125]]),
];

/// Runs it and compares.
///
/// # Errors
/// When a method fails, or a family is answered worse than recorded.
pub fn run() -> Result<()> {
    let families = RECORDED.map(|(family, _)| family.into()).to_vec();
    let methods = [Asked::always(Ours::new(OURS)?)];
    let answers = ask(&Plan::of(families, DRAWS, POSES, POINTS, STD), &methods)?;
    let mut worse = Vec::new();
    for (family, recorded) in RECORDED {
        for (pair, [least_auc, largest_brier]) in Pair::ALL.into_iter().zip(recorded) {
            let keep = |q: &Question| q.family == family.name() && q.pair == pair;
            let judged = Judged::pick(&answers, &[OURS], keep);
            let value = |measure: Measure| {
                judged.sample(OURS).map_or(f64::NAN, |s| measure.of(s, &s.ones()))
            };
            let (auc, brier) = (value(Measure::Auc), value(Measure::Brier));
            let name = format!("{}, {}", family.name(), pair.name());
            println!(
                "{name}: AUC {auc:.3} (least {least_auc}), Brier {brier:.3} (most {largest_brier})"
            );
            // A value that is not a number is worse, too.
            if !(auc >= least_auc && brier <= largest_brier) {
                worse.push(name);
            }
        }
    }
    if !worse.is_empty() {
        bail!(
            "less accurate than recorded in crates/evaluation/src/sweep/short.rs: {}",
            worse.join("; ")
        );
    }
    Ok(())
}
