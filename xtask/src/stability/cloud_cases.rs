//! The catalogue of clouds through full queries in both modes.

use anyhow::Result;
use cloudtouch::{
    BodyRef, Cloud, CloudSettings, Mode, PrepareError, Query, QueryError, QuerySettings, Report,
    Verdict, noise::SensorModel,
};
use cloudtouch_geom::{Covariance, CovarianceError, Matrix3, Point3, PointCloud, Pose};
use cloudtouch_testkit::hard_cases::{HardCase, hard_cases};

use super::sheet::{Sheet, milliseconds, small};
use crate::common::table::{Table, bounds, probability};

/// What the section says before its table.
const INTRODUCTION: &str = "Whole clouds with the default settings of the calibrated mode, and the \
verdict of the paper's mode beside it. `right` is the verdict that is beyond doubt; `open` is \
*in contact* or *undecided* where the truth is known: no mistake, but no answer either; `-` where \
the truth is not known. `refused` is a typed error.";

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
enum Refused {
    #[error(transparent)]
    Covariance(#[from] CovarianceError),
    #[error(transparent)]
    Prepare(#[from] PrepareError),
    #[error(transparent)]
    Query(#[from] QueryError),
}

/// Asks about everything and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let header = [
        "case",
        "truth",
        "verdict",
        "P",
        "bounds",
        "judged",
        "paper's mode",
        "solved",
        "fallbacks",
        "undecided",
        "gap",
        "ms",
    ];
    let mut table = Table::new(&header);
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
                cells.extend([
                    name(report.verdict).into(),
                    probability(report.collision_probability),
                    bounds(report.bounds),
                    judged.name().into(),
                    paper.as_ref().map_or("refused", |(report, _)| name(report.verdict)).into(),
                    stats.kernel_solves.to_string(),
                    stats.fallbacks.to_string(),
                    stats.undecided.to_string(),
                    small(stats.max_relative_gap),
                    milliseconds(seconds),
                ]);
            }
            Err(_) => cells.push("refused".into()),
        }
        cells.resize(header.len(), String::new());
        table.row(cells);
    }
    sheet.section("Hard cases: queries", format!("{INTRODUCTION}\n\n{table}"));
    let [right, open, wrong] = [Judged::Right, Judged::Open, Judged::Wrong]
        .map(|kind| judgements.iter().filter(|&&judged| judged == kind).count());
    sheet.goal(
        "hard cases: every verdict is right or open, in both modes",
        format!("{right} right, {open} open, {wrong} wrong"),
        wrong == 0,
    );
    Ok(())
}

/// A report and how many points the filters dropped.
type Answer = Result<(Report, usize), Refused>;

fn ask(case: &HardCase, mode: Mode) -> Answer {
    let a = prepare(&case.cloud_a, &case.covariance_a, mode)?;
    let b = prepare(&case.cloud_b, &case.covariance_b, mode)?;
    let dropped = a.filter_stages().iter().chain(b.filter_stages()).map(|s| s.removed).sum();
    Ok((default_query(mode, (&a).into(), (&b).into(), &Pose::identity())?, dropped))
}

pub(super) fn prepare_uniform(points: &[Point3], std: f64) -> Result<Cloud, PrepareError> {
    let settings = CloudSettings::new(SensorModel::Isotropic { std }, Mode::Calibrated);
    Cloud::prepare(&PointCloud::from_points(points.to_vec()), &settings)
}

fn prepare(points: &[Point3], matrices: &[Matrix3], mode: Mode) -> Result<Cloud, Refused> {
    let covariances: Result<Vec<_>, _> = matrices.iter().map(Covariance::try_from_matrix).collect();
    let cloud =
        PointCloud { covariances: Some(covariances?), ..PointCloud::from_points(points.to_vec()) };
    Ok(Cloud::prepare(&cloud, &CloudSettings::new(SensorModel::PerPoint, mode))?)
}

pub(super) fn default_query(
    mode: Mode,
    a: BodyRef<'_>,
    b: BodyRef<'_>,
    a_from_b: &Pose,
) -> Result<Report, QueryError> {
    // Default settings are checked by the library's own tests.
    let query = Query::new(QuerySettings::new(mode)).expect("default settings are allowed");
    query.run(a, b, a_from_b)
}

/// How an answer compares with the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Judged {
    Right,
    Open,
    Wrong,
    Unknown,
}

impl Judged {
    pub(super) fn of(verdict: Verdict, collides: Option<bool>) -> Self {
        match (verdict, collides) {
            (_, None) => Self::Unknown,
            (Verdict::Free, Some(false)) | (Verdict::InCollision, Some(true)) => Self::Right,
            (Verdict::Free | Verdict::InCollision, Some(_)) => Self::Wrong,
            _ => Self::Open,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Open => "open",
            Self::Wrong => "WRONG",
            Self::Unknown => "-",
        }
    }
}

fn judge(sheet: &mut Sheet, name: &str, case: &HardCase, answer: &Answer) -> Judged {
    let (report, dropped) = match answer {
        Ok(answer) => answer,
        Err(refused) => {
            if case.valid && !case.cloud_a.is_empty() && !case.cloud_b.is_empty() {
                sheet.fault(format!("{name}: refused: {refused}"));
            }
            return Judged::Unknown;
        }
    };
    if !case.valid && *dropped == 0 {
        sheet.fault(format!("{name}: an invalid case was accepted whole"));
    }
    let judged = Judged::of(report.verdict, case.collides);
    if judged == Judged::Wrong {
        sheet.fault(format!("{name}: {:?}", report.verdict));
    }
    if let Some(unsound) = unsound(report) {
        sheet.fault(format!("{name}: {unsound}"));
    }
    judged
}

/// What in a report is no probability, not finite, or no unit vector.
pub(super) fn unsound(report: &Report) -> Option<&'static str> {
    let is_probability = |p: f64| (0.0..=1.0).contains(&p);
    let (p, [low, high]) = (report.collision_probability, report.bounds);
    if !(is_probability(p) && is_probability(low) && is_probability(high) && low <= p && p <= high)
    {
        return Some("probabilities are not ones, or out of their bounds");
    }
    let points = &report.point_probabilities;
    if !points.a.iter().chain(&points.b).all(|&(_, p)| is_probability(p)) {
        return Some("a point's probability is not one");
    }
    if report.clearance_m.is_some_and(|c| !(c.mean.is_finite() && c.std >= 0.0)) {
        return Some("the clearance is not a number");
    }
    // Normalising rounds in the last places only.
    let is_unit = |c: &cloudtouch::Contact| (c.normal_a_to_b.norm() - 1.0).abs() < 1e-9;
    let is_finite = |c: &cloudtouch::Contact| {
        c.point.iter().all(|v| v.is_finite()) && c.clearance_m.is_finite() && is_unit(c)
    };
    (!report.contacts.iter().all(is_finite)).then_some("a contact is not finite")
}

pub(super) fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Free => "free",
        Verdict::InContact => "in contact",
        Verdict::InCollision => "in collision",
        Verdict::Undecided => "undecided",
    }
}
