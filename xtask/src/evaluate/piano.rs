//! Sampled piano against sampled room, where the exact answer of every pose is known.

use std::fmt::Write as _;

use anyhow::Result;
use cloudtouch_io::{LengthUnit, read_mesh};

use super::{
    Places, Section,
    case_file::{Case, CaseFile},
    chart,
    piano_data::{Meeting, Sampled, Sampling},
    tool::{Answer, Batch, Tool},
};
use crate::common::{
    statistics::{auc, brier, quantile},
    table::{Table, bounds, probability},
};

/// Fine samples, then about 10,000 and 40,000 points; little and much noise.
const SAMPLINGS: [Sampling; 4] = [
    Sampling { piano_spacing: 0.03, room_spacing: 0.04, noise: 0.002 },
    Sampling { piano_spacing: 0.03, room_spacing: 0.04, noise: 0.01 },
    Sampling { piano_spacing: 0.024, room_spacing: 0.071, noise: 0.002 },
    Sampling { piano_spacing: 0.024, room_spacing: 0.071, noise: 0.01 },
];
const MODES: [&str; 2] = ["calibrated", "paper"];
/// Poses with a smaller distance or depth are hard, m.
const NEAR: f64 = 0.05;
/// With fewer points of the piano within one spacing of the room, hardly anything is seen of the
/// place where they meet.
const FEW: usize = 50;

/// One pose with its truth and what the tool says.
struct Judged<'a> {
    case: &'a Case,
    answer: &'a Answer,
    collides: bool,
    distance: f64,
}

impl Judged<'_> {
    fn p(&self) -> f64 {
        self.answer.collision_probability
    }

    fn is_right(&self) -> bool {
        (self.p() >= 0.5) == self.collides
    }
}

pub(super) fn evaluate(tool: &Tool, places: &Places) -> Result<Section> {
    let truth = CaseFile::read(&places.data.join("piano_cases.json"))?;
    let mesh = |path: &String| read_mesh(places.data.join(path), LengthUnit::Metres);
    let (room, piano) = (mesh(&truth.cases[0].scene)?, mesh(&truth.cases[0].object)?);
    let mut scores = Table::new(&[
        "noise (mm)",
        "spacing piano, room (mm)",
        "points piano, room",
        "mode",
        "poses",
        "right at P = 0.5",
        "collision: P > 0.9",
        "collision: P < 0.1",
        "apart: P < 0.1",
        "apart: P > 0.9",
        "AUC",
        "Brier",
        "query median (ms)",
        "query p95 (ms)",
    ]);
    let mut wrong = String::new();
    let mut panels = Vec::new();
    let mut commands = Vec::new();
    let mut failures = Vec::new();
    for sampling in SAMPLINGS {
        let sampled = sampling.write(places, &truth, [&room, &piano])?;
        for mode in MODES {
            let batch = run(tool, places, &sampling, &sampled, mode)?;
            commands.push(batch.command.clone());
            let judged = judge(&truth.cases, &batch, &mut failures)?;
            let near: Vec<&Judged> = judged.iter().filter(|j| j.distance.abs() < NEAR).collect();
            let all: Vec<&Judged> = judged.iter().collect();
            for (name, poses) in [("all", all), ("near", near)] {
                let start = [
                    format!("{:.0}", 1e3 * sampling.noise),
                    format!(
                        "{:.0}, {:.0}",
                        1e3 * sampling.piano_spacing,
                        1e3 * sampling.room_spacing
                    ),
                    format!("{}, {}", sampled.piano.len(), sampled.room.len()),
                    mode.to_owned(),
                    format!("{name} ({})", poses.len()),
                ];
                scores.row(start.into_iter().chain(score(&poses)));
            }
            write_wrong(&mut wrong, &sampling, mode, &sampled, &judged)?;
            if sampling.room_spacing == SAMPLINGS[0].room_spacing {
                let title = format!("{mode}, noise {:.0} mm", 1e3 * sampling.noise);
                let dots = judged.iter().map(|j| (1e3 * j.distance, j.p(), j.collides)).collect();
                panels.push((title, dots));
            }
        }
    }
    // Both of one mode side by side.
    panels.sort_by(|(a, _): &(String, _), (b, _)| a.split(',').next().cmp(&b.split(',').next()));
    chart::scatter(&places.figures.join("piano.svg"), &panels)?;
    Ok(Section {
        title: "Piano in the room, exact answers".into(),
        text: text(&truth, &scores, &wrong)?,
        commands,
        failures,
    })
}

fn run(
    tool: &Tool,
    places: &Places,
    sampling: &Sampling,
    sampled: &Sampled,
    mode: &str,
) -> Result<Batch> {
    let sensor = format!("iso:{}", sampling.noise);
    let lines = places.work.join(format!("piano-{mode}.jsonl"));
    let options = ["--sensor", sensor.as_str(), "--mode", mode];
    tool.batch(&sampled.cases, &sampled.shown, &lines, &options)
}

