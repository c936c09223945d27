//! Every pair of the catalogue of hard cases, in both modes: no panic, no NaN, no false certainty.

use crate::common;
use crate::common::{MODES, Scan, ask};
use cloudtouch::geom::{Covariance, CovarianceError, Matrix3, Point3, PointCloud, Pose};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Mesh, Mode, PrepareError, Verdict};
use cloudtouch_testkit::hard_cases::{HardCase, hard_cases, hard_meshes};

/// Why a side could not be prepared; every way is typed.
#[derive(Debug, thiserror::Error)]
enum Refused {
    #[error(transparent)]
    Covariance(#[from] CovarianceError),
    #[error(transparent)]
    Prepare(#[from] PrepareError),
}

fn prepare(points: &[Point3], matrices: &[Matrix3], mode: Mode) -> Result<Scan, Refused> {
    let covariances: Result<Vec<_>, _> = matrices.iter().map(Covariance::try_from_matrix).collect();
    let cloud =
        PointCloud { covariances: Some(covariances?), ..PointCloud::from_points(points.to_vec()) };
    Ok(Scan::of(&cloud, SensorModel::PerPoint, mode)?)
}

/// The verdict on one case in one mode, of those where the truth is known; or what is wrong with the answer.
fn check(case: &HardCase, mode: Mode) -> Result<Option<Verdict>, String> {
    let both = prepare(&case.cloud_a, &case.covariance_a, mode)
        .and_then(|a| Ok((a, prepare(&case.cloud_b, &case.covariance_b, mode)?)));
    let (a, b) = match both {
        Ok(both) => both,
        Err(refused) => {
            let is_empty = case.cloud_a.is_empty() || case.cloud_b.is_empty();
            let is_right = !case.valid || is_empty;
            return if is_right { Ok(None) } else { Err(format!("refused: {refused}")) };
        }
    };
    // What was not valid and still accepted was dropped, and the filter says so.
    let dropped = a.filter_stages().iter().chain(b.filter_stages()).map(|s| s.removed);
    if !case.valid && dropped.sum::<usize>() == 0 {
        return Err("an invalid case was accepted whole".to_owned());
    }
    let report = ask(mode, &a, &b, &Pose::identity());
    match (report.verdict, case.collides) {
        (Verdict::Free, Some(true)) | (Verdict::InCollision, Some(false)) => {
            let (p, bounds) = (report.collision_probability, report.bounds);
            Err(format!("{:?} with P = {p} in {bounds:?}, {:?}", report.verdict, report.stats))
        }
        (verdict, truth) => Ok(truth.map(|_| verdict)),
    }
}

/// What is decided of the catalogue does not become less.
#[test]
fn no_case_panics_gives_nan_or_is_decided_against_the_truth() {
    let mut wrong = Vec::new();
    for (mode, least) in MODES.into_iter().zip([13, 21]) {
        let (mut decided, mut open) = (0, Vec::new());
        for case in hard_cases() {
            match check(&case, mode) {
                Err(problem) => {
                    wrong.push(format!("{} ({}), {mode:?}: {problem}", case.name, case.reason));
                }
                Ok(Some(Verdict::Free | Verdict::InCollision)) => decided += 1,
                Ok(Some(_)) => open.push(case.name),
                Ok(None) => {}
            }
        }
        println!("{mode:?}: {decided} are decided as the truth is, open {}", open.join(", "));
        assert!(decided >= least, "{mode:?}: only {decided} are decided");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Identical clouds do not say on which side of each other they are: no certainty either way is
/// asked for, but free they are not.
#[test]
fn identical_clouds_are_never_free() {
    for case in hard_cases().iter().filter(|c| ["identical", "subset"].contains(&c.name)) {
        for mode in MODES {
            let a = prepare(&case.cloud_a, &case.covariance_a, mode).unwrap();
            let b = prepare(&case.cloud_b, &case.covariance_b, mode).unwrap();
            let report = ask(mode, &a, &b, &Pose::identity());
            assert_ne!(report.verdict, Verdict::Free, "{} {mode:?}: {report:?}", case.name);
        }
    }
}

/// What a cloud does to each mesh is beyond doubt: through it, inside it or well away.
#[test]
fn every_mesh_is_decided_as_the_truth_is() {
    for case in hard_meshes().iter().filter(|case| case.valid) {
        let solid = Mesh::prepare(&case.mesh).unwrap();
        let expected = if case.collides { Verdict::InCollision } else { Verdict::Free };
        for mode in MODES {
            let cloud = common::prepare(case.cloud.clone(), case.std, mode);
            let report = ask(mode, &cloud, &solid, &Pose::identity());
            assert_eq!(report.verdict, expected, "{} {mode:?}: {:?}", case.name, report.stats);
        }
    }
}
