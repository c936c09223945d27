//! Probability of being free against signed distance (figure 4 of the paper).

use std::path::Path;

use anyhow::{Result, ensure};

use super::lines::{Panel, Point, Series, draw, range_of};
use crate::{
    common::draw::{Axis, BLUE, Marker, Style, VERMILION},
    sweep::measures::Judged,
};

/// Points of a regression curve.
const STEPS: usize = 100;

/// Draws a panel for each group of poses, titled, with the answers of one method.
///
/// The curve is the local mean: weights fall off as a Gaussian of a standard deviation of a
/// twentieth of the axis.
///
/// # Errors
///
/// When the method gives no probabilities, or the file cannot be written.
pub(crate) fn distance(path: &Path, method: &str, groups: &[(String, &Judged)]) -> Result<()> {
    let mut dots = Vec::new();
    for (title, judged) in groups {
        dots.push((title, dots_of(judged, method)?));
    }
    let range = range_of(dots.iter().flat_map(|(_, dots)| dots).map(|dot| dot.0));
    let panels: Vec<Panel> = dots
        .iter()
        .map(|(title, dots)| {
            let of = |collides: bool| Series {
                style: style(collides),
                points: dots
                    .iter()
                    .filter(|dot| dot.2 == collides)
                    .map(|&(x, y, _)| Point { x, y, range: None })
                    .collect(),
            };
            let curve = Series { style: CURVE, points: local_mean(dots, &range) };
            Panel {
                title: (*title).clone(),
                x: Axis::new("signed distance (mm)", range.clone(), 0),
                y: Axis::unit("probability of being free"),
                guides: vec![[(0.0, -0.03), (0.0, 1.03)]],
                series: vec![curve, of(true), of(false)],
            }
        })
        .collect();
    let names = [
        ("collision".to_owned(), style(true)),
        ("free".to_owned(), style(false)),
        ("local mean".to_owned(), CURVE),
    ];
    draw(path, groups.len().clamp(1, 2), &panels, &names)
}

const CURVE: Style = Style { color: plotters::style::BLACK, line: true, marker: None };

fn style(collides: bool) -> Style {
    let (color, marker) =
        if collides { (VERMILION, Marker::Triangle) } else { (BLUE, Marker::Circle) };
    Style { color, line: false, marker: Some(marker) }
}

/// Signed distance in mm, probability of being free, truth.
type Dot = (f64, f64, bool);

fn dots_of(judged: &Judged, method: &str) -> Result<Vec<Dot>> {
    let said = judged.methods.iter().find(|(name, _)| name == method).map(|(_, said)| said);
    let dots: Vec<Dot> = judged
        .truths
        .iter()
        .zip(said.into_iter().flatten())
        .filter_map(|(t, s)| Some((1e3 * t.signed_distance, 1.0 - s.probability?, t.collides)))
        .collect();
    ensure!(dots.len() == judged.truths.len(), "{method} gives no probabilities to draw");
    Ok(dots)
}

/// Between the outermost distances, where the mean has poses to rest on.
fn local_mean(dots: &[Dot], range: &std::ops::Range<f64>) -> Vec<Point> {
    let width = (range.end - range.start) / 20.0;
    let (low, high) =
        dots.iter().fold((f64::MAX, f64::MIN), |(l, h), dot| (l.min(dot.0), h.max(dot.0)));
    if dots.is_empty() {
        return Vec::new();
    }
    (0..=STEPS)
        .map(|i| {
            let x = low + (high - low) * i as f64 / STEPS as f64;
            let (mut sum, mut total) = (0.0, 0.0);
            for &(at, p, _) in dots {
                let weight = (-0.5 * ((at - x) / width).powi(2)).exp();
                sum += weight * p;
                total += weight;
            }
            Point { x, y: sum / total, range: None }
        })
        .filter(|p| p.y.is_finite())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{
        super::{lines::tests::drawn, samples},
        *,
    };

    #[test]
    fn every_pose_is_a_point() {
        let answers = samples::answers(100);
        let [low, high] =
            [0.002, 0.02].map(|std| samples::pick(&answers, |c| c.family == "b" && c.std == std));
        let groups = [("noise 2 mm".to_owned(), &low), ("noise 20 mm".to_owned(), &high)];
        let svg = drawn("distance", |path| distance(path, "ours", &groups));
        // Free poses are circles, and so is one entry of the legend.
        let free = 2 * (low.counts().0 - low.counts().1);
        assert_eq!(svg.matches("<circle").count(), free + 1);
        assert!(svg.contains("probability of being free") && svg.contains("noise 20 mm"));
    }

    #[test]
    fn a_method_without_probabilities_is_named() {
        let judged = samples::pick(&samples::answers(10), |_| true);
        let path = std::env::temp_dir().join("never-written.svg");
        let error = distance(&path, "rival", &[("all".into(), &judged)]).unwrap_err();
        assert!(error.to_string().contains("rival"), "{error}");
    }

    #[test]
    fn the_mean_of_a_constant_is_that_constant() {
        let dots = [(-10.0, 0.25, true), (0.0, 0.25, false), (40.0, 0.25, false)];
        let curve = local_mean(&dots, &(-10.0..40.0));
        assert!(curve.iter().all(|p| (p.y - 0.25).abs() < 1e-12));
        assert_eq!((curve[0].x, curve[STEPS].x), (-10.0, 40.0));
        assert!(local_mean(&[], &(0.0..1.0)).is_empty());
    }
}
