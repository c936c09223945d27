//! ROC curves of several methods on the same poses.

use std::path::Path;

use anyhow::Result;

use super::lines::{Panel, Point, Series, draw};
use crate::{
    common::draw::{Axis, Style},
    sweep::measures::{self, Judged, Measure},
};

/// Steps of a curve smaller than this share of the figure's side cannot be seen.
const FINEST: f64 = 1.0 / 300.0;

/// Draws a panel for each group of poses, titled, with one curve for each of its methods.
///
/// All groups have the methods of the first, in the same order; the legend gives the AUC of each
/// in the order of the panels.
///
/// # Errors
///
/// When the file cannot be written.
pub(crate) fn roc(path: &Path, groups: &[(String, &Judged)]) -> Result<()> {
    let of_groups: Vec<_> = groups.iter().map(|(_, judged)| judged.samples()).collect();
    let panels: Vec<Panel> = groups
        .iter()
        .zip(&of_groups)
        .map(|((title, judged), samples)| {
            let (answers, collisions) = judged.counts();
            let series = samples.iter().enumerate().map(|(number, sample)| Series {
                style: Style { marker: None, ..Style::of_series(number) },
                points: thinned(&measures::roc(sample))
                    .map(|(x, y)| Point { x, y, range: None })
                    .collect(),
            });
            Panel {
                title: format!("{title} ({answers} answers, {collisions} collisions)"),
                x: Axis::unit("share of free poses stopped"),
                y: Axis::unit("share of collisions found"),
                guides: vec![[(0.0, 0.0), (1.0, 1.0)]],
                series: series.collect(),
            }
        })
        .collect();
    let methods = groups.first().map_or(&[][..], |(_, judged)| &judged.methods);
    let names: Vec<(String, Style)> = methods
        .iter()
        .enumerate()
        .map(|(number, (name, _))| {
            let aucs: Vec<String> = of_groups
                .iter()
                .filter_map(|samples| samples.get(number))
                .map(|s| format!("{:.3}", Measure::Auc.of(s, &s.ones())).replacen("0.", ".", 1))
                .collect();
            let style = Style { marker: None, ..Style::of_series(number) };
            (format!("{name}, AUC {}", aucs.join(" / ")), style)
        })
        .collect();
    draw(path, groups.len().max(1), &panels, &names)
}

/// The points that can be told apart in the figure, the last one among them.
fn thinned(curve: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> {
    let mut drawn: Option<(f64, f64)> = None;
    let last = curve.len().saturating_sub(1);
    curve.iter().enumerate().filter_map(move |(i, &(x, y))| {
        let is_apart = drawn.is_none_or(|(u, v)| (x - u).max(y - v) > FINEST);
        (is_apart || i == last).then(|| {
            drawn = Some((x, y));
            (x, y)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{
        super::{lines::tests::drawn, samples},
        *,
    };

    #[test]
    fn thinning_keeps_both_ends_and_what_can_be_seen() {
        let curve: Vec<(f64, f64)> = (0..=10_000).map(|i| (1e-4 * f64::from(i), 1.0)).collect();
        let thin: Vec<_> = thinned(&curve).collect();
        assert!((200..=302).contains(&thin.len()), "{}", thin.len());
        assert_eq!((thin.first(), thin.last()), (curve.first(), curve.last()));
        assert_eq!(thinned(&[]).count(), 0);
    }

    #[test]
    fn each_method_has_a_curve_and_its_areas() {
        let answers = samples::answers(100);
        let all = samples::pick(&answers, |_| true);
        let near = samples::pick_near(&answers);
        let groups = [("all poses".to_owned(), &all), ("within 3 cm".to_owned(), &near)];
        let svg = drawn("roc", |path| roc(path, &groups));
        let auc = |judged: &Judged| {
            let sample = &judged.samples()[0];
            format!("{:.3}", Measure::Auc.of(sample, &sample.ones())).replacen("0.", ".", 1)
        };
        let entry = format!("ours, AUC {} / {}", auc(&all), auc(&near));
        assert!(svg.contains(&entry), "{entry}");
        assert!(svg.contains("share of free poses stopped"));
    }
}
