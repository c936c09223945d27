//! The catalogue of clouds and meshes through full queries in both modes.

use anyhow::Result;
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings, Query,
    QuerySettings, Report, StageReport, Verdict,
};
use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Pose};
use cloudtouch_testkit::hard_cases::{HardCase, HardMesh, hard_cases, hard_meshes};

use crate::report::{Findings, Section, Target};

const INTRODUCTION: &str = "Whole clouds, then clouds of 2 mm noise with meshes, with the default \
settings of the calibrated mode, and by the paper's mode with our amendments (as printed it misses \
bodies inside meshes and large triangles). A verdict is right, wrong, or open (*uncertain*, \
*undecided*): no mistake, but no answer either. What is no cloud or mesh is to be refused by a typed \
error, or its bad points to be dropped and counted.";

/// A report and how many points the filters dropped.
type Answer = Result<(Report, usize)>;

/// Asks about every pair of clouds, and of a cloud and a mesh.
pub(super) fn measure() -> Findings {
    let (mut faults, mut right, mut open) = (Vec::new(), 0, [Vec::new(), Vec::new()]);
    let mut add = |name: String, valid: bool, truth: Option<bool>, answers: [Answer; 2]| {
        for ((answer, mode), open) in answers.iter().zip(["calibrated", "paper"]).zip(&mut open) {
            match answer {
                Err(refused) if valid => faults.push(format!("{name}, {mode}: refused: {refused}")),
                Err(_) => {}
                Ok((_, 0)) if !valid => faults.push(format!("{name}, {mode}: accepted whole")),
                Ok((report, _)) => match (report.verdict, truth) {
                    (Verdict::Free, Some(true)) | (Verdict::InCollision, Some(false)) => {
                        faults.push(format!("{name}, {mode}: {}", report.verdict));
                    }
                    (Verdict::Free | Verdict::InCollision, Some(_)) => right += 1,
                    (_, Some(_)) => open.push(name.clone()),
                    (_, None) => {}
                },
            }
        }
    };
    for case in hard_cases() {
        let valid = case.valid && !case.cloud_a.is_empty() && !case.cloud_b.is_empty();
        add(case.name.to_owned(), valid, case.collides, of_clouds(&case));
    }
    for case in hard_meshes() {
        add(format!("mesh {}", case.name), case.valid, Some(case.collides), of_mesh(&case));
    }
    let sound =
        Target::none_of("queries: wrong verdicts and wrong refusals, in both modes", &faults);
    let section = Section::new("Hard cases: queries").text(INTRODUCTION).text(format_args!(
        "Of the verdicts where the truth is known, {right} are right and {} open, both modes together. \
         Open by default: {}. Open in the paper's mode: {}.",
        open[0].len() + open[1].len(),
        open[0].join(", "),
        open[1].join(", "),
    ));
    Ok((section, vec![sound]))
}

/// In the calibrated mode and in the paper's.
fn of_clouds(case: &HardCase) -> [Answer; 2] {
    let here = Pose::identity();
    let both = || -> Result<[PointCloud; 2]> {
        Ok([
            with_covariances(&case.cloud_a, &case.covariance_a)?,
            with_covariances(&case.cloud_b, &case.covariance_b)?,
        ])
    };
    let dropped = |stages: [&[StageReport]; 2]| stages.concat().iter().map(|s| s.removed).sum();
    let calibrated = || -> Answer {
        let ([a, b], by) = (both()?, CloudSettings::new(SensorModel::PerPoint));
        let (a, b) = (Cloud::prepare(&a, &by)?, Cloud::prepare(&b, &by)?);
        let report = Query::new(QuerySettings::default())?.run(&a, &b, &here)?;
        Ok((report, dropped([a.filter_stages(), b.filter_stages()])))
    };
    let paper = || -> Answer {
        let ([a, b], by) = (both()?, PaperCloudSettings::amended(SensorModel::PerPoint));
        let (a, b) = (PaperCloud::prepare(&a, &by)?, PaperCloud::prepare(&b, &by)?);
        let report = PaperQuery::new(PaperSettings::amended())?.run(&a, &b, &here)?;
        Ok((report, dropped([a.filter_stages(), b.filter_stages()])))
    };
    [calibrated(), paper()]
}

fn of_mesh(case: &HardMesh) -> [Answer; 2] {
    let (cloud, here) = (PointCloud::from_points(case.cloud.clone()), Pose::identity());
    let sensor = || SensorModel::Isotropic { std: case.std };
    let calibrated = || -> Answer {
        let (mesh, by) = (Mesh::prepare(&case.mesh)?, CloudSettings::new(sensor()));
        let cloud = Cloud::prepare(&cloud, &by)?;
        Ok((Query::new(QuerySettings::default())?.run(&cloud, &mesh, &here)?, 0))
    };
    let paper = || -> Answer {
        let (mesh, by) = (Mesh::prepare(&case.mesh)?, PaperCloudSettings::amended(sensor()));
        let cloud = PaperCloud::prepare(&cloud, &by)?;
        Ok((PaperQuery::new(PaperSettings::amended())?.run(&cloud, &mesh, &here)?, 0))
    };
    [calibrated(), paper()]
}

fn with_covariances(points: &[Point3], matrices: &[Matrix3]) -> Result<PointCloud> {
    let covariances: Result<Vec<_>, _> = matrices.iter().map(Covariance::try_from_matrix).collect();
    Ok(PointCloud { covariances: Some(covariances?), ..PointCloud::from_points(points.to_vec()) })
}
