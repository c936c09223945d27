//! The document docs/lab/growth.md, wholly made by a run.

use std::{fmt::Write as _, path::Path};

use anyhow::Result;

use super::{
    answers::{ADDED, METHODS, OWN_STD, Table},
    flips::flips,
};
use crate::{
    common::{machine, table},
    evaluate::case_file::Case,
    sweep::{SEED, measures::Bootstrap},
};

/// Added noise that has columns of its own, m.
const SHOWN: [f64; 3] = [0.005, 0.01, 0.02];

/// How far a pose is past first contact, and the smallest signed distance of a measured point.
pub(super) fn place(case: &Case) -> String {
    let mm = |value: Option<f64>| value.map_or("?".into(), |v| format!("{:+.0} mm", 1e3 * v));
    format!(
        "advance {}, nearest point {}",
        mm(case.advance_past_first_contact_m),
        mm(case.measured.as_ref().map(|m| m.min_signed_distance_m)),
    )
}

/// The whole text.
pub(super) fn text(
    root: &Path,
    (points, draws): (usize, u64),
    cases: &[Case],
    answers: &Table,
) -> Result<String> {
    let mut text = format!(
        "# Answers while noise grows\n\n\
         <!-- Made by `cargo xtask growth --update-docs`; edit xtask/src/sweep/growth/, not this. \
         -->\n\n\
         After the paper's figure 5: a gripper, known as a mesh, at {} poses of its approach to a \
         mug in a real scan, while normal noise is added to the {points} measured points near it. \
         Each size of noise is drawn {draws} times. The sensor model is told of it ({:.0} mm for \
         the scan itself, plus what is added).\n\n\
         `calibrated` and `paper` answer with a probability, in collision from ½ on. The others \
         say yes or no: a 1 cm box around a measured point touches the gripper; a measured point \
         is inside of it (its smallest signed distance is negative); a mesh of the scan (means of \
         4 × 4 pixels, joined where the scan without added noise has no edge) intersects it.\n\n\
         ```text\ncargo run --release -p xtask -- growth --data DIR --update-docs\n```\n\n",
        cases.len(),
        1e3 * OWN_STD,
    );
    writeln!(text, "{}", machine::provenance(root, SEED))?;
    writeln!(
        text,
        "Lines are means over the draws, bars reach from the 10th to the 90th percentile of a \
         probability. Lower right: how often the verdict on a pose differs from that of the draw \
         before, over all poses, with 95 % intervals.\n\n\
         ![Answers while noise grows](figures/growth.svg)\n"
    )?;
    writeln!(
        text,
        "How often the verdict flips from draw to draw, and how often it is not the verdict on \
         the scan as it is. Last: collisions stated of poses whose nearest measured point is more \
         than 5 mm away (label `near`), and poses pushed 2 cm and more past first contact (label \
         `collision`) of which none is stated; over all noises.\n\n{}",
        methods(cases, answers)
    )?;
    writeln!(
        text,
        "Mean answers without added noise and with 10 mm of it; the advance is past first contact \
         with a measured point:\n"
    )?;
    writeln!(text, "{}", poses(cases, answers))?;
    writeln!(text, "DIR is the folder of the scans, which are not part of the project.")?;
    Ok(text)
}

fn level(std: f64) -> usize {
    ADDED.iter().position(|&s| s == std).unwrap_or(0)
}

fn methods(cases: &[Case], answers: &Table) -> table::Table {
    let mut header = vec!["method".to_owned()];
    header.extend(SHOWN.map(|std| format!("flips at {:.0} mm", 1e3 * std)));
    header.extend(SHOWN.map(|std| format!("changed by {:.0} mm", 1e3 * std)));
    header.extend(["false stops", "misses"].map(String::from));
    let mut table = table::Table::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for (method, name) in METHODS.iter().enumerate() {
        let verdicts = |pose, level| answers.verdicts(method, pose, level);
        let flipped = |std: f64| {
            let series: Vec<_> = (0..cases.len()).map(|p| verdicts(p, level(std))).collect();
            flips(&series, Bootstrap::new(SEED)).to_string()
        };
        let changed = |std: f64| {
            share((0..cases.len()).flat_map(|pose| {
                let plain = verdicts(pose, level(0.0))[0];
                verdicts(pose, level(std)).into_iter().map(move |verdict| verdict != plain)
            }))
        };
        let wrong = |label: &str, verdict: bool| {
            let is_labelled = |pose: &usize| cases[*pose].label.as_deref() == Some(label);
            share((0..cases.len()).filter(is_labelled).flat_map(|pose| {
                let all = (0..ADDED.len()).flat_map(move |level| verdicts(pose, level));
                all.map(move |said| said == verdict)
            }))
        };
        let mut cells = vec![(*name).to_owned()];
        cells.extend(SHOWN.map(flipped));
        cells.extend(SHOWN.map(changed));
        cells.extend([wrong("near", true), wrong("collision", false)]);
        table.row(cells);
    }
    table
}

fn poses(cases: &[Case], answers: &Table) -> table::Table {
    let mut header = vec!["pose"];
    header.extend(METHODS);
    let mut table = table::Table::new(&header);
    for (pose, case) in cases.iter().enumerate() {
        let mean = |method, std| {
            let said = answers.of(method, pose, level(std));
            said.iter().sum::<f64>() / said.len() as f64
        };
        let cell = |method| format!("{:.2}, {:.2}", mean(method, 0.0), mean(method, 0.01));
        table.row(std::iter::once(place(case)).chain((0..METHODS.len()).map(cell)));
    }
    table
}

fn share(of: impl Iterator<Item = bool>) -> String {
    let (mut yes, mut all) = (0_u32, 0_u32);
    for is in of {
        yes += u32::from(is);
        all += 1;
    }
    format!("{:.3}", f64::from(yes) / f64::from(all))
}
