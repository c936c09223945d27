//! `cargo xtask calibrate`: the constants that turn evidence into a probability.

use std::{collections::BTreeMap, fs, path::Path};

use anyhow::{Context, Result};
use clap::Args;
use cloudtouch::{ContactEvidence, Mode};

use crate::{
    answers::Answers,
    measures::Logistic,
    methods::{Coefficients, Fitted, Ours},
    sweep::{Asked, ORACLE, OURS, Plan, ask},
};

/// What `cargo xtask calibrate` is given.
#[derive(Args)]
pub struct Arguments {
    /// Draws of each family
    #[arg(long, default_value_t = 4)]
    draws: u32,
    /// Poses of each draw
    #[arg(long, default_value_t = 28)]
    poses: usize,
    /// Keep the fit; what the library takes by default is changed by hand
    #[arg(long)]
    update: bool,
}

/// Fits, prints, and keeps when asked to.
///
/// # Errors
/// When a query fails, or the evidence does not determine the constants.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Arguments { draws, poses, update } = *arguments;
    let gathering = |ours: Ours| Asked::always(ours.gathering_everything());
    let methods = [gathering(Ours::new(OURS, Mode::Calibrated)?), gathering(Ours::oracle(ORACLE)?)];
    let answers = ask(&Plan::evidence(draws, poses), &methods)?;
    let folder = root.join("target/sweep");
    fs::create_dir_all(&folder)?;
    answers.write(&folder.join("evidence.jsonl"))?;
    let without_each = |method: &str| -> Result<BTreeMap<String, Coefficients>> {
        let without =
            |family: &'static str| Ok((family.to_owned(), fit(&answers, method, Some(family))?));
        answers.families().into_iter().map(without).collect()
    };
    let fitted = Fitted {
        command: format!("cargo xtask calibrate --draws {draws} --poses {poses}"),
        all: fit(&answers, OURS, None)?,
        without: without_each(OURS)?,
        oracle_without: without_each(ORACLE)?,
    };
    println!("{}", serde_json::to_string_pretty(&fitted)?);
    if update { fitted.write(root) } else { Ok(()) }
}

/// Fitted on all families but one.
fn fit(answers: &Answers, method: &str, without: Option<&str>) -> Result<Coefficients> {
    let said = answers.said(method).with_context(|| format!("{method} did not answer"))?;
    let mut records: Vec<(ContactEvidence, bool)> = Vec::new();
    for (question, said) in answers.questions.iter().zip(said) {
        if without != Some(question.family) {
            let evidence = said.and_then(|s| s.evidence).context("an answer without evidence")?;
            records.push((evidence, question.collides));
        }
    }
    let geometry = constrained(&records, |e| Some([e.crossing, e.deviations]), [1.0, -1.0])?;
    // Where the noise is as large as the patches the classifier says nothing.
    let everything = |e: &ContactEvidence| Some([e.crossing, e.deviations, e.ln_misclassified()?]);
    let all = constrained(&records, everything, [1.0, -1.0, 1.0])?;
    let (Ok(by_geometry), Ok(by_all)) = (geometry.try_into(), all.try_into()) else {
        unreachable!("an intercept and a slope for every feature");
    };
    Ok(Coefficients { by_geometry, by_all })
}

/// A fit in which every slope has the sign of its evidence: a feature that comes out the other way
/// is left out, since bounds rest on the signs.
fn constrained<const N: usize>(
    records: &[(ContactEvidence, bool)],
    features: impl Fn(&ContactEvidence) -> Option<[f64; N]>,
    signs: [f64; N],
) -> Result<Vec<f64>> {
    let (rows, truths): (Vec<[f64; N]>, Vec<bool>) =
        records.iter().filter_map(|(e, collides)| Some((features(e)?, *collides))).unzip();
    let mut used: Vec<usize> = (0..N).collect();
    loop {
        let table: Vec<Vec<f64>> =
            rows.iter().map(|row| used.iter().map(|&k| row[k]).collect()).collect();
        let [intercept, slopes @ ..] = &Logistic::fit(&table, &truths)?.coefficients[..] else {
            anyhow::bail!("a fit without an intercept");
        };
        if let Some(wrong) = used.iter().zip(slopes).position(|(&k, s)| s * signs[k] < 0.0) {
            used.remove(wrong);
            continue;
        }
        let mut all = vec![0.0; N + 1];
        all[0] = *intercept;
        used.iter().zip(slopes).for_each(|(&k, slope)| all[k + 1] = *slope);
        return Ok(all.iter().map(|v| (1e3 * v).round() / 1e3).collect());
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    #[test]
    fn a_feature_that_counts_the_wrong_way_is_left_out() {
        let unit = |i: u64, k: u64| seed::unit(seed::derive(7, i, k));
        let drawn = |sign: f64| -> Vec<(ContactEvidence, bool)> {
            let record = |i| {
                let [deviations, crossing] = [5.0 * unit(i, 0), 4.0 * unit(i, 1)];
                let x = sign * crossing - 0.7 * deviations;
                let collides = unit(i, 3) < 1.0 / (1.0 + (-x).exp());
                (ContactEvidence { deviations, crossing, misclassified: None }, collides)
            };
            (0..3000).map(record).collect()
        };
        let fit = |sign| {
            constrained(&drawn(sign), |e| Some([e.crossing, e.deviations]), [1.0, -1.0]).unwrap()
        };
        assert_eq!(fit(-1.0)[1], 0.0);
        assert!((fit(1.0)[1] - 1.0).abs() < 0.2 && (fit(1.0)[2] + 0.7).abs() < 0.15);
    }
}