/// Answers beside the truth; a missing answer is a failure.
fn judge<'a>(
    cases: &'a [Case],
    batch: &'a Batch,
    failures: &mut Vec<String>,
) -> Result<Vec<Judged<'a>>> {
    let mut judged = Vec::new();
    for (case, answer) in cases.iter().zip(&batch.answers) {
        let (collides, distance) = case.exact_answer()?;
        match answer {
            Ok(answer) => judged.push(Judged { case, answer, collides, distance }),
            Err(error) => failures.push(format!("piano {}: no answer: {error}", case.id)),
        }
    }
    Ok(judged)
}

/// From "right" to the times of the table.
fn score(poses: &[&Judged]) -> Vec<String> {
    let scored: Vec<(f64, bool)> = poses.iter().map(|j| (j.p(), j.collides)).collect();
    let times: Vec<f64> = poses.iter().map(|j| j.answer.query_ms()).collect();
    let count = |keep: &dyn Fn(&Judged) -> bool| poses.iter().filter(|j| keep(j)).count();
    let of = |collides: bool, keep: &dyn Fn(f64) -> bool| {
        format!(
            "{} of {}",
            count(&|j| j.collides == collides && keep(j.p())),
            count(&|j| j.collides == collides)
        )
    };
    vec![
        format!("{} of {}", count(&|j| j.is_right()), poses.len()),
        of(true, &|p| p > 0.9),
        of(true, &|p| p < 0.1),
        of(false, &|p| p < 0.1),
        of(false, &|p| p > 0.9),
        format!("{:.3}", auc(&scored)),
        format!("{:.3}", brier(&scored)),
        format!("{:.1}", quantile(&times, 0.5)),
        format!("{:.1}", quantile(&times, 0.95)),
    ]
}

/// The poses on the wrong side of one half, each with what is visible of the reason.
fn write_wrong(
    text: &mut String,
    sampling: &Sampling,
    mode: &str,
    sampled: &Sampled,
    judged: &[Judged],
) -> Result<()> {
    let wrong: Vec<&Judged> = judged.iter().filter(|j| !j.is_right()).collect();
    let mut table = Table::new(&[
        "pose",
        "truth",
        "signed distance (mm)",
        "P",
        "bounds",
        "clearance (mm)",
        "smallest gap of points (mm)",
        "piano points near",
        "what is visible",
    ]);
    for j in &wrong {
        let meeting = sampled.meeting(j.case, sampling.room_spacing)?;
        table.row([
            j.case.id.clone(),
            if j.collides { "collision" } else { "apart" }.into(),
            format!("{:+.1}", 1e3 * j.distance),
            probability(j.p()),
            bounds(j.answer.bounds),
            j.answer.clearance_mm(),
            format!("{:.1}", 1e3 * meeting.gap),
            meeting.points.to_string(),
            reason(j.collides, j.distance, &meeting, sampling).into(),
        ]);
    }
    writeln!(
        text,
        "Wrong at P = 0.5, {mode}, noise {:.0} mm, spacing {:.0} and {:.0} mm: {} of {}.\n",
        1e3 * sampling.noise,
        1e3 * sampling.piano_spacing,
        1e3 * sampling.room_spacing,
        wrong.len(),
        judged.len(),
    )?;
    if !wrong.is_empty() {
        writeln!(text, "{table}")?;
    }
    Ok(())
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

fn text(truth: &CaseFile, scores: &Table, wrong: &str) -> Result<String> {
    let mut collisions = 0;
    for case in &truth.cases {
        collisions += usize::from(case.exact_answer()?.0);
    }
    Ok(format!(
        "{} poses, {collisions} in collision, of a piano in a room, both open triangle meshes. Both \
         are sampled with equal share per area, one point in each of equally large pieces; the \
         spacing is the root of the area per point. Gaussian noise is added to every coordinate \
         and stated to the tool as the sensor. Near means a distance or depth below {:.0} mm. The \
         signed distance of a collision is minus the shortest translation found that ends it: an \
         upper bound on the depth. Below the scores are the poses on the wrong side of one half; \
         \"piano points near\" counts those within the room's spacing of a point of the room (few: \
         below {FEW}).\n\n\
         ![Probability against signed distance](figures/piano.svg)\n\n{scores}\n{wrong}",
        truth.cases.len(),
        1e3 * NEAR,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_follow_from_sizes() {
        let sampling = SAMPLINGS[0];
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
            let found = reason(collides, distance, &meeting, &sampling);
            assert!(found.starts_with(start), "{distance}: {found}");
        }
    }
}
