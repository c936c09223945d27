//! `cloudtouch demo`: the piano in the room, from free to deep.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use cloudtouch::geom::Pose;
use cloudtouch::noise::SensorModel;
use cloudtouch::{PaperQuery, PaperSettings, Placement, Query, QuerySettings, Report, Verdict};
use cloudtouch_cli::files::case;
use cloudtouch_io::{LengthUnit, ReadLimits, pcd};
use cloudtouch_page::{Fact, Page, View};

use crate::answers::print;
use crate::args::{DemoArguments, ModeName};
use crate::body::{self, Body, PreparedCloud};
use crate::load::{Input, Kind, Loaded};
use crate::output::Output;
use crate::{answers, output, pages, picture};

const ROOM: &[u8] = include_bytes!("../../demo/room.pcd");
const PIANO: &[u8] = include_bytes!("../../demo/piano.pcd");
const CASES: &[u8] = include_bytes!("../../demo/cases.json");

/// Noise of both clouds per axis, m: what they were made with.
const NOISE: f64 = 0.002;
/// Characters of the bar that shows a probability.
const BAR: usize = 10;

pub(crate) fn run(arguments: &DemoArguments, shows_work: bool) -> Result<ExitCode> {
    let outputs = [Output::of("ply", &arguments.ply), Output::of("html", &arguments.html)];
    output::check(&outputs, std::iter::empty(), arguments.force)?;
    match arguments.mode {
        ModeName::Calibrated => {
            run_by(&Query::new(QuerySettings::default())?, arguments, shows_work)
        }
        ModeName::Paper => {
            run_by(&PaperQuery::new(PaperSettings::default())?, arguments, shows_work)
        }
    }
}

