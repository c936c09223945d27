//! Sampled piano against sampled room, where the exact answer of every pose is known.

use std::path::Path;

use anyhow::{Context, Result};
use cloudtouch::{Cloud, CloudSettings, Mode, Query, QuerySettings, Report, noise::SensorModel};
use cloudtouch_geom::{Point3, PointCloud};
use cloudtouch_io::{LengthUnit, read_mesh};

use super::{
    cases::{self, Labelled},
    samples::{Meeting, Sampled, Sampling},
};
use crate::{
    figure::{Axis, Figure, Panel, Series, palette},
    measures::{auc, brier},
    page::Section,
    table::{Table, probability},
};

/// All randomness of the samples comes from this.
pub(super) const SEED: u64 = 2011;
/// Fine samples, then about 10,000 and 40,000 points; little and much noise.
const SAMPLINGS: [Sampling; 4] = [
    Sampling { piano_spacing: 0.03, room_spacing: 0.04, noise: 0.002 },
    Sampling { piano_spacing: 0.03, room_spacing: 0.04, noise: 0.01 },
    Sampling { piano_spacing: 0.024, room_spacing: 0.071, noise: 0.002 },
    Sampling { piano_spacing: 0.024, room_spacing: 0.071, noise: 0.01 },
];
const MODES: [(Mode, &str); 2] = [(Mode::Calibrated, "calibrated"), (Mode::Paper, "paper")];
/// Poses with a smaller distance or depth are hard, m.
const NEAR: f64 = 0.05;
/// With fewer points of the piano within one spacing of the room, hardly anything is seen of the
/// place where they meet.
const FEW: usize = 50;

/// One pose with its truth and the answer to it.
struct Judged<'a> {
    case: &'a Labelled,
    report: Report,
}

impl Judged<'_> {
    fn collides(&self) -> bool {
        self.case.label == "collision"
    }

    fn p(&self) -> f64 {
        self.report.collision_probability
    }

    fn is_right(&self) -> bool {
        (self.p() >= 0.5) == self.collides()
    }
}

pub(super) fn evaluate(_root: &Path, data: &Path) -> Result<(Section, Vec<String>)> {
    let cases = cases::read(&data.join("piano_cases.json"))?;
    let first = cases.first().context("piano_cases.json has no cases")?;
    let [room, piano] = [&first.scene, &first.object].map(|p| read_mesh(p, LengthUnit::Metres));
    let (room, piano) = (room?, piano?);
    let mut scores = Table::new([
        "samples",
        "mode",
        "poses",
        "right at P = 0.5",
        "collision: P > 0.9",
        "collision: P < 0.1",
        "apart: P < 0.1",
        "apart: P > 0.9",
        "AUC",
        "Brier",
    ]);
    let mut wrong = Table::new([
        "samples",
        "mode",
        "pose",
        "signed distance (mm)",
        "P",
        "smallest gap of points (mm)",
        "piano points near",
        "what is visible",
    ]);
    let mut failures = Vec::new();
    let mut panels = Vec::new();
    for sampling in SAMPLINGS {
        let sampled = sampling.draw(&room, &piano, SEED);
        for (mode, mode_name) in MODES {
            let judged = ask(&sampled, &sampling, mode, &cases, &mut failures)?;
            let name = [sampling.to_string(), mode_name.to_owned()];
            let near = |j: &&Judged| j.case.distance.abs() < NEAR;
            for (which, poses) in
                [("all", judged.iter().collect()), ("near", judged.iter().filter(near).collect())]
            {
                let poses: Vec<&Judged> = poses;
                let which = format!("{which} ({})", poses.len());
                scores.row(name.iter().cloned().chain([which]).chain(score(&poses)));
            }
            for judged in judged.iter().filter(|j| !j.is_right()) {
                let row = explained(judged, &sampled, &sampling);
                wrong.row(name.iter().cloned().chain(row));
            }
            if sampling.room_spacing == SAMPLINGS[0].room_spacing {
                let title = format!("{mode_name}, noise {:.0} mm", 1e3 * sampling.noise);
                panels.push(panel(&title, &judged));
            }
        }
    }
    let figure = panels.into_iter().fold(
        Figure::new("Piano in the room: collision probability against the exact distance"),
        Figure::panel,
    );
    let section = Section::new("Piano in the room, exact answers")
        .text(introduction(&cases))
        .figure("piano", "Probability against signed distance", figure)
        .text(scores)
        .text("The poses on the wrong side of one half:")
        .text(wrong);
    Ok((section, failures))
}

fn introduction(cases: &[Labelled]) -> String {
    format!(
        "{} poses, {} in collision, of a piano in a room, both open triangle meshes. Both are \
         sampled with equal share per area, one point in each of equally large pieces; the spacing \
         is the root of the area per point. Gaussian noise is added to every coordinate and stated \
         to the sensor model. Near means a distance or depth below {:.0} mm. The signed distance of \
         a collision is minus the shortest translation found that ends it: an upper bound on the \
         depth. \"Piano points near\" counts those within the room's spacing of a point of the room \
         (few: below {FEW}). Checked: every pose has an answer.",
        cases.len(),
        cases.iter().filter(|case| case.label == "collision").count(),
        1e3 * NEAR,
    )
}

