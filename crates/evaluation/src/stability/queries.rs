//! The catalogue of clouds, meshes and poses through full queries in both modes.

use anyhow::Result;
use cloudtouch::{Mesh, Mode, Report, noise::SensorModel};
use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Pose};
use cloudtouch_testkit::hard_cases::{HardCase, HardMesh, hard_cases, hard_meshes, hard_poses};

use super::{
    examine::{Judged, examine},
    sheet::{Sheet, small},
};
use crate::{
    either::{EitherCloud, EitherQuery},
    page::Section,
    table::{Table, bounds, probability, verdict},
};

/// What the section says before its table.
const INTRODUCTION: &str = "Whole clouds, then clouds of 2 mm noise with meshes, with the default \
settings of the calibrated mode, and the verdict of the paper's mode beside it. `right` is the \
verdict that is beyond doubt; `open` is *in contact* or *undecided* where the truth is known: no \
mistake, but no answer either; `-` where the truth is not known. `refused` is a typed error.";

const HEADER: [&str; 11] = [
    "case",
    "truth",
    "verdict",
    "P",
    "bounds",
    "judged",
    "paper's mode",
    "solved",
    "fallbacks",
    "gap",
    "ms",
];

/// Something to be asked in a mode.
struct Asked {
    name: String,
    collides: Option<bool>,
    /// Whether the input is as it should be: else a refusal is right, or a filter that drops some.
    valid: bool,
    ask: Box<dyn Fn(Mode) -> Answer>,
}

/// A report and how many points the filters dropped.
type Answer = Result<(Report, usize)>;

/// Asks about everything and adds the sections.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let mut table = Table::new(HEADER);
    let mut judgements = Vec::new();
    for asked in hard_cases().into_iter().map(clouds).chain(hard_meshes().into_iter().map(mesh)) {
        let [ours, paper] = [Mode::Calibrated, Mode::Paper].map(|mode| {
            let name = format!("query, {}, {mode:?}", asked.name);
            let answer = sheet.guard(&name, || (asked.ask)(mode))?;
            let judged = judge(sheet, &name, &asked, &answer);
            judgements.push(judged);
            answer.ok().map(|(report, _)| (report, judged))
        });
        table.row(row(&asked, ours.as_ref(), paper.as_ref()));
    }
    sheet.sections.push(Section::new("Hard cases: queries").text(INTRODUCTION).text(table));
    let [right, open, wrong] = [Judged::Right, Judged::Open, Judged::Wrong]
        .map(|kind| judgements.iter().filter(|&&judged| judged == kind).count());
    sheet.goal(
        "hard cases: every verdict is right or open, in both modes",
        format!("{right} right, {open} open, {wrong} wrong"),
        wrong == 0,
    );
    poses(sheet)
}

fn clouds(case: HardCase) -> Asked {
    Asked {
        name: case.name.to_owned(),
        collides: case.collides,
        valid: case.valid && !case.cloud_a.is_empty() && !case.cloud_b.is_empty(),
        ask: Box::new(move |mode| {
            let a = prepare(&case.cloud_a, &case.covariance_a, mode)?;
            let b = prepare(&case.cloud_b, &case.covariance_b, mode)?;
            let stages = a.filter_stages().iter().chain(b.filter_stages());
            let dropped = stages.map(|stage| stage.removed).sum();
            let report = EitherQuery::new(mode).run(&a, &b, &Pose::identity())?;
            Ok((report, dropped))
        }),
    }
}

fn mesh(case: HardMesh) -> Asked {
    Asked {
        name: format!("mesh {}", case.name),
        collides: Some(case.collides),
        valid: case.valid,
        ask: Box::new(move |mode| {
            let mesh = Mesh::prepare(&case.mesh)?;
            let cloud = measured(&case.cloud, case.std, mode)?;
            let here = Pose::identity();
            Ok((EitherQuery::new(mode).run(&cloud, &mesh, &here)?, 0))
        }),
    }
}

