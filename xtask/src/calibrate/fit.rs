//! The two logistic regressions from evidence to a probability.

use anyhow::{Context, Result};
use cloudtouch::ContactEvidence;
use serde::{Deserialize, Serialize};

use crate::sweep::{measures::fit_plainly, record::Block};

/// Coefficients as `Recalibration` has them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Coefficients {
    pub by_geometry: [f64; 3],
    pub by_all: [f64; 4],
}

/// Evidence and truth.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record {
    pub evidence: ContactEvidence,
    pub collides: bool,
}

/// The records of some blocks, each of which has answers of `method`.
pub(super) fn records<'a>(
    blocks: impl Iterator<Item = &'a Block>,
    method: &str,
) -> Result<Vec<Record>> {
    let mut all = Vec::new();
    for block in blocks {
        let said = block.said(method).with_context(|| format!("{method} did not answer"))?;
        for (said, truth) in said.iter().zip(&block.truths) {
            let evidence = said.evidence.context("an answer without evidence")?;
            all.push(Record { evidence, collides: truth.collides });
        }
    }
    Ok(all)
}

/// Fits both on all records: the second on the doubtful ones alone, where it is asked, judged other
/// families worse. A slope that would count evidence the wrong way round is left out.
pub(super) fn fit(records: &[Record]) -> Result<Coefficients> {
    let geometry = |e: &ContactEvidence| vec![e.crossing, e.deviations];
    let [intercept, crossing, deviations] = constrained(records, geometry, [1.0, -1.0])?[..] else {
        unreachable!("two features have three coefficients");
    };
    let by_geometry = [intercept, crossing, deviations];
    // Where the noise is as large as the patches the classifier says nothing.
    let is_classified = |r: &&Record| r.evidence.misclassified.is_some();
    let classified: Vec<Record> = records.iter().filter(is_classified).copied().collect();
    let all = |e: &ContactEvidence| {
        vec![e.crossing, e.deviations, e.ln_misclassified().unwrap_or(f64::NAN)]
    };
    let by_all = constrained(&classified, all, [1.0, -1.0, 1.0])?;
    let by_all = by_all.try_into().map_err(|v| anyhow::anyhow!("four coefficients, not {v:?}"))?;
    Ok(Coefficients { by_geometry, by_all })
}

/// A fit whose slopes have these signs or are zero; rounded to what is worth telling.
fn constrained<const N: usize>(
    records: &[Record],
    features: impl Fn(&ContactEvidence) -> Vec<f64>,
    signs: [f64; N],
) -> Result<Vec<f64>> {
    let truths: Vec<bool> = records.iter().map(|r| r.collides).collect();
    let mut is_used = [true; N];
    loop {
        let used = |row: Vec<f64>| -> Vec<f64> {
            row.into_iter().zip(is_used).filter(|(_, used)| *used).map(|(x, _)| x).collect()
        };
        let rows: Vec<Vec<f64>> = records.iter().map(|r| used(features(&r.evidence))).collect();
        let fit = fit_plainly(&rows, &truths)?;
        let mut slopes = fit.coefficients[1..].iter();
        let mut all = vec![rounded(fit.coefficients[0])];
        all.extend(is_used.map(|used| {
            let slope = if used { slopes.next().copied() } else { None };
            rounded(slope.unwrap_or(0.0))
        }));
        let wrong = (0..N).find(|&k| all[k + 1] * signs[k] < 0.0);
        match wrong {
            Some(k) => is_used[k] = false,
            None => return Ok(all),
        }
    }
}

fn rounded(value: f64) -> f64 {
    (1e3 * value).round() / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Collisions are half as likely per deviation and three times as likely per unit of crossing.
    fn drawn(noise_sign: f64) -> Vec<Record> {
        let unit =
            |i: u64, k: u64| cloudtouch_geom::seed::unit(cloudtouch_geom::seed::derive(7, i, k));
        (0..4000)
            .map(|i| {
                let evidence = ContactEvidence {
                    deviations: 5.0 * unit(i, 0),
                    crossing: 4.0 * unit(i, 1),
                    misclassified: Some(10.0 * unit(i, 2)),
                };
                let x = -0.7 * evidence.deviations
                    + 1.1 * evidence.crossing
                    + noise_sign * 0.5 * (10.0 * unit(i, 2) + 0.02).ln()
                    - 0.5;
                Record { evidence, collides: unit(i, 3) < 1.0 / (1.0 + (-x).exp()) }
            })
            .collect()
    }

    #[test]
    fn what_was_drawn_is_found() {
        let found = fit(&drawn(1.0)).unwrap();
        let [_, crossing, deviations, misclassified] = found.by_all;
        // Four thousand records: standard errors of about .05.
        assert!((crossing - 1.1).abs() < 0.2 && (deviations + 0.7).abs() < 0.2, "{found:?}");
        assert!((misclassified - 0.5).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn a_feature_that_counts_the_wrong_way_is_left_out() {
        assert_eq!(fit(&drawn(-1.0)).unwrap().by_all[3], 0.0);
    }
}
