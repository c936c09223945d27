//! The figure: answers to fixed poses while noise is added, and how often verdicts flip.

use std::path::Path;

use anyhow::Result;

use crate::{
    common::{
        draw::{Axis, Style},
        statistics::quantile,
    },
    sweep::{
        measures::Estimate,
        plots::lines::{Panel, Point, Series, draw, range_of},
    },
};

/// Answers of several methods to one pose.
#[derive(Debug, Clone)]
pub(super) struct Growth {
    /// Which pose.
    pub(super) title: String,
    /// For each method, for each added noise (mm): the answers under several draws of it, a
    /// probability, or 0 and 1 of a yes-or-no method.
    pub(super) methods: Vec<Vec<(f64, Vec<f64>)>>,
}

/// Draws a panel for each pose with the mean answers and a bar from the 10th to the 90th
/// percentile of the draws, and one with the share of verdicts that flip.
///
/// Verdicts, all of them 0 or 1, have no bar: their mean says how often they are which.
///
/// `flips` has one line for each method over the added noise (mm).
///
/// # Errors
///
/// When the file cannot be written.
pub(super) fn growth(
    path: &Path,
    methods: &[&str],
    poses: &[Growth],
    flips: &[Vec<(f64, Estimate)>],
) -> Result<()> {
    let noises = poses.iter().flat_map(|p| &p.methods).flatten().map(|level| level.0);
    let x = range_of(noises.chain(flips.iter().flatten().map(|level| level.0)));
    let x = Axis::new("std of the added noise (mm)", x, 0);
    let mut panels: Vec<Panel> = poses
        .iter()
        .map(|pose| Panel {
            title: pose.title.clone(),
            x: x.clone(),
            y: Axis::unit("collision probability or verdict"),
            guides: Vec::new(),
            series: lines(pose.methods.iter().map(|levels| curve(levels))),
        })
        .collect();
    let point = |&(x, e): &(f64, Estimate)| Point { x, y: e.value, range: Some([e.low, e.high]) };
    let highest = flips.iter().flatten().map(|(_, e)| e.high).fold(0.1, f64::max);
    panels.push(Panel {
        title: "verdicts that flip from draw to draw".into(),
        x,
        y: Axis::new("share of verdict changes", -0.01..1.05 * highest, 2),
        guides: Vec::new(),
        series: lines(flips.iter().map(|levels| levels.iter().map(point))),
    });
    let names: Vec<(String, Style)> = methods
        .iter()
        .enumerate()
        .map(|(number, name)| ((*name).to_owned(), Style::of_series(number)))
        .collect();
    draw(path, 2, &panels, &names)
}

fn lines<Points: Iterator<Item = Point>>(methods: impl Iterator<Item = Points>) -> Vec<Series> {
    let line = |(number, points): (usize, Points)| Series {
        style: Style::of_series(number),
        points: points.filter(|p| p.y.is_finite()).collect(),
    };
    methods.enumerate().map(line).collect()
}

fn curve(levels: &[(f64, Vec<f64>)]) -> impl Iterator<Item = Point> {
    let are_verdicts = levels.iter().flat_map(|level| &level.1).all(|a| *a == 0.0 || *a == 1.0);
    levels.iter().map(move |(x, answers)| {
        let y = answers.iter().sum::<f64>() / answers.len() as f64;
        let range = [0.1, 0.9].map(|share| quantile(answers, share));
        Point { x: *x, y, range: (!are_verdicts).then_some(range) }
    })
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::{super::flips::flips, *};
    use crate::sweep::{measures::Bootstrap, plots::lines::tests::drawn};

    #[test]
    fn a_point_is_the_mean_of_the_draws_with_their_spread() {
        let answers: Vec<f64> = (1..=10).map(|i| f64::from(i) / 10.0).collect();
        let points: Vec<Point> = curve(&[(3.0, answers)]).collect();
        assert!((points[0].y - 0.55).abs() < 1e-12);
        assert_eq!((points[0].x, points[0].range), (3.0, Some([0.1, 0.9])));
        let verdicts: Vec<Point> = curve(&[(3.0, vec![0.0, 1.0, 1.0, 1.0])]).collect();
        assert_eq!((verdicts[0].y, verdicts[0].range), (0.75, None));
    }

    #[test]
    fn poses_and_flips_have_a_panel_each() {
        let unit = |a, b| seed::unit(seed::derive(4, a, b));
        let steady = |level: u64, pose: f64| -> Vec<f64> {
            let noise = 0.01 * level as f64;
            (0..20).map(|i| (pose + noise * (unit(level, i) - 0.5)).clamp(0.0, 1.0)).collect()
        };
        let verdicts = |level: u64, pose: f64| -> Vec<f64> {
            steady(10 * level, pose).iter().map(|p| f64::from(*p >= 0.5)).collect()
        };
        let levels = [0, 2, 5, 10, 15, 20];
        let pose = |title: &str, p: f64| Growth {
            title: title.to_owned(),
            methods: vec![
                levels.iter().map(|&l| (l as f64, steady(l, p))).collect(),
                levels.iter().map(|&l| (l as f64, verdicts(l, p))).collect(),
            ],
        };
        let poses = [pose("free by 12 mm", 0.2), pose("overlap of 8 mm", 0.85)];
        let flipped = |method: usize| -> Vec<(f64, Estimate)> {
            let series = |level: usize| {
                let of_pose = |p: &Growth| {
                    p.methods[method][level].1.iter().map(|p| *p >= 0.5).collect::<Vec<bool>>()
                };
                poses.iter().map(of_pose).collect::<Vec<_>>()
            };
            (0..levels.len())
                .map(|level| (levels[level] as f64, flips(&series(level), Bootstrap::new(1))))
                .collect()
        };
        let flipped = [flipped(0), flipped(1)];
        let svg = drawn("growth", |path| growth(path, &["ours", "voxels 1 cm"], &poses, &flipped));
        assert_eq!(svg.matches("std of the added noise (mm)").count(), 3);
        // The first series and its legend are circles, the second squares.
        assert_eq!(svg.matches("<circle").count(), 3 * levels.len() + 1);
        assert_eq!(svg.matches("<polygon").count(), 3 * levels.len() + 1);
    }
}
