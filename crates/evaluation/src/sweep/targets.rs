//! What is aimed at on ordinary scenes, and whether it is reached.

use super::judged::Judged;
use super::plan::STDS;
use super::tables::{is_near, ordinary};
use super::{ORACLE, OURS};
use crate::answers::{Answers, Pair, Question, Said};
use crate::measures::{Bin, Measure, observed_within};
use crate::report::{Section, Target, targets};
use crate::statistics::share;

/// What should be reached on the ordinary families together: of which pair, whether only near
/// contact, the measure with its name, its limit, and up to which noise, m.
type Limit = (Pair, bool, (&'static str, Measure), f64, f64);

const LIMITS: [Limit; 7] = [
    (Pair::CloudCloud, false, ("AUC", Measure::Auc), 0.96, 0.02),
    (Pair::CloudCloud, true, ("AUC", Measure::Auc), 0.86, 0.02),
    (Pair::CloudCloud, false, ("Brier", Measure::Brier), 0.08, 0.02),
    (Pair::CloudCloud, false, ("ECE", Measure::CalibrationError), 0.03, 0.02),
    (Pair::CloudMesh, false, ("AUC", Measure::Auc), 0.98, 0.01),
    (Pair::CloudMesh, true, ("AUC", Measure::Auc), 0.94, 0.01),
    (Pair::CloudMesh, false, ("ECE", Measure::CalibrationError), 0.03, 0.02),
];

/// The largest ECE of one family beyond what chance gives.
const FAMILY_ERROR: f64 = 0.045;
/// Overlaps deeper than this, m, and than so many spacings, at noise up to this, m, are to be certain
/// in so many of a hundred.
const DEEP: f64 = 0.05;
const DEEP_SPACINGS: f64 = 3.0;
const DEEP_NOISE: f64 = 0.01;
const DEEP_CERTAIN: f64 = 95.0;
/// What may collide of poses that are stated to do so with a probability below a tenth, %.
const STATED_FREE: f64 = 4.0;

/// Poses within this of contact are judged, m.
const NEAR: f64 = 0.05;
/// A clearance is right within so many of its standard deviations, in so many of a hundred.
const DEVIATIONS: f64 = 2.0;
const RIGHT: f64 = 90.0;

/// All targets.
pub(super) fn section(answers: &Answers) -> Section {
    let mut all: Vec<Target> = LIMITS.map(|limit| limited(answers, limit)).into();
    for pair in Pair::ALL {
        all.push(families(answers, pair));
        all.extend(stated(answers, pair));
        all.push(deep(answers, pair));
        all.extend(clearances(answers, pair));
        all.extend(STDS.map(|std| alternatives(answers, pair, std)));
    }
    targets::section(&all).text(format_args!(
        "On ordinary scenes. The oracle is `{OURS}` given every sampled point where it truly is \
         with the true normal: what the samples leave to be known. Every family is judged with \
         constants fitted on the others."
    ))
}

fn limited(answers: &Answers, (pair, near, (of, measure), limit, up_to): Limit) -> Target {
    let keep =
        |q: &Question| ordinary(pair)(q) && q.condition.std <= up_to && (!near || is_near(q));
    let judged = Judged::pick(answers, &[OURS, ORACLE], keep);
    let [ours, oracle] = [OURS, ORACLE].map(|method| judged.estimate(method, measure));
    // Not a number is not met.
    let (relation, met) = match measure {
        Measure::Auc => ("at least", ours.value >= limit),
        _ => ("at most", ours.value <= limit),
    };
    let (which, noise) = (if near { ", near" } else { "" }, 1e3 * up_to);
    let name = format!("{pair}{which}, up to {noise} mm: {of} {relation} {limit}");
    Target::new(name, format!("{ours}; oracle {oracle}"), met)
}

/// The family that is calibrated worst.
fn families(answers: &Answers, pair: Pair) -> Target {
    let error = |family: &'static str| {
        let keep = |q: &Question| q.family == family && ordinary(pair)(q);
        (family, Judged::pick(answers, &[OURS], keep).error_above_chance(OURS))
    };
    let all = answers.families().into_iter().map(error).filter(|(_, error)| !error.is_nan());
    let worst = all.max_by(|(_, a), (_, b)| a.total_cmp(b));
    let (family, worst) = worst.unwrap_or(("no family", f64::NAN));
    let what = format!("{pair}: ECE of every family at most {FAMILY_ERROR} above chance");
    Target::new(what, format!("{worst:.3} ({family})"), worst <= FAMILY_ERROR)
}

/// What is observed where a probability is stated.
fn stated(answers: &Answers, pair: Pair) -> [Target; 2] {
    let judged = Judged::pick(answers, &[OURS], ordinary(pair));
    let free = 100.0 * observed_within(judged.sample(OURS), 0.0..0.1).observed;
    let what = format!("{pair}: stated below .1, at most {STATED_FREE} % collide");
    let free = Target::new(what, format!("{free:.1} %"), free <= STATED_FREE);
    let Bin { mean, observed, .. } = observed_within(judged.sample(OURS), 0.6..0.95);
    let (off, what) = (observed - mean, format!("{pair}: stated .6 to .95, observed within .07"));
    [free, Target::new(what, format!("{off:+.3}"), off.abs() <= 0.07)]
}

/// How many deep overlaps are stated to collide with certainty.
fn deep(answers: &Answers, pair: Pair) -> Target {
    let keep = |q: &Question| {
        ordinary(pair)(q)
            && q.condition.std <= DEEP_NOISE
            && q.signed_distance < -DEEP.max(DEEP_SPACINGS * q.spacing)
    };
    let judged = Judged::pick(answers, &[OURS], keep);
    let said = judged.said(OURS);
    let share = 100.0 * share(said.iter().map(|s| s.probability.is_some_and(|p| p >= 0.99)));
    let what = format!(
        "{pair}: overlaps beyond 5 cm and 3 spacings, up to 10 mm: P ≥ .99 in {DEEP_CERTAIN} %"
    );
    Target::new(what, format!("{share:.0} % of {}", said.len()), share >= DEEP_CERTAIN)
}

/// Of one kind of pair: clearances within two deviations of the truth near contact, and lower bounds.
fn clearances(answers: &Answers, pair: Pair) -> [Target; 2] {
    let judged = Judged::pick(answers, &[OURS], |q: &Question| {
        ordinary(pair)(q) && q.signed_distance.abs() <= NEAR
    });
    let truths = judged.questions().iter().map(|q| q.signed_distance);
    let all: Vec<(&Said, f64)> = judged.said(OURS).iter().zip(truths).collect();
    let told: Vec<bool> = all.iter().filter_map(|(said, truth)| is_right(said, *truth)).collect();
    let right = 100.0 * share(told.iter().copied());
    let what = format!(
        "{pair}: within 5 cm of contact, clearance within {DEVIATIONS} deviations in {RIGHT} %"
    );
    let (count, of_all) = (told.len(), 100.0 * told.len() as f64 / all.len() as f64);
    let shown = format!("{right:.0} % of {count}; told in {of_all:.0} %");
    [Target::new(what, shown, right >= RIGHT), lower_bounds(answers, pair)]
}

/// Lower bounds, wherever there is one: near contact boxes overlap as a rule, and bound nothing.
fn lower_bounds(answers: &Answers, pair: Pair) -> Target {
    let judged = Judged::pick(answers, &[OURS], ordinary(pair));
    let all = judged.said(OURS).iter().zip(judged.questions());
    let is_above = |(said, question): (&Said, &&Question)| {
        said.clearance_at_least.map(|least| least > question.signed_distance)
    };
    let told: Vec<bool> = all.filter_map(is_above).collect();
    let above = told.iter().filter(|is_above| **is_above).count();
    let what = format!("{pair}: no lower bound on the clearance above the truth");
    Target::new(what, format!("{above} of {}", told.len()), above == 0 && !told.is_empty())
}

/// Whether the truth is where a clearance says, or deeper where it says so; `None` where it says
/// nothing.
fn is_right(said: &Said, truth: f64) -> Option<bool> {
    let clearance = said.clearance?;
    let (off, allowed) = (truth - clearance.mean, DEVIATIONS * clearance.std);
    Some(off <= allowed && (clearance.is_bound || off >= -allowed))
}

/// No alternative ranks significantly better at this noise.
fn alternatives(answers: &Answers, pair: Pair, std: f64) -> Target {
    let keep = |q: &Question| ordinary(pair)(q) && q.condition.std == std;
    let is_better = |name: &str| {
        let judged = Judged::pick(answers, &[name, OURS], keep);
        judged.difference(name, OURS, Measure::Auc).low > 0.0
    };
    let (best, auc) = answers.best_alternative(keep);
    let ours = answers.auc(OURS, keep);
    let reached = format!("{ours}; best alternative {best}: {auc}");
    let what = format!("{pair}, {} mm: no alternative ranks better", 1e3 * std);
    Target::new(what, reached, !answers.alternatives().any(is_better))
}
