//! The catalogue of clouds and meshes through full queries in both modes.

use anyhow::Result;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, PaperCloud, PaperQuery, Query, QuerySettings, Report, StageReport,
    Verdict, noise::SensorModel,
};
use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Pose};
use cloudtouch_testkit::hard_cases::{HardCase, HardMesh, hard_cases, hard_meshes};

use crate::{
    methods::{Way, asker},
    page::Section,
    table::{Table, bounds, probability, small},
    targets::{Findings, Target},
};

const INTRODUCTION: &str = "Whole clouds, then clouds of 2 mm noise with meshes, with the default \
settings of the calibrated mode, and the verdict of the paper's mode with our amendments beside it \
(as printed it misses bodies inside meshes and large triangles). Where the truth is known, *uncertain* and *undecided* are open: no mistake, but no answer either. `refused` is a typed \
error.";

const HEADER: [&str; 9] =
    ["case", "truth", "verdict", "P", "bounds", "paper's mode", "solved", "gap", "ms"];

const BOTH: [Way; 2] = [Way::Calibrated, Way::Amended];

/// A report and how many points the filters dropped.
type Answer = Result<(Report, usize)>;

/// Asks about every pair of clouds, and of a cloud and a mesh.
pub(super) fn measure() -> Findings {
    let mut table = Table::new(HEADER);
    let (mut faults, mut right, mut open) = (Vec::new(), 0, 0);
    let mut add = |name: String, valid: bool, truth: Option<bool>, answers: [Answer; 2]| {
        for (answer, mode) in answers.iter().zip(["calibrated", "paper"]) {
            match answer {
                Err(refused) if valid => faults.push(format!("{name}, {mode}: refused: {refused}")),
                Err(_) => {}
                Ok((_, 0)) if !valid => faults.push(format!("{name}, {mode}: accepted whole")),
                Ok((report, _)) => match (report.verdict, truth) {
                    (Verdict::Free, Some(true)) | (Verdict::InCollision, Some(false)) => {
                        faults.push(format!("{name}, {mode}: {}", report.verdict));
                    }
                    (Verdict::Free | Verdict::InCollision, Some(_)) => right += 1,
                    (_, Some(_)) => open += 1,
                    (_, None) => {}
                },
            }
        }
        table.row(row(name, truth, &answers));
    };
    for case in hard_cases() {
        let valid = case.valid && !case.cloud_a.is_empty() && !case.cloud_b.is_empty();
        add(case.name.to_owned(), valid, case.collides, BOTH.map(|way| of_clouds(&case, way)));
    }
    for case in hard_meshes() {
        let answers = BOTH.map(|way| of_mesh(&case, way));
        add(format!("mesh {}", case.name), case.valid, Some(case.collides), answers);
    }
    let sound =
        Target::none_of("queries: wrong verdicts and wrong refusals, in both modes", &faults);
    let section = Section::new("Hard cases: queries").text(INTRODUCTION).text(format_args!(
        "Of the verdicts where the truth is known, {right} are right and {open} open, both modes \
         together."
    ));
    Ok((section.text(table), vec![sound]))
}

fn of_clouds(case: &HardCase, way: Way) -> Answer {
    let a = with_covariances(&case.cloud_a, &case.covariance_a)?;
    let b = with_covariances(&case.cloud_b, &case.covariance_b)?;
    let here = Pose::identity();
    let dropped = |stages: [&[StageReport]; 2]| stages.concat().iter().map(|s| s.removed).sum();
    Ok(match way {
        Way::Calibrated => {
            let settings = CloudSettings::new(SensorModel::PerPoint);
            let (a, b) = (Cloud::prepare(&a, &settings)?, Cloud::prepare(&b, &settings)?);
            let report = Query::new(QuerySettings::default())?.run(&a, &b, &here)?;
            (report, dropped([a.filter_stages(), b.filter_stages()]))
        }
        Way::Printed | Way::Amended => {
            let (query, settings) = way.paper(SensorModel::PerPoint);
            let (a, b) = (PaperCloud::prepare(&a, &settings)?, PaperCloud::prepare(&b, &settings)?);
            let report = PaperQuery::new(query)?.run(&a, &b, &here)?;
            (report, dropped([a.filter_stages(), b.filter_stages()]))
        }
    })
}

fn of_mesh(case: &HardMesh, way: Way) -> Answer {
    let cloud = PointCloud::from_points(case.cloud.clone());
    let mesh = Mesh::prepare(&case.mesh)?;
    Ok((asker(&cloud, case.std, way)?(&mesh, &Pose::identity())?, 0))
}

fn with_covariances(points: &[Point3], matrices: &[Matrix3]) -> Result<PointCloud> {
    let covariances: Result<Vec<_>, _> = matrices.iter().map(Covariance::try_from_matrix).collect();
    Ok(PointCloud { covariances: Some(covariances?), ..PointCloud::from_points(points.to_vec()) })
}

fn row(name: String, truth: Option<bool>, [ours, paper]: &[Answer; 2]) -> Vec<String> {
    let truth = truth.map_or("-", |collides| if collides { "collision" } else { "free" });
    let said = |answer: &Answer| match answer {
        Ok((report, _)) => report.verdict.to_string(),
        Err(_) => "refused".to_owned(),
    };
    let mut cells = vec![name, truth.into(), said(ours)];
    if let Ok((report, _)) = ours {
        let stats = &report.stats;
        cells.extend([
            probability(report.collision_probability),
            bounds(report.bounds),
            said(paper),
            stats.kernel_solves.to_string(),
            small(stats.max_relative_gap),
            format!("{:.1}", 1e-3 * (stats.prepare_us + stats.query_us) as f64),
        ]);
    }
    cells.resize(HEADER.len(), String::new());
    cells
}
