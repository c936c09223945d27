//! The case file of a batch.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use cloudtouch::geom::Pose;
use cloudtouch::noise::SensorModel;
use nalgebra::Matrix4;
use serde::Deserialize;
use serde_json::Value;

/// The cases of a file, in order. A case that cannot be read keeps its place and its reason.
pub(crate) struct CaseFile {
    pub cases: Vec<(String, Result<Case>)>,
}

/// One object in one scene at one pose.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub scene: PathBuf,
    pub object: PathBuf,
    pub scene_from_object: Pose,
    pub scene_sensor: Option<SensorModel>,
    pub object_sensor: Option<SensorModel>,
    /// What the file says the answer is, shown beside ours; never used.
    pub label: Option<String>,
}

#[derive(Deserialize)]
struct RawFile {
    format: u32,
    length_unit: String,
    cases: Vec<Value>,
}

#[derive(Deserialize)]
struct RawCase {
    scene: PathBuf,
    object: PathBuf,
    pose: Vec<Vec<f64>>,
    scene_sensor: Option<String>,
    object_sensor: Option<String>,
    label: Option<String>,
    in_collision: Option<bool>,
}

/// Reads a case file; paths in it are relative to its folder.
///
/// # Errors
/// When the file as a whole is not a case file. A bad case does not spoil the others.
pub(crate) fn read(path: &Path) -> Result<CaseFile> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{}: cannot read the case file", path.display()))?;
    let raw: RawFile = serde_json::from_str(&text).with_context(|| {
        format!(
            "{}: not a case file; it needs \"format\", \"length_unit\" and \"cases\"",
            path.display()
        )
    })?;
    if raw.format != 1 {
        bail!("{}: case file format {}: this version reads format 1", path.display(), raw.format);
    }
    if raw.length_unit != "m" {
        bail!(
            "{}: length_unit `{}`: poses must be in metres (\"m\")",
            path.display(),
            raw.length_unit
        );
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    let cases = raw
        .cases
        .into_iter()
        .enumerate()
        .map(|(position, value)| {
            let id = match value.get("id") {
                Some(Value::String(id)) => id.clone(),
                Some(other) => other.to_string(),
                None => format!("case-{}", position + 1),
            };
            let case = parse(value, folder).with_context(|| format!("case {id}"));
            (id, case)
        })
        .collect();
    Ok(CaseFile { cases })
}

fn parse(value: Value, folder: &Path) -> Result<Case> {
    let raw: RawCase = serde_json::from_value(value)?;
    let rows: Vec<f64> = raw.pose.iter().flatten().copied().collect();
    if raw.pose.len() != 4 || rows.len() != 16 {
        bail!("the pose has {} rows and {} numbers: it must be 4x4", raw.pose.len(), rows.len());
    }
    let sensor = |spec: Option<String>| {
        spec.map(|s| s.parse::<SensorModel>().map_err(|error| anyhow!("{error}"))).transpose()
    };
    Ok(Case {
        scene: folder.join(raw.scene),
        object: folder.join(raw.object),
        scene_from_object: Pose::try_from_matrix(&Matrix4::from_row_slice(&rows))?,
        scene_sensor: sensor(raw.scene_sensor)?,
        object_sensor: sensor(raw.object_sensor)?,
        label: raw.label.or_else(|| {
            raw.in_collision.map(|hit| if hit { "collision" } else { "apart" }.to_owned())
        }),
    })
}
