//! Sampled piano against sampled room, where the exact answer of every pose is known.

use std::path::Path;

use anyhow::Result;
use cloudtouch::{Mode, noise::SensorModel};
use cloudtouch_geom::{PointCloud, TriangleMesh, seed};
use cloudtouch_io::{LengthUnit, read_mesh};
use cloudtouch_testkit::{
    noise::{NoiseKind, add_noise},
    surface::{area, positions, sample_surface},
};

use super::cases::{self, Labelled};
use crate::{
    either::{EitherCloud, EitherQuery},
    figure::{Axis, Figure, Panel, Series, palette},
    measures::{Sample, auc, brier},
    page::Section,
    table::Table,
};

/// All randomness of the samples comes from this.
pub(super) const SEED: u64 = 2011;
/// Mean spacing (root of area per point) of piano and room, and noise, m: fine samples, then about
/// 10,000 and 40,000 points; little and much noise.
const SAMPLES: [[f64; 3]; 4] =
    [[0.03, 0.04, 0.002], [0.03, 0.04, 0.01], [0.024, 0.071, 0.002], [0.024, 0.071, 0.01]];
const MODES: [(Mode, &str); 2] = [(Mode::Calibrated, "calibrated"), (Mode::Paper, "paper")];
/// Poses with a smaller distance or depth are hard, mm.
const NEAR: f64 = 50.0;

/// A pose with the probability of a collision.
type Answer<'a> = (&'a Labelled, f64);

pub(super) fn evaluate(data: &Path) -> Result<(Section, Vec<String>)> {
    let cases = cases::read(&data.join("piano_cases.json"))?;
    let mesh = |path| read_mesh(path, LengthUnit::Metres);
    let (room, piano) = (mesh(&cases[0].scene)?, mesh(&cases[0].object)?);
    let mut scores = Table::new([
        "spacing of piano and room, noise (mm)",
        "mode",
        "right at P = 0.5",
        "of those near",
        "collision: P > 0.9",
        "collision: P < 0.1",
        "apart: P < 0.1",
        "apart: P > 0.9",
        "AUC",
        "Brier",
    ]);
    let mut failures = Vec::new();
    let mut figure = Figure::new("Piano in the room: collision probability by exact distance");
    for (number, [of_piano, of_room, noise]) in SAMPLES.into_iter().enumerate() {
        let clouds = [
            noisy(&room, of_room, noise, seed::derive(SEED, 1, 0)),
            noisy(&piano, of_piano, noise, seed::derive(SEED, 2, 0)),
        ];
        for (mode, mode_name) in MODES {
            let sensor = SensorModel::Isotropic { std: noise };
            let [room, piano] =
                clouds.each_ref().map(|cloud| EitherCloud::prepare(cloud, sensor, mode));
            let (room, piano, query) = (room?, piano?, EitherQuery::new(mode));
            let mut answers: Vec<Answer> = Vec::new();
            for case in &cases {
                match query.run(&room, &piano, &case.pose) {
                    Ok(report) => answers.push((case, report.collision_probability)),
                    Err(error) => failures.push(format!("piano {}: no answer: {error}", case.id)),
                }
            }
            let [of_piano, of_room, noise] = [of_piano, of_room, noise].map(|length| 1e3 * length);
            let name = format!("{of_piano:.0} and {of_room:.0}, {noise:.0}");
            scores.row([name, mode_name.to_owned()].into_iter().chain(score(&answers)));
            if number < 2 {
                figure =
                    figure.panel(panel(&format!("{mode_name}, noise {noise:.0} mm"), &answers));
            }
        }
    }
    let text = format!(
        "{} poses, {} in collision, of a piano in a room, both open triangle meshes. Both are \
         sampled with equal share per area, one point in each of equally large pieces; the spacing \
         is the root of the area per point. Gaussian noise is added to every coordinate and stated \
         to the sensor model. Near means a distance or depth below {NEAR} mm. The signed distance \
         of a collision is minus the shortest translation found that ends it: an upper bound on \
         the depth. Checked: every pose has an answer.",
        cases.len(),
        cases.iter().filter(|case| collides(case)).count(),
    );
    let section = Section::new("Piano in the room, exact answers")
        .text(text)
        .figure("piano", "Probability against signed distance", figure)
        .text(scores);
    Ok((section, failures))
}

fn collides(case: &Labelled) -> bool {
    case.label == "collision"
}

/// Samples with the given mean spacing and Gaussian noise, m.
fn noisy(mesh: &TriangleMesh, spacing: f64, noise: f64, seed: u64) -> PointCloud {
    let count = (area(mesh) / spacing.powi(2)).round() as usize;
    let samples = positions(&sample_surface(mesh, count, seed));
    let noise = add_noise(&samples, NoiseKind::Gaussian, noise, seed::derive(seed, 0, 1));
    PointCloud::from_points(noise)
}

/// From "right" to the end of the table.
fn score(answers: &[Answer]) -> [String; 8] {
    let right = |of: &dyn Fn(&Labelled) -> bool| {
        let of = answers.iter().filter(|(case, _)| of(case));
        format!(
            "{} of {}",
            of.clone().filter(|(c, p)| (*p >= 0.5) == collides(c)).count(),
            of.count()
        )
    };
    let count = |truth: bool, keep: fn(f64) -> bool| {
        let of = answers.iter().filter(|(case, _)| collides(case) == truth);
        format!("{} of {}", of.clone().filter(|(_, p)| keep(*p)).count(), of.count())
    };
    let sample = Sample::of_probabilities(answers.iter().map(|(case, p)| (*p, collides(case))));
    [
        right(&|_| true),
        right(&|case| case.distance_mm.abs() < NEAR),
        count(true, |p| p > 0.9),
        count(true, |p| p < 0.1),
        count(false, |p| p < 0.1),
        count(false, |p| p > 0.9),
        format!("{:.3}", auc(&sample, &sample.ones())),
        format!("{:.3}", brier(&sample, &sample.ones())),
    ]
}

fn panel(title: &str, answers: &[Answer]) -> Panel {
    let dots = |truth: bool| {
        let of = answers.iter().filter(move |(case, _)| collides(case) == truth);
        of.map(|(case, p)| (case.distance_mm, *p))
    };
    Panel::new(Axis::linear("signed distance (mm)"), Axis::unit("collision probability"))
        .title(title)
        .series(Series::guide([(0.0, 0.0), (0.0, 1.0)]))
        .series(Series::points("apart", dots(false)).color(palette::BLUE).opacity(0.65))
        .series(Series::points("collision", dots(true)).color(palette::VERMILION).opacity(0.65))
}
