//! Meshes and poses of the catalogue through full queries.

use anyhow::Result;
use cloudtouch::{Mesh, Mode, Report};
use cloudtouch_geom::{Point3, Pose};
use cloudtouch_testkit::hard_cases::{HardMesh, hard_meshes, hard_poses};

use super::{
    examine::{Judged, default_query, examine, prepare_uniform, verdict_name},
    sheet::{Sheet, milliseconds},
};
use crate::{
    page::Section,
    table::{Table, probability},
};

/// Asks about everything and adds the sections.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    meshes(sheet);
    poses(sheet)
}

fn meshes(sheet: &mut Sheet) {
    let header = ["mesh", "truth", "verdict", "P", "judged", "paper's mode", "ms"];
    let mut table = Table::new(header);
    for case in hard_meshes() {
        let asked = [Mode::Calibrated, Mode::Paper].map(|mode| {
            let name = format!("mesh, {}, {mode:?}", case.name);
            let report = sheet.guard(&name, || ask(&case, mode))?;
            judge(sheet, &name, &case, report)
        });
        let truth = if case.collides { "collision" } else { "free" };
        let mut cells = vec![case.name.to_owned(), truth.into()];
        if let [Some((ours, judged)), Some((paper, _))] = &asked {
            let micros = ours.stats.prepare_us + ours.stats.query_us;
            cells.extend([
                verdict_name(ours.verdict).into(),
                probability(ours.collision_probability),
                judged.name().into(),
                verdict_name(paper.verdict).into(),
                milliseconds(1e-6 * micros as f64),
            ]);
        } else {
            cells.push("refused".into());
        }
        cells.resize(header.len(), String::new());
        table.row(cells);
    }
    let introduction = "A cloud of 2 mm noise and a mesh, in the same frame.";
    sheet.sections.push(Section::new("Hard cases: meshes").text(introduction).text(table));
}

fn ask(case: &HardMesh, mode: Mode) -> Result<Report> {
    let mesh = Mesh::prepare(&case.mesh)?;
    let cloud = prepare_uniform(&case.cloud, case.std)?;
    Ok(default_query(mode, (&cloud).into(), (&mesh).into(), &Pose::identity())?)
}

/// Notes what is wrong; the report, if there is one.
fn judge(
    sheet: &mut Sheet,
    name: &str,
    case: &HardMesh,
    report: Result<Report>,
) -> Option<(Report, Judged)> {
    match report {
        Ok(report) => {
            if !case.valid {
                sheet.fault(format!("{name}: accepted"));
            }
            let judged = examine(sheet, name, &report, Some(case.collides));
            Some((report, judged))
        }
        Err(refused) => {
            if case.valid {
                sheet.fault(format!("{name}: refused: {refused}"));
            }
            None
        }
    }
}

fn poses(sheet: &mut Sheet) -> Result<()> {
    let at = |i: u32, z: f64| Point3::new(0.02 * f64::from(i % 10), 0.02 * f64::from(i / 10), z);
    let [a, b] = [0.0, 0.05].map(|z| (0..100).map(|i| at(i, z)).collect::<Vec<_>>());
    let (a, b) = (prepare_uniform(&a, 0.002)?, prepare_uniform(&b, 0.002)?);
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
        let asked = || default_query(Mode::Calibrated, (&a).into(), (&b).into(), &pose);
        let Some(report) = sheet.guard(&name, asked) else { continue };
        let report = report?;
        examine(sheet, &name, &report, Some(false));
        answered.push(format!("`{}`: {}", case.name, verdict_name(report.verdict)));
    }
    let text = format!(
        "Two squares of points 5 cm apart and a matrix between them. Answered: {}. Refused: {}.",
        answered.join(", "),
        refused.join(", ")
    );
    sheet.sections.push(Section::new("Hard cases: poses").text(text));
    Ok(())
}
