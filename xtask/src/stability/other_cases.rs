//! Meshes and poses of the catalogue through full queries.

use anyhow::Result;
use cloudtouch::{Mesh, Mode, Report};
use cloudtouch_geom::{Point3, Pose};
use cloudtouch_testkit::hard_cases::{HardMesh, HardPose, hard_meshes, hard_poses};

use super::{
    cloud_cases::{Judged, default_query, name, prepare_uniform, unsound},
    sheet::{Sheet, milliseconds},
};
use crate::common::table::{Table, probability};

/// Asks about everything and adds the sections.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    meshes(sheet)?;
    poses(sheet)
}

fn meshes(sheet: &mut Sheet) -> Result<()> {
    let mut table = Table::new(&["mesh", "truth", "verdict", "P", "judged", "paper's mode", "ms"]);
    for case in hard_meshes() {
        let truth = if case.collides { "collision" } else { "free" };
        let mut cells = vec![case.name.to_owned(), truth.into()];
        let asked = [Mode::Calibrated, Mode::Paper].map(|mode| {
            let full = format!("mesh, {}, {mode:?}", case.name);
            let report = sheet.guard(&full, || ask_mesh(&case, mode))?;
            judge_mesh(sheet, &full, &case, report)
        });
        if let [Some(ours), Some(paper)] = &asked {
            let micros = ours.stats.prepare_us + ours.stats.query_us;
            cells.extend([
                name(ours.verdict).into(),
                probability(ours.collision_probability),
                Judged::of(ours.verdict, Some(case.collides)).name().into(),
                name(paper.verdict).into(),
                milliseconds(1e-6 * micros as f64),
            ]);
        } else {
            cells.push("refused".into());
        }
        cells.resize(7, String::new());
        table.row(cells);
    }
    let text = format!("A cloud of 2 mm noise and a mesh, in the same frame.\n\n{table}");
    sheet.section("Hard cases: meshes", text);
    Ok(())
}

fn ask_mesh(case: &HardMesh, mode: Mode) -> Result<Report> {
    let mesh = Mesh::prepare(&case.mesh)?;
    let cloud = prepare_uniform(&case.cloud, case.std)?;
    Ok(default_query(mode, (&cloud).into(), (&mesh).into(), &Pose::identity())?)
}

/// Notes what is wrong; the report, if there is one.
fn judge_mesh(
    sheet: &mut Sheet,
    full: &str,
    case: &HardMesh,
    report: Result<Report>,
) -> Option<Report> {
    let report = match report {
        Ok(report) => report,
        Err(refused) => {
            if case.valid {
                sheet.fault(format!("{full}: refused: {refused}"));
            }
            return None;
        }
    };
    if !case.valid {
        sheet.fault(format!("{full}: accepted"));
    }
    if let Some(unsound) = unsound(&report) {
        sheet.fault(format!("{full}: {unsound}"));
    }
    if Judged::of(report.verdict, Some(case.collides)) == Judged::Wrong {
        sheet.fault(format!("{full}: {:?}", report.verdict));
    }
    Some(report)
}

fn poses(sheet: &mut Sheet) -> Result<()> {
    let at = |i: u32, z: f64| Point3::new(0.02 * f64::from(i % 10), 0.02 * f64::from(i / 10), z);
    let [a, b] = [0.0, 0.05].map(|z| (0..100).map(|i| at(i, z)).collect::<Vec<_>>());
    let (a, b) = (prepare_uniform(&a, 0.002)?, prepare_uniform(&b, 0.002)?);
    let mut table = Table::new(&["pose", "why", "answer"]);
    for HardPose { name: case, reason, matrix, valid } in hard_poses() {
        let answer = match Pose::try_from_matrix(&matrix) {
            Ok(pose) => {
                let asked = || default_query(Mode::Calibrated, (&a).into(), (&b).into(), &pose);
                let Some(report) = sheet.guard(&format!("pose, {case}"), asked) else { continue };
                let report = report?;
                if let Some(unsound) = unsound(&report) {
                    sheet.fault(format!("pose, {case}: {unsound}"));
                }
                if Judged::of(report.verdict, Some(false)) == Judged::Wrong {
                    sheet.fault(format!("pose, {case}: {:?}", report.verdict));
                }
                name(report.verdict)
            }
            Err(_) => "refused",
        };
        if (answer == "refused") == valid {
            sheet.fault(format!("pose, {case}: {answer}"));
        }
        table.row([case.to_owned(), reason.to_owned(), answer.to_owned()]);
    }
    let text = format!("Two squares of points 5 cm apart and a matrix between them.\n\n{table}");
    sheet.section("Hard cases: poses", text);
    Ok(())
}
