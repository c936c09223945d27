//! The catalogue of clouds through full queries in both modes.

use anyhow::Result;
use cloudtouch::{Cloud, CloudSettings, Mode, Report, noise::SensorModel};
use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Pose};
use cloudtouch_testkit::hard_cases::{HardCase, hard_cases};

use super::{
    examine::{Judged, Refused, default_query, examine, verdict_name},
    sheet::{Sheet, milliseconds, small},
};
use crate::{
    page::Section,
    table::{Table, bounds, probability},
};

/// What the section says before its table.
const INTRODUCTION: &str = "Whole clouds with the default settings of the calibrated mode, and the \
verdict of the paper's mode beside it. `right` is the verdict that is beyond doubt; `open` is \
*in contact* or *undecided* where the truth is known: no mistake, but no answer either; `-` where \
the truth is not known. `refused` is a typed error.";

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

/// A report and how many points the filters dropped.
type Answer = Result<(Report, usize), Refused>;

/// Asks about everything and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let mut table = Table::new(HEADER);
    let mut judgements = Vec::new();
    for case in hard_cases() {
        let [ours, paper] = [Mode::Calibrated, Mode::Paper].map(|mode| {
            let name = format!("query, {}, {mode:?}", case.name);
            let answer = sheet.guard(&name, || ask(&case, mode))?;
            let judged = judge(sheet, &name, &case, &answer);
            judgements.push(judged);
            Some((answer, judged))
        });
        let (Some((ours, judged)), Some((paper, _))) = (ours, paper) else { continue };
        let truth = case.collides.map_or("-", |c| if c { "collision" } else { "free" });
        let mut cells = vec![case.name.to_owned(), truth.into()];
        match &ours {
            Ok((report, _)) => {
                let stats = &report.stats;
                let seconds = 1e-6 * (stats.prepare_us + stats.query_us) as f64;
                let paper = paper.as_ref().map_or("refused", |(r, _)| verdict_name(r.verdict));
                cells.extend([
                    verdict_name(report.verdict).into(),
                    probability(report.collision_probability),
                    bounds(report.bounds),
                    judged.name().into(),
                    paper.into(),
                    stats.kernel_solves.to_string(),
                    stats.fallbacks.to_string(),
                    small(stats.max_relative_gap),
                    milliseconds(seconds),
                ]);
            }
            Err(_) => cells.push("refused".into()),
        }
        cells.resize(HEADER.len(), String::new());
        table.row(cells);
    }
    sheet.sections.push(Section::new("Hard cases: queries").text(INTRODUCTION).text(table));
    let [right, open, wrong] = [Judged::Right, Judged::Open, Judged::Wrong]
        .map(|kind| judgements.iter().filter(|&&judged| judged == kind).count());
    sheet.goal(
        "hard cases: every verdict is right or open, in both modes",
        format!("{right} right, {open} open, {wrong} wrong"),
        wrong == 0,
    );
    Ok(())
}

fn ask(case: &HardCase, mode: Mode) -> Answer {
    let a = prepare(&case.cloud_a, &case.covariance_a, mode)?;
    let b = prepare(&case.cloud_b, &case.covariance_b, mode)?;
    let dropped = a.filter_stages().iter().chain(b.filter_stages()).map(|s| s.removed).sum();
    Ok((default_query(mode, (&a).into(), (&b).into(), &Pose::identity())?, dropped))
}

fn prepare(points: &[Point3], matrices: &[Matrix3], mode: Mode) -> Result<Cloud, Refused> {
    let covariances: Result<Vec<_>, _> = matrices.iter().map(Covariance::try_from_matrix).collect();
    let cloud =
        PointCloud { covariances: Some(covariances?), ..PointCloud::from_points(points.to_vec()) };
    Ok(Cloud::prepare(&cloud, &CloudSettings::new(SensorModel::PerPoint, mode))?)
}

fn judge(sheet: &mut Sheet, name: &str, case: &HardCase, answer: &Answer) -> Judged {
    match answer {
        Ok((report, dropped)) => {
            if !case.valid && *dropped == 0 {
                sheet.fault(format!("{name}: an invalid case was accepted whole"));
            }
            examine(sheet, name, report, case.collides)
        }
        Err(refused) => {
            if case.valid && !case.cloud_a.is_empty() && !case.cloud_b.is_empty() {
                sheet.fault(format!("{name}: refused: {refused}"));
            }
            Judged::Unknown
        }
    }
}
