//! Case files of the tool, as read from the data and as written for it.

use std::{fs, path::Path};

use anyhow::{Context, Result, anyhow};
use cloudtouch_geom::Vector3;
use serde::{Deserialize, Serialize};

/// The cases of a file, in order.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub(super) struct CaseFile {
    pub(super) format: u32,
    pub(super) length_unit: String,
    pub(super) cases: Vec<Case>,
}

/// One object in one scene at one pose, with what is known of the answer.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub(super) struct Case {
    pub(super) id: String,
    pub(super) scene: String,
    pub(super) object: String,
    /// Row by row, object to scene, m.
    pub(super) pose: [[f64; 4]; 4],
    /// Free, near, contact, shallow or collision; of the measured cloud.
    #[serde(default)]
    pub(super) label: Option<String>,
    /// What the label rests on: distance, depth or advance.
    #[serde(default)]
    pub(super) label_basis: Option<String>,
    #[serde(default)]
    pub(super) measured: Option<Measured>,
    /// How far the object went past first contact along its straight line, m.
    #[serde(default)]
    pub(super) advance_past_first_contact_m: Option<f64>,
    /// Present in cases of the approach series.
    #[serde(default)]
    pub(super) series: Option<serde_json::Value>,
    /// Whether the meshes intersect.
    #[serde(default)]
    pub(super) in_collision: Option<bool>,
    /// Distance of the meshes, or minus their penetration depth, m.
    #[serde(default)]
    pub(super) signed_distance_m: Option<f64>,
}

/// What was measured of the scene points against the object's mesh.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub(super) struct Measured {
    /// The smallest signed distance of a scene point, m; negative inside the object.
    pub(super) min_signed_distance_m: f64,
}

impl Case {
    /// Where the object's origin is in the scene, m.
    pub(super) fn translation(&self) -> Vector3 {
        Vector3::new(self.pose[0][3], self.pose[1][3], self.pose[2][3])
    }

    /// Whether the meshes intersect and their signed distance; only exact cases say so.
    pub(super) fn exact_answer(&self) -> Result<(bool, f64)> {
        self.in_collision.zip(self.signed_distance_m).ok_or_else(|| {
            anyhow!("case {}: in_collision or signed_distance_m is missing", self.id)
        })
    }
}

impl CaseFile {
    pub(super) fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("read {}", path.display()))?;
        serde_json::from_slice(&bytes).with_context(|| format!("{}", path.display()))
    }

    pub(super) fn write(&self, path: &Path) -> Result<()> {
        fs::write(path, serde_json::to_vec_pretty(self)?)
            .with_context(|| format!("write {}", path.display()))
    }

    /// Some of the cases, with the paths they had relative to `folder` made absolute.
    pub(super) fn only(&self, folder: &Path, keep: impl Fn(&Case) -> bool) -> Self {
        let absolute = |path: &str| folder.join(path).to_string_lossy().into_owned();
        let cases = self.cases.iter().filter(|case| keep(case)).map(|case| Case {
            scene: absolute(&case.scene),
            object: absolute(&case.object),
            ..case.clone()
        });
        Self { cases: cases.collect(), ..self.clone() }
    }
}
