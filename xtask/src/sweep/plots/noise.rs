//! Accuracy against noise, a line for each method.

use std::path::Path;

use anyhow::Result;

use super::lines::{Panel, Point, Series, draw, range_of};
use crate::{
    common::draw::{Axis, Style},
    sweep::{
        measures::{Bootstrap, Judged, Measure, measure},
        record::{Answers, Condition},
    },
};

/// A titled group of conditions.
pub(crate) type Group<'a> = (&'a str, &'a dyn Fn(&Condition) -> bool);

/// Draws AUC above Brier score against the standard deviation of the noise, a column for each
/// group of conditions, with 95 % intervals; points of one noise stand side by side.
///
/// # Errors
///
/// When the file cannot be written.
pub(crate) fn noise(
    path: &Path,
    answers: &Answers,
    methods: &[&str],
    groups: &[Group<'_>],
    bootstrap: Bootstrap,
) -> Result<()> {
    let rows = [(Measure::Auc, "AUC"), (Measure::Brier, "Brier score")];
    let mut panels: Vec<Panel> = Vec::new();
    for (measured, name) in rows {
        let mut of_row = Vec::new();
        for (title, keep) in groups {
            let series = lines(answers, methods, *keep, measured, bootstrap);
            of_row.push(((*title).to_owned(), series));
        }
        // One scale in a row, so that groups compare.
        let points = || of_row.iter().flat_map(|(_, s)| s).flat_map(|s: &Series| &s.points);
        let y = range_of(points().flat_map(|p| p.range.unwrap_or([p.y; 2])));
        let x = range_of(points().map(|p| p.x));
        for (_, series) in &mut of_row {
            set_apart(series, 0.008 * (x.end - x.start));
        }
        panels.extend(of_row.into_iter().map(|(title, series)| Panel {
            title,
            x: Axis::new("std of the noise (mm)", x.clone(), 0),
            y: Axis::new(name, y.clone(), 2),
            guides: Vec::new(),
            series,
        }));
    }
    let names: Vec<(String, Style)> = methods
        .iter()
        .enumerate()
        .map(|(number, name)| ((*name).to_owned(), Style::of_series(number)))
        .collect();
    draw(path, groups.len().max(1), &panels, &names)
}

/// One line for each method over the noises of these conditions.
fn lines(
    answers: &Answers,
    methods: &[&str],
    keep: impl Fn(&Condition) -> bool,
    measured: Measure,
    bootstrap: Bootstrap,
) -> Vec<Series> {
    let of_group = answers.blocks().iter().map(|b| &b.condition).filter(|c| keep(c));
    let mut stds: Vec<f64> = of_group.map(|c| c.std).collect();
    stds.sort_by(f64::total_cmp);
    stds.dedup();
    let mut series: Vec<Series> = (0..methods.len())
        .map(|number| Series { style: Style::of_series(number), points: Vec::new() })
        .collect();
    for std in stds {
        let judged = Judged::pick(answers, methods, |c, _| keep(c) && c.std == std);
        let samples: Vec<_> =
            methods.iter().map(|m| (*m).to_owned()).zip(judged.samples()).collect();
        let result = measure(&samples, &[measured], &judged.clusters, bootstrap);
        for (line, method) in series.iter_mut().zip(methods) {
            let estimate = result.estimate(method, measured).filter(|e| !e.value.is_nan());
            line.points.extend(estimate.map(|e| Point {
                x: 1e3 * std,
                y: e.value,
                range: Some([e.low, e.high]),
            }));
        }
    }
    series
}

/// Moves each line a little to the side, so that their bars do not hide one another.
fn set_apart(series: &mut [Series], step: f64) {
    let middle = 0.5 * (series.len() as f64 - 1.0);
    for (number, line) in series.iter_mut().enumerate() {
        line.points.iter_mut().for_each(|p| p.x += step * (number as f64 - middle));
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{lines::tests::drawn, samples},
        *,
    };

    #[test]
    fn lines_have_a_point_for_each_noise_and_a_method_without_probabilities_no_brier() {
        let answers = samples::answers(60);
        let bootstrap = Bootstrap { resamples: 50, seed: 1 };
        let methods = ["ours", "rival"];
        let auc = lines(&answers, &methods, |_| true, Measure::Auc, bootstrap);
        let brier = lines(&answers, &methods, |_| true, Measure::Brier, bootstrap);
        let count = |series: &[Series]| series.iter().map(|s| s.points.len()).collect::<Vec<_>>();
        assert_eq!((count(&auc), count(&brier)), (vec![5, 5], vec![5, 0]));
        assert!(auc[0].points[0].y > auc[0].points[4].y, "more noise, less order");
        let groups: [Group; 2] =
            [("family a", &|c| c.family == "a"), ("family b", &|c| c.family == "b")];
        let svg = drawn("noise", |path| noise(path, &answers, &methods, &groups, bootstrap));
        assert_eq!(svg.matches("std of the noise (mm)").count(), 4);
        // Five circles in each panel and one in the legend.
        assert_eq!(svg.matches("<circle").count(), 4 * 5 + 1);
    }
}
