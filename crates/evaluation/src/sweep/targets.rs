//! What is aimed at, and whether it is reached.

use super::{
    ORACLE, OURS,
    judged::Judged,
    plan::STDS,
    tables::{Answered, is_near, shown},
};
use crate::{
    answers::{Kind, Pair, Question},
    measures::{Measure, observed_within},
    page::Section,
    table::Table,
};

/// A number that should be reached on the ordinary families together.
struct Target {
    pair: Pair,
    near: bool,
    measure: Measure,
    limit: f64,
    /// Only noise up to this counts, m.
    up_to: f64,
}

const TARGETS: [Target; 7] = [
    target(Pair::CloudCloud, false, Measure::Auc, 0.96, 0.02),
    target(Pair::CloudCloud, true, Measure::Auc, 0.86, 0.02),
    target(Pair::CloudCloud, false, Measure::Brier, 0.08, 0.02),
    target(Pair::CloudCloud, false, Measure::CalibrationError, 0.03, 0.02),
    target(Pair::CloudMesh, false, Measure::Auc, 0.98, 0.01),
    target(Pair::CloudMesh, true, Measure::Auc, 0.94, 0.01),
    target(Pair::CloudMesh, false, Measure::CalibrationError, 0.03, 0.02),
];

/// The largest ECE of one family beyond what chance gives.
const FAMILY_ERROR: f64 = 0.045;
/// What may collide of poses that are stated to do so with a probability below a tenth.
const STATED_FREE: f64 = 0.04;

const fn target(pair: Pair, near: bool, measure: Measure, limit: f64, up_to: f64) -> Target {
    Target { pair, near, measure, limit, up_to }
}

struct Rows {
    table: Table,
    met: usize,
    count: usize,
}

impl Rows {
    fn add(&mut self, target: String, reached: String, oracle: String, met: bool) {
        self.count += 1;
        self.met += usize::from(met);
        self.table.row([target, reached, oracle, if met { "yes" } else { "no" }.into()]);
    }
}

/// All targets, on ordinary scenes.
pub(super) fn section(answered: &Answered<'_>) -> Section {
    let table = Table::new(["target, ordinary scenes", "reached", "oracle", "met"]);
    let mut rows = Rows { table, met: 0, count: 0 };
    for target in &TARGETS {
        limited(answered, target, &mut rows);
    }
    for pair in Pair::ALL {
        families(answered, pair, &mut rows);
        stated(answered, pair, &mut rows);
        for std in STDS {
            alternatives(answered, pair, std, &mut rows);
        }
    }
    let Rows { table, met, count } = rows;
    Section::new("Targets").text(format_args!(
        "{met} of {count} are met. The oracle is `{OURS}` given every sampled point where it truly \
         is with the true normal: what the samples leave to be known. Every family is judged with \
         constants fitted on the others."
    )).text(table)
}

fn limited(answered: &Answered<'_>, target: &Target, rows: &mut Rows) {
    let Target { pair, near, measure, limit, up_to } = *target;
    let keep = |q: &Question| {
        Answered::is_of(pair, Kind::Ordinary)(q)
            && q.condition.std <= up_to
            && (!near || is_near(q))
    };
    let measured = Judged::pick(answered.answers, &[OURS, ORACLE], keep).measure(&[measure]);
    let [ours, oracle] = [OURS, ORACLE].map(|method| measured.estimate(method, measure));
    let relation = if measure == Measure::Auc { "at least" } else { "at most" };
    let which = if near { ", near" } else { "" };
    let noise = 1e3 * up_to;
    let name =
        format!("{}{which}, up to {noise} mm: {} {relation} {limit}", pair.name(), measure.name());
    // Not a number is not met.
    let met = ours.is_some_and(|e| measure.sign() * (e.value - limit) >= 0.0);
    rows.add(name, shown(ours), shown(oracle), met);
}

/// The family that is calibrated worst.
fn families(answered: &Answered<'_>, pair: Pair, rows: &mut Rows) {
    let error = |family: &'static str| {
        let keep = |q: &Question| q.family == family && Answered::is_of(pair, Kind::Ordinary)(q);
        let judged = Judged::pick(answered.answers, &[OURS], keep);
        let error =
            judged.sample(OURS).map_or(f64::NAN, |s| Measure::CalibrationError.of(s, &s.ones()));
        (family, error - judged.chance_error(OURS))
    };
    let all = answered.answers.families().into_iter().map(error).filter(|(_, e)| !e.is_nan());
    if let Some((family, worst)) = all.max_by(|a, b| a.1.total_cmp(&b.1)) {
        let target =
            format!("{}: ECE of every family at most {FAMILY_ERROR} above chance", pair.name());
        let reached = format!("{worst:.3} ({family})");
        rows.add(target, reached, "–".into(), worst <= FAMILY_ERROR);
    }
}

/// What is observed where a probability is stated.
fn stated(answered: &Answered<'_>, pair: Pair, rows: &mut Rows) {
    let judged =
        Judged::pick(answered.answers, &[OURS, ORACLE], Answered::is_of(pair, Kind::Ordinary));
    let [Some(ours), Some(oracle)] = [OURS, ORACLE].map(|m| judged.sample(m)) else { return };
    let within = |range: std::ops::Range<f64>| {
        [ours, oracle].map(|sample| observed_within(sample, range.clone()))
    };
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let [free, free_of_oracle] = within(0.0..0.1);
    let limit = percent(STATED_FREE);
    let target = format!("{}: stated below .1, at most {limit} collide", pair.name());
    let met = free.observed <= STATED_FREE;
    rows.add(target, percent(free.observed), percent(free_of_oracle.observed), met);
    let [likely, likely_of_oracle] = within(0.6..0.95);
    let off = |bin: &crate::measures::Bin| bin.observed - bin.mean;
    let target = format!("{}: stated .6 to .95, observed within .07", pair.name());
    let met = off(&likely).abs() <= 0.07;
    rows.add(
        target,
        format!("{:+.3}", off(&likely)),
        format!("{:+.3}", off(&likely_of_oracle)),
        met,
    );
}

/// No alternative ranks significantly better at this noise.
fn alternatives(answered: &Answered<'_>, pair: Pair, std: f64, rows: &mut Rows) {
    let keep = |q: &Question| Answered::is_of(pair, Kind::Ordinary)(q) && q.condition.std == std;
    let better = |name: &&&str| {
        let judged = Judged::pick(answered.answers, &[name, OURS], keep);
        let difference = judged.measure(&[Measure::Auc]).difference(name, OURS, Measure::Auc);
        difference.is_some_and(|d| d.value > 0.0 && d.excludes_zero())
    };
    let better: Vec<&str> = answered.alternatives.iter().filter(better).copied().collect();
    let (best, auc) = answered.best_alternative(keep);
    let ours = Judged::pick(answered.answers, &[OURS], keep).measure(&[Measure::Auc]);
    let reached = format!(
        "{}; best alternative {best}: {}",
        shown(ours.estimate(OURS, Measure::Auc)),
        shown(auc)
    );
    let target = format!("{}, {} mm: no alternative ranks better", pair.name(), 1e3 * std);
    rows.add(target, reached, "–".into(), better.is_empty());
}
