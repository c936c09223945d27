//! Whether the bounds of an answer contain what a never stopped early finds.

use anyhow::Result;

use super::{
    OURS,
    ask::{Asked, ask},
    judged::Judged,
    plan::Plan,
    scenes::Scenes,
};
use crate::{answers::Pair, methods::Ours, page::Section, table::Table};

const EVERYTHING: &str = "never stopped early";
const POINTS: usize = 2_500;
const STD: f64 = 0.005;
/// Rounding moves a probability by less.
const ROUNDING: f64 = 1e-9;

/// Asks the default, and a query that never stops early.
pub(super) fn section() -> Result<Section> {
    let mut everything = Ours::new(EVERYTHING)?;
    everything.query.stop_above = 1.0;
    let methods = [Asked::always(Ours::new(OURS)?), Asked::always(everything)];
    let answers = ask(&Plan::of(Scenes::generated(), 1, 12, POINTS, STD), &methods)?;
    let mut table =
        Table::new(["pair", "answers", "outside of the bounds", "largest miss", "mean width"]);
    for pair in Pair::ALL {
        let judged = Judged::pick(&answers, &[OURS, EVERYTHING], |q| q.pair == pair);
        let rows = judged.said(OURS).iter().zip(judged.said(EVERYTHING));
        let (mut outside, mut largest, mut width) = (0, 0.0_f64, 0.0);
        for (said, all) in rows {
            let [low, high] = said.bounds.unwrap_or([f64::NAN; 2]);
            let miss = (low - all.score).max(all.score - high);
            // Not a number is a miss.
            outside += usize::from(miss.is_nan() || miss > ROUNDING);
            largest = largest.max(miss);
            width += high - low;
        }
        let count = judged.counts().0;
        table.row([
            pair.name().into(),
            count.to_string(),
            outside.to_string(),
            format!("{largest:.1e}"),
            format!("{:.1e}", width / count as f64),
        ]);
    }
    Ok(Section::new("Bounds").text(format_args!(
        "How often the probability that the same query states when it never stops early lies outside of the bounds of `{OURS}`: what is left out by \
         default must widen the bounds. All families, {POINTS} points, {} mm.",
        1e3 * STD
    )).text(table))
}