fn prepare(points: &[Point3], matrices: &[Matrix3], mode: Mode) -> Result<EitherCloud> {
    let covariances: Result<Vec<_>, _> = matrices.iter().map(Covariance::try_from_matrix).collect();
    let cloud =
        PointCloud { covariances: Some(covariances?), ..PointCloud::from_points(points.to_vec()) };
    Ok(EitherCloud::prepare(&cloud, SensorModel::PerPoint, mode)?)
}

/// A cloud with the same noise everywhere, m.
fn measured(points: &[Point3], std: f64, mode: Mode) -> Result<EitherCloud> {
    let cloud = PointCloud::from_points(points.to_vec());
    Ok(EitherCloud::prepare(&cloud, SensorModel::Isotropic { std }, mode)?)
}

fn judge(sheet: &mut Sheet, name: &str, asked: &Asked, answer: &Answer) -> Judged {
    match answer {
        Ok((report, dropped)) => {
            if !asked.valid && *dropped == 0 {
                sheet.fault(format!("{name}: an invalid case was accepted whole"));
            }
            examine(sheet, name, report, asked.collides)
        }
        Err(refused) => {
            if asked.valid {
                sheet.fault(format!("{name}: refused: {refused}"));
            }
            Judged::Unknown
        }
    }
}

/// Refused or panicked where there is no report.
fn row(
    asked: &Asked,
    ours: Option<&(Report, Judged)>,
    paper: Option<&(Report, Judged)>,
) -> Vec<String> {
    let truth = asked.collides.map_or("-", |c| if c { "collision" } else { "free" });
    let mut cells = vec![asked.name.clone(), truth.into()];
    match ours {
        None => cells.push("refused".into()),
        Some((report, judged)) => {
            let stats = &report.stats;
            cells.extend([
                verdict(report.verdict).into(),
                probability(report.collision_probability),
                bounds(report.bounds),
                judged.name().into(),
                paper.map_or("refused", |(report, _)| verdict(report.verdict)).into(),
                stats.kernel_solves.to_string(),
                stats.fallbacks.to_string(),
                small(stats.max_relative_gap),
                format!("{:.1}", 1e-3 * (stats.prepare_us + stats.query_us) as f64),
            ]);
        }
    }
    cells.resize(HEADER.len(), String::new());
    cells
}

fn poses(sheet: &mut Sheet) -> Result<()> {
    let at = |i: u32, z: f64| Point3::new(0.02 * f64::from(i % 10), 0.02 * f64::from(i / 10), z);
    let [a, b] = [0.0, 0.05].map(|z| (0..100).map(|i| at(i, z)).collect::<Vec<_>>());
    let (a, b) = (measured(&a, 0.002, Mode::Calibrated)?, measured(&b, 0.002, Mode::Calibrated)?);
    let (mut answered, mut refused) = (Vec::new(), Vec::new());
    for case in hard_poses() {
        let name = format!("pose, {}", case.name);
        let pose = Pose::try_from_matrix(&case.matrix).ok();
        if pose.is_some() != case.valid {
            sheet.fault(format!("{name}: accepted or refused against what it is"));
        }
        let Some(pose) = pose else {
            refused.push(format!("`{}` ({})", case.name, case.reason));
            continue;
        };
        let ask = || EitherQuery::new(Mode::Calibrated).run(&a, &b, &pose);
        let Some(report) = sheet.guard(&name, ask) else { continue };
        let report = report?;
        examine(sheet, &name, &report, Some(false));
        answered.push(format!("`{}`: {}", case.name, verdict(report.verdict)));
    }
    let text = format!(
        "Two squares of points 5 cm apart and a matrix between them. Answered: {}. Refused: {}.",
        answered.join(", "),
        refused.join(", ")
    );
    sheet.sections.push(Section::new("Hard cases: poses").text(text));
    Ok(())
}
