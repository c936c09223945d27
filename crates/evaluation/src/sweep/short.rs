//! The short sweep that CI runs: fails when accuracy gets worse than recorded.

use anyhow::{Result, ensure};
use cloudtouch_testkit::family::Family;

use super::OURS;
use super::ask::{Asked, ask};
use super::judged::Judged;
use super::plan::Plan;
use crate::answers::{Condition, Pair, Question};
use crate::measures::Measure;
use crate::methods::Ours;

const DRAWS: u32 = 2;
const POSES: usize = 28;
const POINTS: usize = 5_000;
const STD: f64 = 0.005;

/// A family, and for two clouds and for a cloud and a mesh the least AUC and the largest Brier
/// score that are as good as recorded.
///
/// The run is deterministic; the bounds leave room for changes that move single answers: .01 each as a rule, less where they were loosened.
const RECORDED: [(Family, [[f64; 2]; 2]); 18] = [
    (Family::PianoRoom, [[0.984, 0.054], [0.980, 0.054]]),
    (Family::Tabletop, [[0.985, 0.040], [0.990, 0.024]]),
    (Family::SphereAndPlane, [[0.952, 0.097], [0.956, 0.084]]),
    (Family::WedgeAndPlane, [[0.989, 0.034], [0.990, 0.022]]),
    (Family::CrossingSheets, [[0.988, 0.046], [0.990, 0.036]]),
    (Family::PegInHole, [[0.990, 0.062], [0.990, 0.048]]),
    (Family::InterlockedTori, [[0.989, 0.050], [0.987, 0.044]]),
    (Family::ThinSlab, [[0.973, 0.081], [0.982, 0.052]]),
    (Family::Furniture, [[0.936, 0.113], [0.968, 0.074]]),
    (Family::LivingRoom, [[0.963, 0.088], [0.970, 0.079]]),
    (Family::Desk, [[0.977, 0.094], [0.977, 0.066]]),
    (Family::Kitchen, [[0.981, 0.061], [0.984, 0.041]]),
    (Family::Workbench, [[0.966, 0.072], [0.972, 0.068]]),
    (Family::BoxesInBin, [[0.990, 0.024], [0.990, 0.019]]),
    (Family::Doorway, [[0.985, 0.052], [0.979, 0.062]]),
    (Family::Staircase, [[0.941, 0.102], [0.961, 0.091]]),
    (Family::SettingDown, [[0.987, 0.069], [0.990, 0.050]]),
    (Family::Bookcase, [[0.964, 0.072], [0.972, 0.068]]),
];

/// Runs it and compares.
pub fn run() -> Result<()> {
    let families = RECORDED.map(|(family, _)| family.into()).to_vec();
    let methods = [Asked::always(Ours::new(OURS)?)];
    let conditions = vec![Condition { points: POINTS, std: STD }];
    let answers = ask(&Plan { families, conditions, ..Plan::full(DRAWS, POSES) }, &methods)?;
    let mut worse = Vec::new();
    for (family, recorded) in RECORDED {
        for (pair, [least_auc, largest_brier]) in Pair::ALL.into_iter().zip(recorded) {
            let keep = |q: &Question| q.family == family.name() && q.pair == pair;
            let judged = Judged::pick(&answers, &[OURS], keep);
            let [auc, brier] =
                [Measure::Auc, Measure::Brier].map(|measure| judged.estimate(OURS, measure).value);
            let name = format!("{}, {pair}", family.name());
            println!(
                "{name}: AUC {auc:.3} (least {least_auc}), Brier {brier:.3} (most {largest_brier})"
            );
            // A value that is not a number is worse, too.
            if !(auc >= least_auc && brier <= largest_brier) {
                worse.push(name);
            }
        }
    }
    let file = "crates/evaluation/src/sweep/short.rs";
    ensure!(worse.is_empty(), "less accurate than recorded in {file}: {}", worse.join("; "));
    Ok(())
}
