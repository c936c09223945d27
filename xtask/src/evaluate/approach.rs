//! A gripper that advances on a mug, step by step: the probability must rise, and the contacts
//! must lie on the scene and face the gripper.

use std::fmt::Write as _;

use anyhow::{Context, Result, bail};
use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_io::read_cloud;

use super::{
    Places, Section,
    case_file::{Case, CaseFile},
    chart::{self, Curve, Mark},
    side_view,
    tool::{Answer, Tool},
};
use crate::common::{
    statistics::largest_drop,
    table::{Table, bounds, probability},
};

/// A fall of the probability by this much along the approach is noise.
const NOISE_OF_PROBABILITY: f64 = 0.05;
/// Contacts must be this near to a scene point, m: three standard deviations.
const CONTACT_REACH: f64 = 0.015;
/// The sensor's standard deviations, m; the middle one is what the scan has.
const SWEEP: [&str; 3] = ["iso:0.002", "iso:0.005", "iso:0.015"];
const MAIN: &str = "iso:0.005";
/// The picture shows the pose that has gone this far past first contact, m.
const PICTURE_AT: f64 = 0.005;

/// One run over the series.
struct Run {
    name: String,
    answers: Vec<Answer>,
    command: String,
}

pub(super) fn evaluate(tool: &Tool, places: &Places) -> Result<Section> {
    let series = CaseFile::read(&places.data.join("cases.json"))?
        .only(&places.data, |case| case.series.is_some());
    let cases = places.work.join("approach.json");
    series.write(&cases)?;
    let advance = advances(&series.cases)?;
    let run = |sensor: &str, mode: &str| -> Result<Run> {
        let lines = places.work.join(format!("approach-{}-{mode}.jsonl", sensor.replace(':', "-")));
        let options = ["--sensor", sensor, "--mode", mode];
        let batch = tool.batch(&cases, "target/evaluate/approach.json", &lines, &options)?;
        let answers = batch.answers.into_iter().collect::<Result<_, _>>();
        let answers = answers
            .map_err(|error: String| anyhow::anyhow!(error))
            .context(batch.command.clone())?;
        Ok(Run { name: format!("{mode}, {sensor}"), answers, command: batch.command })
    };
    let mut runs = Vec::new();
    for sensor in SWEEP {
        runs.push(run(sensor, "calibrated")?);
    }
    runs.push(run(MAIN, "paper")?);
    let main = runs
        .iter()
        .find(|run| run.name == format!("calibrated, {MAIN}"))
        .context("the sweep leaves the main sensor out")?;
    let paper = runs.last().context("there is a run")?;

    draw(places, &series.cases, &advance, &runs, main, paper)?;
    let shown = advance
        .iter()
        .position(|&a| (a - PICTURE_AT).abs() < 1e-6)
        .context("no case is where the picture is wanted")?;
    side_view::draw(tool, places, &series.cases[shown], &main.answers[shown], MAIN)?;

    let contacts = ContactCheck::of(&series.cases, &main.answers)?;
    let drop = largest_drop(main.answers.iter().map(|a| a.collision_probability));
    let mut failures = contacts.failures();
    if drop > NOISE_OF_PROBABILITY {
        failures.push(format!("approach: P falls by {drop:.3} below its running maximum"));
    }
    let first = &series.cases[0];
    Ok(Section {
        title: "Approach of a gripper to a mug".into(),
        text: text(first, &advance, &runs, main, &contacts)?,
        commands: runs.iter().map(|run| run.command.clone()).collect(),
        failures,
    })
}

/// How far past first contact each case is, m; the cases must be in that order.
fn advances(cases: &[Case]) -> Result<Vec<f64>> {
    let of = |case: &Case| {
        case.advance_past_first_contact_m.with_context(|| format!("case {}: no advance", case.id))
    };
    let advances = cases.iter().map(of).collect::<Result<Vec<f64>>>()?;
    if advances.len() < 2 || !advances.is_sorted() {
        bail!("the approach series has {} cases, or they are out of order", advances.len());
    }
    Ok(advances)
}

/// Where the contacts of a series are and where their normals point.
struct ContactCheck {
    contacts: usize,
    /// Contacts farther from any scene point than they may be, by case.
    stray: Vec<String>,
    largest_distance: f64,
    facing: usize,
    likely: usize,
    likely_facing: usize,
}

impl ContactCheck {
    fn of(cases: &[Case], answers: &[Answer]) -> Result<Self> {
        let scene = read_cloud(&cases[0].scene)?.points;
        let last = cases.len() - 1;
        let advance: Vector3 = (cases[last].translation() - cases[0].translation()).normalize();
        let mut check = Self {
            contacts: 0,
            stray: Vec::new(),
            largest_distance: 0.0,
            facing: 0,
            likely: 0,
            likely_facing: 0,
        };
        for (case, answer) in cases.iter().zip(answers) {
            for contact in &answer.contacts {
                let distance = nearest(&scene, &contact.point());
                // NaN is stray too.
                if distance.is_nan() || distance > CONTACT_REACH {
                    check.stray.push(format!("{} ({:.1} mm)", case.id, 1e3 * distance));
                }
                check.largest_distance = check.largest_distance.max(distance);
                let faces = usize::from(contact.normal().dot(&-advance) > 0.0);
                let likely = usize::from(contact.probability >= 0.5);
                check.contacts += 1;
                check.facing += faces;
                check.likely += likely;
                check.likely_facing += faces * likely;
            }
        }
        Ok(check)
    }

