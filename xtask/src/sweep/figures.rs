//! The figures of the document.

use std::path::Path;

use anyhow::Result;

use super::{
    OURS, SEED,
    measures::{Bootstrap, Judged, Measure, measure, reliability},
    plots::{self, Tradeoff},
    record::Answers,
    tables::{is_near, is_pooled, methods},
};

/// Queries in the figure after the paper's figure 4.
const QUERIES: usize = 100;

/// Draws all of them into a folder.
pub(super) fn draw(answers: &Answers, folder: &Path) -> Result<()> {
    let names = methods(answers);
    let all = Judged::pick(answers, &names, |c, _| is_pooled(c));
    let near = Judged::pick(answers, &names, |c, t| is_pooled(c) && is_near(t));
    let groups = [("all poses".to_owned(), &all), ("within 3 cm".to_owned(), &near)];
    plots::roc(&folder.join("sweep-roc.svg"), &groups)?;

    let of_noise = |std: f64| {
        let keep =
            |c: &super::record::Condition| is_pooled(c) && c.points == 10_000 && c.std == std;
        Judged::pick(answers, &[OURS], |c, t| keep(c) && t.signed_distance.abs() < 0.1)
            .thinned(QUERIES)
    };
    let (little, much) = (of_noise(0.002), of_noise(0.01));
    let groups = [("noise 2 mm".to_owned(), &little), ("noise 10 mm".to_owned(), &much)];
    plots::distance(&folder.join("sweep-distance.svg"), OURS, &groups)?;

    let samples = all.methods.iter().map(|(name, _)| name.clone()).zip(all.samples());
    let bins = samples
        .filter(|(name, _)| {
            [OURS, "paper", "smoothed distance", "plain SVM"].contains(&name.as_str())
        })
        .map(|(name, sample)| (name, reliability(&sample, &all.clusters)))
        .collect::<Vec<_>>();
    plots::reliability(&folder.join("sweep-reliability.svg"), "all families and noises", &bins)?;

    plots::noise(
        &folder.join("sweep-noise.svg"),
        answers,
        &names,
        &[("all families", &is_pooled)],
        Bootstrap::new(SEED),
    )?;
    plots::speed(&folder.join("sweep-speed.svg"), "median query time (ms)", &tradeoffs(&all))
}

fn tradeoffs(judged: &Judged) -> Vec<Tradeoff> {
    let names = judged.methods.iter().map(|(name, _)| name.clone());
    let samples: Vec<_> = names.zip(judged.samples()).collect();
    let wanted = [Measure::Brier, Measure::Auc];
    let measured = measure(&samples, &wanted, &judged.clusters, Bootstrap::new(SEED));
    samples
        .iter()
        .filter_map(|(name, _)| {
            Some(Tradeoff {
                name: name.clone(),
                query_ms: judged.query_ms(name, 0.5),
                brier: measured.estimate(name, Measure::Brier)?,
                auc: measured.estimate(name, Measure::Auc)?,
                is_default: name == OURS,
            })
        })
        .collect()
}
