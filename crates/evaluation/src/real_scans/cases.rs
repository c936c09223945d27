//! The labelled cases of the data, read as the tool reads them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use cloudtouch_cli::case_file;
use cloudtouch_geom::Pose;
use cloudtouch_io::ReadLimits;
use serde_json::Value;

/// One object in one scene at one pose, with what is known of the answer.
#[derive(Debug, Clone)]
pub(crate) struct Labelled {
    pub(crate) id: String,
    pub(crate) scene: PathBuf,
    pub(crate) object: PathBuf,
    pub(crate) scene_from_object: Pose,
    /// Free, near, contact, shallow or collision, of the measured points; apart or collision, of
    /// meshes.
    pub(crate) label: String,
    /// What the label rests on: distance, depth or advance; empty where nothing is said.
    pub(crate) basis: String,
    /// Of the meshes, or the smallest signed distance of a scene point; negative in overlap, m.
    pub(crate) distance: f64,
    /// How far the object went past first contact along its straight line, m.
    pub(crate) advance: Option<f64>,
    /// Whether the case belongs to the approach series.
    pub(crate) in_series: bool,
}

/// All cases of a file, in order.
pub(crate) fn read(path: &Path) -> Result<Vec<Labelled>> {
    let cases = case_file::read(path, ReadLimits::default().bytes)?.cases;
    cases.into_iter().map(|(id, case)| labelled(&id, case?).with_context(|| id)).collect()
}

/// The approach series of `cases.json` from the place at `from`, m past first contact, in order.
pub(crate) fn series(data: &Path, from: f64) -> Result<Vec<Labelled>> {
    let mut cases = read(&data.join("cases.json"))?;
    cases.retain(|case| case.in_series && case.advance.is_some_and(|advance| advance >= from));
    let advances: Vec<_> = cases.iter().map(|case| case.advance).collect();
    anyhow::ensure!(
        advances.len() > 1 && advances.is_sorted(),
        "cases.json: the approach series has {} cases, or they are out of order",
        advances.len()
    );
    Ok(cases)
}

fn labelled(id: &str, case: case_file::Case) -> Result<Labelled> {
    let text = |name: &str| case.written[name].as_str().unwrap_or_default().to_owned();
    let measured = case.written["measured"]["min_signed_distance_m"].as_f64();
    Ok(Labelled {
        id: id.to_owned(),
        basis: text("label_basis"),
        distance: case.signed_distance.or(measured).context("no signed distance")?,
        advance: case.written["advance_past_first_contact_m"].as_f64(),
        in_series: !matches!(case.written["series"], Value::Null),
        label: case.label.context("no label")?,
        scene: case.scene,
        object: case.object,
        scene_from_object: case.scene_from_object,
    })
}

impl Labelled {
    /// The advance of a case of the series, m.
    pub(crate) fn advance_m(&self) -> f64 {
        self.advance.unwrap_or(f64::NAN)
    }
}

/// The case of a series that is so far past first contact, m.
pub(crate) fn at_advance(cases: &[Labelled], advance: f64) -> Result<usize> {
    let is_there = |case: &Labelled| (case.advance_m() - advance).abs() < 1e-6;
    cases
        .iter()
        .position(is_there)
        .with_context(|| format!("no case of the series is {advance} m past first contact"))
}

/// The last part of a path.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