    fn failures(&self) -> Vec<String> {
        let mut failures: Vec<String> = self
            .stray
            .iter()
            .map(|case| format!("approach: a contact of {case} is on no scene point"))
            .collect();
        if self.contacts == 0 {
            failures.push("approach: no contact was reported".into());
        }
        failures
    }
}

/// Distance to the nearest point, m; missing returns do not count.
fn nearest(points: &[Point3], to: &Point3) -> f64 {
    let squares = points.iter().map(|p| (p - to).norm_squared()).filter(|d| d.is_finite());
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

fn draw(
    places: &Places,
    cases: &[Case],
    advance: &[f64],
    runs: &[Run],
    main: &Run,
    paper: &Run,
) -> Result<()> {
    let curve = |run: &Run, color| Curve {
        name: run.name.clone(),
        color,
        points: advance
            .iter()
            .zip(&run.answers)
            .map(|(x, answer)| (1e3 * x, answer.collision_probability, answer.bounds))
            .collect(),
        marks: Vec::new(),
    };
    let marks = cases.iter().map(|case| Mark::of_label(case.label.as_deref())).collect();
    let curves = [Curve { marks, ..curve(main, chart::BLUE) }, curve(paper, chart::ORANGE)];
    chart::approach(
        &places.figures.join("approach.svg"),
        "Gripper advancing on a mug: collision probability",
        &curves,
    )?;
    let colors = [chart::GREEN, chart::BLUE, chart::RED];
    let sweep: Vec<Curve> = runs.iter().zip(colors).map(|(r, color)| curve(r, color)).collect();
    chart::approach(
        &places.figures.join("approach-noise.svg"),
        "The same approach for sensors of different noise",
        &sweep,
    )
}

fn text(
    first: &Case,
    advance: &[f64],
    runs: &[Run],
    main: &Run,
    contacts: &ContactCheck,
) -> Result<String> {
    let file = |path: &str| path.rsplit('/').next().unwrap_or_default().to_owned();
    let mut text = format!(
        "`{}` moves along a straight line in `{}`, from {:.0} mm before its first contact with a \
         measured point to {:.0} mm past it.\n\n\
         ![Probability along the approach](figures/approach.svg)\n\n\
         ![Probability along the approach for three sensors](figures/approach-noise.svg)\n\n\
         ![Gripper and mug at the pose {:.0} mm past first contact](figures/gripper-mug.svg)\n\n\
         Points of the scan are grey, towards red by their probability, the gripper is blue; green \
         are the contacts with P of at least 0.5 and their normals. Darker is farther.\n\n",
        file(&first.object),
        file(&first.scene),
        -1e3 * advance[0],
        1e3 * advance[advance.len() - 1],
        1e3 * PICTURE_AT,
    );
    let mut summary = Table::new(&[
        "run",
        "largest drop of P",
        "P at first contact",
        "first P > 0.1 (mm)",
        "first P > 0.9 (mm)",
        "query, all cases (ms)",
    ]);
    for run in runs {
        let p = || run.answers.iter().map(|a| a.collision_probability);
        let first_above = |threshold: f64| {
            let found = advance.iter().zip(p()).find(|(_, p)| *p > threshold);
            found.map_or("never".to_owned(), |(a, _)| format!("{:+.0}", 1e3 * a))
        };
        let at_contact = advance.iter().zip(p()).find(|(a, _)| **a == 0.0);
        summary.row([
            run.name.clone(),
            format!("{:.3}", largest_drop(p())),
            at_contact.map_or("-".into(), |(_, p)| probability(p)),
            first_above(0.1),
            first_above(0.9),
            format!("{:.0}", run.answers.iter().map(Answer::query_ms).sum::<f64>()),
        ]);
    }
    writeln!(
        text,
        "{summary}\nChecked for \"{}\": P falls by at most {NOISE_OF_PROBABILITY} below its \
         running maximum, and every contact is within {:.0} mm of a scene point. Of {} contacts \
         the farthest is {:.1} mm from one; {} have a normal (scene to gripper) that faces the \
         gripper, that is, against its advance; of the {} contacts with P of at least 0.5 it is \
         {}.\n",
        main.name,
        1e3 * CONTACT_REACH,
        contacts.contacts,
        1e3 * contacts.largest_distance,
        share(contacts.facing, contacts.contacts),
        contacts.likely,
        share(contacts.likely_facing, contacts.likely),
    )?;
    let mut header = vec!["advance (mm)".to_owned()];
    header.extend(runs.iter().flat_map(|run| [run.name.clone(), "bounds".into()]));
    let mut table = Table::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for (row, advance) in advance.iter().enumerate() {
        let mut cells = vec![format!("{:+.0}", 1e3 * advance)];
        for run in runs {
            let answer = &run.answers[row];
            cells.extend([probability(answer.collision_probability), bounds(answer.bounds)]);
        }
        table.row(cells);
    }
    writeln!(text, "{table}")?;
    Ok(text)
}

fn share(part: usize, of: usize) -> String {
    format!("{part} ({:.0} %)", 100.0 * part as f64 / of.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_returns_are_never_nearest() {
        let points = [Point3::new(f64::NAN, 0.0, 0.0), Point3::new(3.0, 4.0, 0.0)];
        assert_eq!(nearest(&points, &Point3::origin()), 5.0);
        assert_eq!(nearest(&points[..1], &Point3::origin()), f64::INFINITY);
    }
}
