//! Figure 2: the surfaces f = 0 that separate noise-free and noisy clouds.

use anyhow::Result;
use cloudtouch::noise::SensorModel;
use cloudtouch::paper::{LeafClassifier, Scaling};
use cloudtouch::{
    PaperCloud, PaperCloudSettings, PaperModel, PaperNoise, PaperQuery, PaperSettings,
};
use cloudtouch_geom::{Point3, PointCloud, Pose, seed};

use crate::SEED;
use crate::report::{Axis, Figure, Panel, Place, Section, Series};

/// Points of each cloud: one leaf.
const POINTS: u64 = 24;
/// How wide the clouds are, m.
const WIDTH: f64 = 0.2;
/// Lines that are searched for f = 0, and steps along each.
const COLUMNS: usize = 160;
const STEPS: usize = 240;

const TEXT: &str = "Two curves in a plane, 24 points each, and where f = 0 between them (`PaperQuery::explain`). \
Where the points are exact (a, c) the robust classifier is a plain one; where they are noisy (b, d; σ \
= 2 mm, Σ + Ψ) the same points push the surface by their ellipsoids. By the covariance printed below \
eq. 8, which can only shrink, noise across a curve as thin as these would count for next to nothing.";

pub(super) fn section() -> Result<Section> {
    let cases = [
        ("a: noise-free, apart", 0.02, 0.0),
        ("b: noisy, apart", 0.02, 0.002),
        ("c: noise-free, crossing", -0.006, 0.0),
        ("d: noisy, crossing", -0.006, 0.002),
    ];
    let panels = cases.into_iter().map(|(title, gap, std)| panel(title, gap, std));
    let figure = Figure::new(
        "Green is where the classifier parts A from B (f = 0)",
        panels.collect::<Result<Vec<_>>>()?,
    );
    Ok(Section::new("Figure 2: surfaces").text(TEXT).figure(
        "paper-surfaces",
        "Surfaces f = 0 between noise-free and noisy clouds",
        figure,
    ))
}

fn panel(title: &str, gap: f64, std: f64) -> Result<Panel> {
    let clouds = [curve(0, gap), curve(1, gap)];
    // Noise-free points have neither Σ nor, here, Ψ: that is what (a) and (c) show.
    let noise = if std > 0.0 { PaperNoise::Convolution } else { PaperNoise::Precision };
    let by = PaperCloudSettings {
        model: PaperModel { noise, ..PaperModel::default() },
        ..PaperCloudSettings::new(SensorModel::Isotropic { std })
    };
    let [a, b] = clouds.each_ref().map(|cloud| PaperCloud::prepare(cloud, &by));
    let settings =
        PaperSettings { scaling: Scaling::LeafPair, stop_above: 1.0, ..PaperSettings::default() };
    let (_, all) = PaperQuery::new(settings)?.explain(&a?, &b?, &Pose::identity())?;
    let zeros = all.first().map(zeros);
    // Where the ellipsoids of both sides cover one another w = 0 is best, and f says nothing.
    let none = if zeros.is_none() { ": nothing separates" } else { "" };
    let places =
        |cloud: &PointCloud| cloud.points.iter().map(|p| in_mm(p.x, p.z)).collect::<Vec<_>>();
    let [a, b, f] = if gap > 0.0 {
        [(20.0, 50.0), (17.0, 28.0), (-92.0, 19.0)]
    } else {
        [(30.0, 21.0), (38.0, 0.0), (-45.0, 51.0)]
    };
    let surface = Series { size: 1, ..Series::points("f = 0", zeros.unwrap_or_default()) };
    Ok(Panel {
        title: format!("{title}{none}"),
        x: Axis::linear("x (mm)"),
        y: Axis::linear("z (mm)"),
        series: vec![
            Series::points("A", places(&clouds[0])).named_at(a.0, a.1),
            Series::points("B", places(&clouds[1])).named_at(b.0, b.1),
            surface.named_at(f.0, f.1),
        ],
    })
}

/// A wide bump (A) so far above a narrow one (B): their boxes overlap, and leaves meet.
fn curve(class: u64, gap: f64) -> PointCloud {
    let point = |i: u64| {
        let along = i as f64 / (POINTS - 1) as f64 - 0.5;
        let jitter = 0.002 * (seed::unit(seed::derive(SEED, class, i)) - 0.5);
        let bump = |width: f64| 0.03 * (-(along / width).powi(2)).exp();
        let z = if class == 0 { gap + bump(0.25) } else { bump(0.15) };
        Point3::new(WIDTH * along, 0.0, z + jitter)
    };
    PointCloud::from_points((0..POINTS).map(point).collect())
}

/// Where f changes its sign along upright lines.
fn zeros(classifier: &LeafClassifier) -> Vec<Place> {
    let step =
        |from: f64, to: f64, i: usize, count: usize| from + (to - from) * i as f64 / count as f64;
    let mut found = Vec::new();
    for column in 0..=COLUMNS {
        let x = step(-0.5 * WIDTH, 0.5 * WIDTH, column, COLUMNS);
        let height = |i| step(-0.02, 0.07, i, STEPS);
        let f = |z| classifier.value_and_gradient(&Point3::new(x, 0.0, z)).0;
        for i in 0..STEPS {
            let (low, high) = (f(height(i)), f(height(i + 1)));
            if (low < 0.0) != (high < 0.0) {
                let share = low / (low - high);
                found.push(in_mm(x, height(i) + share * (height(i + 1) - height(i))));
            }
        }
    }
    found
}

fn in_mm(x: f64, z: f64) -> Place {
    (1e3 * x, 1e3 * z)
}
