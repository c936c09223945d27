//! The tables of the document: pooled, by family, by noise, and for dense clouds.

use std::path::Path;

use anyhow::Result;
use cloudtouch_testkit::{noise::NoiseKind, poses::NEAR};

use super::{
    OURS, SEED,
    measures::{Bootstrap, Judged, Measure, Row, chance_error, measure, write_csv, write_json},
    plan::{DENSE, POINTS, STDS},
    record::{Answers, Condition, Truth},
};
use crate::common::table::Table;

/// A titled part of the document.
pub(super) struct Section {
    pub title: String,
    /// Markdown.
    pub text: String,
}

/// The measures shown; the files hold them all.
const SHOWN: [Measure; 6] = [
    Measure::Auc,
    Measure::Brier,
    Measure::LogLoss,
    Measure::CalibrationError,
    Measure::FalseStops(0.01),
    Measure::FalseStops(0.05),
];

/// Whether a condition is one of those that results are pooled over.
pub(super) fn is_pooled(condition: &Condition) -> bool {
    POINTS.contains(&condition.points) && condition.noise == NoiseKind::Gaussian
}

/// Whether a pose is hard.
pub(super) fn is_near(truth: &Truth) -> bool {
    truth.signed_distance.abs() < NEAR
}

/// The names of the methods, in the order of the answers.
pub(super) fn methods(answers: &Answers) -> Vec<&str> {
    let first = answers.blocks().first();
    first.map_or(Vec::new(), |b| b.methods.iter().map(|(name, _)| name.as_str()).collect())
}

/// All tables; writes all measures of the same groups to `folder` as measures.csv and .json.
pub(super) fn sections(answers: &Answers, folder: &Path) -> Result<Vec<Section>> {
    let mut rows: Vec<Row> = Vec::new();
    let mut sections = Vec::new();
    let mut pooled = |title: &str, keep: &dyn Fn(&Condition) -> bool, differences: bool| {
        let text = [("all poses", false), ("poses within 3 cm of contact", true)]
            .map(|(which, near)| {
                let judged = Judged::pick(answers, &methods(answers), |condition, truth| {
                    keep(condition) && (!near || is_near(truth))
                });
                group(&format!("{title}, {which}"), &judged, differences, &mut rows)
            })
            .concat();
        sections.push(Section { title: title.to_owned(), text });
    };
    pooled("All families, noises and densities", &is_pooled, true);
    for std in STDS {
        let title = format!("Noise {:.0} mm", 1e3 * std);
        pooled(&title, &|c| is_pooled(c) && c.std == std, false);
    }
    pooled("Dense clouds (40,000 points, 2 mm)", &|c| c.points == DENSE, false);
    pooled(
        "Heavy-tailed noise (10,000 points, 5 mm)",
        &|c| c.noise == NoiseKind::HeavyTailed,
        false,
    );
    for family in answers.families() {
        pooled(&format!("Family {family}"), &|c| is_pooled(c) && c.family == family, false);
    }
    write_csv(&folder.join("measures.csv"), &rows)?;
    write_json(&folder.join("measures.json"), &rows)?;
    sections.push(times(answers));
    Ok(sections)
}

fn group(title: &str, judged: &Judged, differences: bool, rows: &mut Vec<Row>) -> String {
    let (count, collisions) = judged.counts();
    let names = judged.methods.iter().map(|(name, _)| name.clone());
    let samples: Vec<_> = names.zip(judged.samples()).collect();
    let all = measure(&samples, &Measure::ALL, &judged.clusters, Bootstrap::new(SEED));
    rows.extend(all.rows(title, (count, collisions), OURS));
    let mut text = format!("{title}: {count} answers, {collisions} of them collisions.");
    let ours = samples.iter().find(|(name, _)| name == OURS);
    if let Some(chance) = ours.and_then(|(_, s)| chance_error(s, &judged.clusters, SEED)) {
        text += &format!(
            " A perfect forecaster of the probabilities of `{OURS}` would have an ECE of {:.3}.",
            chance.mean
        );
    }
    text += &format!("\n\n{}\n", all.table(&SHOWN));
    if differences {
        text +=
            &format!("\nThe same, minus `{OURS}`:\n\n{}\n", all.differences_table(OURS, &SHOWN));
    }
    text
}

fn times(answers: &Answers) -> Section {
    let methods = methods(answers);
    let judged = Judged::pick(answers, &methods, |c, _| c.points == 10_000);
    let mut table = Table::new(&["method", "median (ms)", "p95 (ms)"]);
    for method in methods {
        let of = |share| format!("{:.2}", judged.query_ms(method, share));
        table.row([method.to_owned(), of(0.5), of(0.95)]);
    }
    Section {
        title: "Time of a query".into(),
        text: format!(
            "10,000 points, first query of fresh clouds, so with the noise model of the leaves \
             visited; two queries at a time.\n\n{table}\n"
        ),
    }
}