/// Answers beside the truth; a missing answer is a failure.
fn ask<'a>(
    sampled: &Sampled,
    sampling: &Sampling,
    mode: Mode,
    cases: &'a [Labelled],
    failures: &mut Vec<String>,
) -> Result<Vec<Judged<'a>>> {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: sampling.noise }, mode);
    let prepare =
        |points: &[Point3]| Cloud::prepare(&PointCloud::from_points(points.to_vec()), &settings);
    let (room, piano) = (prepare(&sampled.room)?, prepare(&sampled.piano)?);
    let query = Query::new(QuerySettings::new(mode))?;
    let mut judged = Vec::new();
    for case in cases {
        match query.run(&room, &piano, &case.scene_from_object) {
            Ok(report) => judged.push(Judged { case, report }),
            Err(error) => failures.push(format!("piano {}: no answer: {error}", case.id)),
        }
    }
    Ok(judged)
}

/// From "right" to the end of the table.
fn score(poses: &[&Judged]) -> [String; 7] {
    let scored: Vec<(f64, bool)> = poses.iter().map(|j| (j.p(), j.collides())).collect();
    let right = poses.iter().filter(|j| j.is_right()).count();
    let of = |collides: bool, keep: fn(f64) -> bool| {
        let p = scored.iter().filter(|scored| scored.1 == collides).map(|scored| scored.0);
        format!("{} of {}", p.clone().filter(|p| keep(*p)).count(), p.count())
    };
    [
        format!("{right} of {}", poses.len()),
        of(true, |p| p > 0.9),
        of(true, |p| p < 0.1),
        of(false, |p| p < 0.1),
        of(false, |p| p > 0.9),
        format!("{:.3}", auc(&scored)),
        format!("{:.3}", brier(&scored)),
    ]
}

/// A pose on the wrong side of one half with what is visible of the reason.
fn explained(judged: &Judged, sampled: &Sampled, sampling: &Sampling) -> [String; 6] {
    let meeting = sampled.meeting(&judged.case.scene_from_object, sampling.room_spacing);
    [
        judged.case.id.clone(),
        format!("{:+.1}", 1e3 * judged.case.distance),
        probability(judged.p()),
        format!("{:.1}", 1e3 * meeting.gap),
        meeting.points.to_string(),
        reason(judged.collides(), judged.case.distance, &meeting, sampling).to_owned(),
    ]
}

/// What of the sampling explains a wrong answer, if anything does.
fn reason(collides: bool, distance: f64, meeting: &Meeting, sampling: &Sampling) -> &'static str {
    // The error of a difference of two points.
    let noise = std::f64::consts::SQRT_2 * sampling.noise;
    match (collides, distance.abs()) {
        (_, size) if size < noise => "smaller than the noise",
        (true, size) if size < sampling.piano_spacing => "overlap smaller than either spacing",
        (true, size) if size < sampling.room_spacing => "overlap smaller than the room's spacing",
        (true, _) if meeting.points < FEW => "few samples where they meet",
        (false, size) if size < 0.5 * sampling.room_spacing => {
            "gap smaller than half the room's spacing"
        }
        _ => "not explained by noise or spacing",
    }
}

fn panel(title: &str, judged: &[Judged]) -> Panel {
    let dots = |collides: bool| {
        let of = judged.iter().filter(|j| j.collides() == collides);
        of.map(|j| (1e3 * j.case.distance, j.p())).collect::<Vec<_>>()
    };
    Panel::new(Axis::linear("signed distance (mm)"), Axis::unit("collision probability"))
        .title(title)
        .series(Series::guide([(0.0, 0.0), (0.0, 1.0)]))
        .series(Series::points("apart", dots(false)).color(palette::BLUE).opacity(0.65))
        .series(Series::points("collision", dots(true)).color(palette::VERMILION).opacity(0.65))
}

impl std::fmt::Display for Sampling {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [piano, room, noise] =
            [self.piano_spacing, self.room_spacing, self.noise].map(|length| 1e3 * length);
        write!(out, "spacing {piano:.0} and {room:.0} mm, noise {noise:.0} mm")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_follow_from_sizes() {
        for (collides, distance, points, start) in [
            (true, -0.002, 9, "smaller than the noise"),
            (true, -0.02, 90, "overlap smaller than either"),
            (true, -0.035, 90, "overlap smaller than the room"),
            (true, -0.5, 9, "few samples"),
            (true, -0.5, 90, "not explained"),
            (false, 0.01, 9, "gap smaller"),
            (false, 0.5, 9, "not explained"),
        ] {
            let meeting = Meeting { gap: 0.0, points };
            let found = reason(collides, distance, &meeting, &SAMPLINGS[0]);
            assert!(found.starts_with(start), "{distance}: {found}");
        }
    }
}