fn run_by<P: body::Estimator>(
    query: &P,
    arguments: &DemoArguments,
    shows_work: bool,
) -> Result<ExitCode> {
    let (room, piano) = (body("room", ROOM)?, body("piano", PIANO)?);
    let poses = poses(query, &room.body, &piano.body)?;
    let mut text = format!(
        "A grand piano in a furnished room, twelve poses from free to deep. Both are seen as clouds\n\
         with {:.0} mm of noise. The truth is that of the meshes the clouds were sampled from.\n\n\
         {}\n{}\n\n",
        1e3 * NOISE,
        print::body("room", &room),
        print::body("piano", &piano)
    );
    text += &table(&poses);
    if let Some((number, shown)) = most_open(&poses) {
        let Answered { room_from_piano: pose, placement, report, .. } = shown;
        let _ = write!(
            text,
            "\nPose {number} in full:\n{}\n",
            answers::text::text(report, placement, Default::default(), shows_work)
        );
        if let Some(path) = &arguments.ply {
            picture::write(path, (&room.body, None), (&piano.body, None), pose, report)?;
            let _ = writeln!(text, "picture                {}", path.display());
        }
    }
    if let Some(path) = &arguments.html {
        write_page(path, [&room, &piano], &poses)?;
        let _ = writeln!(text, "page                   {}", path.display());
    }
    print::to_stdout(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// All poses with what is true of them, the one that is told in full first.
fn write_page<C: PreparedCloud>(
    path: &Path,
    bodies: [&Loaded<C>; 2],
    poses: &[Answered],
) -> Result<()> {
    let drawn = bodies.map(|body| pages::body(body, None, &ReadLimits::default()));
    let views = poses.iter().enumerate().map(|(index, pose)| {
        let name = format!("pose {}", index + 1);
        let view = View::of_pair(name, [0, 1], pose.room_from_piano, &pose.report);
        let more = vec![Fact::new("True of the meshes", pose.truth())];
        view.with_placement(&pose.placement).with_more(more)
    });
    let page = Page {
        title: "A grand piano in a furnished room".to_owned(),
        bodies: drawn.into_iter().collect::<Result<_>>()?,
        views: views.collect(),
        start: most_open(poses).map_or(0, |(number, _)| number - 1),
        ..Page::default()
    };
    pages::write(path, page)
}

/// A pose with what is true of it and what was answered.
struct Answered {
    room_from_piano: Pose,
    /// Distance of the meshes, m; in overlap minus the penetration depth.
    truth: f64,
    report: Report,
    placement: Placement,
}

impl Answered {
    fn truth(&self) -> String {
        let side = if self.truth > 0.0 { "apart" } else { "overlap" };
        format!("{side:<7} by {:>5.1} mm", 1e3 * self.truth.abs())
    }

    /// Whether the verdict says the opposite of the truth; "uncertain" takes no side.
    fn is_wrong(&self) -> bool {
        match self.report.verdict {
            Verdict::Free => self.truth < 0.0,
            Verdict::InCollision => self.truth > 0.0,
            Verdict::Uncertain | Verdict::Undecided => false,
        }
    }
}

fn body<C: PreparedCloud>(name: &str, pcd: &[u8]) -> Result<Loaded<C>> {
    let cloud = pcd::parse(pcd)?;
    let sensor = SensorModel::Isotropic { std: NOISE };
    let body = Body::Cloud(C::prepare(&[cloud], sensor, None, |_, _| {})?);
    let kind = Kind::Cloud(LengthUnit::Metres);
    let (file, unit) = (name.to_owned(), kind.unit());
    let short = file.clone();
    let sensor = Some(sensor.to_string());
    let input = Input { file, short, unit, sensor, sensor_because: None };
    Ok(Loaded { body, input, kinds: vec![kind] })
}

/// One after the other, so that the times are those of a single thread.
fn poses<P: body::Estimator>(
    query: &P,
    room: &Body<P::Cloud>,
    piano: &Body<P::Cloud>,
) -> Result<Vec<Answered>> {
    let file = case::parse(CASES, Path::new(""))?;
    let answered = file.cases.into_iter().map(|(id, case)| {
        let case = case.with_context(|| id.clone())?;
        let truth = case.signed_distance.with_context(|| format!("{id}: no true distance"))?;
        let report = query.ask(room, piano, &case.scene_from_object)?;
        let placement = query.place(room, piano, &case.scene_from_object);
        Ok(Answered { room_from_piano: case.scene_from_object, truth, report, placement })
    });
    answered.collect()
}

fn table(poses: &[Answered]) -> String {
    let mut text = format!(
        "pose  {:<19}  {:>5}  {:<BAR$}  {:<12}  {:>14}  {:>11}\n",
        "truth", "P", "", "verdict", "clearance (mm)", "time"
    );
    // Writing to a string cannot fail.
    for (index, pose) in poses.iter().enumerate() {
        let report = &pose.report;
        let _ = writeln!(
            text,
            "{:>4}  {}  {:>5}  {}  {:<12}  {:>14}  {:>8.1} ms{}",
            index + 1,
            pose.truth(),
            print::probability(report.collision_probability),
            bar(report.collision_probability),
            report.verdict,
            print::gap_mm(report.clearance_m),
            report.stats.query_us as f64 / 1e3,
            if pose.is_wrong() { "  wrong" } else { "" }
        );
    }
    let count = |wanted: &dyn Fn(&Answered) -> bool| poses.iter().filter(|p| wanted(p)).count();
    let wrong = count(&|p| p.is_wrong());
    let settled = count(&|p| matches!(p.report.verdict, Verdict::Free | Verdict::InCollision));
    let _ = writeln!(
        text,
        "{} right, {wrong} wrong, {} left open{}.\n\
         The first queries also pay for the noise model where they look.",
        settled - wrong,
        poses.len() - settled,
        left_open(poses)
    );
    text
}

/// How many poses were left open for which reason.
fn left_open(poses: &[Answered]) -> String {
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    for Answered { report, .. } in poses {
        let reason = match report.verdict {
            Verdict::Free | Verdict::InCollision => continue,
            Verdict::Uncertain => "the noise hides whether they touch".to_owned(),
            Verdict::Undecided => {
                report.undecided_by.map_or("undecided".to_owned(), |by| by.to_string())
            }
        };
        *reasons.entry(reason).or_default() += 1;
    }
    let each: Vec<String> = reasons.iter().map(|(why, count)| format!("{count}: {why}")).collect();
    if each.is_empty() { String::new() } else { format!(" ({})", each.join("; ")) }
}

fn bar(probability: f64) -> String {
    let filled = ((probability * BAR as f64).round() as usize).min(BAR);
    "█".repeat(filled) + &"·".repeat(BAR - filled)
}

/// The pose the clouds tell least about, and its number from 1: an uncertain one, if any is.
fn most_open(poses: &[Answered]) -> Option<(usize, &Answered)> {
    let doubt = |pose: &Answered| (pose.report.collision_probability - 0.5).abs();
    let numbered = poses.iter().enumerate().map(|(index, pose)| (index + 1, pose));
    numbered.min_by(|(_, a), (_, b)| doubt(a).total_cmp(&doubt(b)))
}
