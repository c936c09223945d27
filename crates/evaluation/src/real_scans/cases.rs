//! Stand-in until the real scans are here.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use cloudtouch_geom::Pose;
use nalgebra::Matrix4;
use serde_json::Value;

pub(crate) struct Labelled {
    pub(crate) scene: PathBuf,
    pub(crate) object: PathBuf,
    pub(crate) scene_from_object: Pose,
    pub(crate) label: String,
    pub(crate) in_series: bool,
}

pub(crate) fn read(path: &Path) -> Result<Vec<Labelled>> {
    let all: Value = serde_json::from_slice(&std::fs::read(path)?)?;
    let folder = path.parent().context("a folder")?;
    let case = |case: &Value| {
        let rows: [[f64; 4]; 4] = serde_json::from_value(case["pose"].clone())?;
        let text = |name: &str| case[name].as_str().unwrap_or_default();
        Ok(Labelled {
            scene: folder.join(text("scene")),
            object: folder.join(text("object")),
            scene_from_object: Pose::try_from_matrix(&Matrix4::from_fn(|r, c| rows[r][c]))?,
            label: text("label").to_owned(),
            in_series: !case["series"].is_null(),
        })
    };
    all["cases"].as_array().context("cases")?.iter().map(case).collect()
}
