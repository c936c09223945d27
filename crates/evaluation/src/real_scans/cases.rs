//! The labelled cases of the data, read as the tool reads them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use cloudtouch_cli::files::case;
use cloudtouch_geom::Pose;
use cloudtouch_io::ReadLimits;

/// One object in one scene at one pose, with what is known of the answer.
#[derive(Debug, Clone)]
pub(crate) struct Labelled {
    pub(crate) id: String,
    pub(crate) scene: PathBuf,
    pub(crate) object: PathBuf,
    pub(crate) pose: Pose,
    /// Free, near, contact, shallow or collision, of the measured points.
    pub(crate) label: String,
    /// What the label rests on: distance, depth or advance; empty where nothing is said.
    pub(crate) basis: String,
    /// The smallest signed distance of a scene point; negative inside, mm.
    pub(crate) distance_mm: f64,
    /// How far the object went past first contact, mm; only cases of the approach series say so.
    pub(crate) advance_mm: Option<f64>,
}

/// The folder of the data; says so when it is not there.
pub(crate) fn folder(root: &Path, data: &Path) -> Option<PathBuf> {
    let folder = root.join(data);
    if !folder.join("cases.json").is_file() {
        println!(
            "skipped: no real scans at {}; put cases.json, clouds/ and meshes/ there or name their \
             folder with --data DIR",
            data.display()
        );
        return None;
    }
    Some(folder)
}

/// All cases of a file, in order.
pub(crate) fn read(path: &Path) -> Result<Vec<Labelled>> {
    let cases = case::read(path, ReadLimits::default().bytes)?.cases;
    ensure!(!cases.is_empty(), "{}: no cases", path.display());
    cases.into_iter().map(|(id, case)| labelled(&id, case?).with_context(|| id)).collect()
}

/// The approach series of `cases.json` in order: how far past first contact, mm, and the case.
pub(crate) fn series(data: &Path) -> Result<Vec<(f64, Labelled)>> {
    let cases = read(&data.join("cases.json"))?.into_iter();
    let series: Vec<_> = cases.filter_map(|case| Some((case.advance_mm?, case))).collect();
    ensure!(
        series.len() > 1 && series.is_sorted_by(|a, b| a.0 <= b.0),
        "cases.json: the approach series has {} cases, or they are out of order",
        series.len()
    );
    Ok(series)
}

/// The case of a series that is so far past first contact, mm.
pub(crate) fn at_advance(series: &[(f64, Labelled)], wanted: f64) -> Result<usize> {
    let found = series.iter().position(|(advance, _)| (advance - wanted).abs() < 1e-3);
    found.with_context(|| format!("no case of the series is {wanted} mm past first contact"))
}

fn labelled(id: &str, case: case::Case) -> Result<Labelled> {
    let written = &case.written;
    let measured = written["measured"]["min_signed_distance_m"].as_f64();
    let advance = written["advance_past_first_contact_m"].as_f64();
    Ok(Labelled {
        id: id.to_owned(),
        basis: written["label_basis"].as_str().unwrap_or_default().to_owned(),
        distance_mm: 1e3 * case.signed_distance.or(measured).context("no signed distance")?,
        advance_mm: advance.filter(|_| !written["series"].is_null()).map(|advance| 1e3 * advance),
        label: case.label.context("no label")?,
        scene: case.scene,
        object: case.object,
        pose: case.scene_from_object,
    })
}
