//! Case files of the tool, as read from the data and as written for it.

use std::{fs, path::Path};

use anyhow::{Context, Result, anyhow};
use cloudtouch_geom::Vector3;
use serde::{Deserialize, Serialize};

/// The cases of a file, in order.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub(crate) struct CaseFile {
    pub(crate) format: u32,
    pub(crate) length_unit: String,
    pub(crate) cases: Vec<Case>,
}

/// One object in one scene at one pose, with what is known of the answer.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub(crate) struct Case {
    pub(crate) id: String,
    pub(crate) scene: String,
    pub(crate) object: String,
    /// Row by row, object to scene, m.
    pub(crate) pose: [[f64; 4]; 4],
    /// Free, near, contact, shallow or collision; of the measured cloud.
    #[serde(default)]
    pub(crate) label: Option<String>,
    /// What the label rests on: distance, depth or advance.
    #[serde(default)]
    pub(crate) label_basis: Option<String>,
    #[serde(default)]
    pub(crate) measured: Option<Measured>,
    /// How far the object went past first contact along its straight line, m.
    #[serde(default)]
    pub(crate) advance_past_first_contact_m: Option<f64>,
    /// Present in cases of the approach series.
    #[serde(default)]
    pub(crate) series: Option<serde_json::Value>,
    /// Whether the meshes intersect.
    #[serde(default)]
    pub(crate) in_collision: Option<bool>,
    /// Distance of the meshes, or minus their penetration depth, m.
    #[serde(default)]
    pub(crate) signed_distance_m: Option<f64>,
}

/// What was measured of the scene points against the object's mesh.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub(crate) struct Measured {
    /// The smallest signed distance of a scene point, m; negative inside the object.
    pub(crate) min_signed_distance_m: f64,
}

impl Case {
    /// Where the object's origin is in the scene, m.
    pub(crate) fn translation(&self) -> Vector3 {
        Vector3::new(self.pose[0][3], self.pose[1][3], self.pose[2][3])
    }

    /// Whether the meshes intersect and their signed distance; only exact cases say so.
    pub(crate) fn exact_answer(&self) -> Result<(bool, f64)> {
        self.in_collision.zip(self.signed_distance_m).ok_or_else(|| {
            anyhow!("case {}: in_collision or signed_distance_m is missing", self.id)
        })
    }
}

impl CaseFile {
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("read {}", path.display()))?;
        serde_json::from_slice(&bytes).with_context(|| format!("{}", path.display()))
    }

    pub(crate) fn write(&self, path: &Path) -> Result<()> {
        fs::write(path, serde_json::to_vec_pretty(self)?)
            .with_context(|| format!("write {}", path.display()))
    }

    /// Some of the cases, with the paths they had relative to `folder` made absolute.
    pub(crate) fn only(&self, folder: &Path, keep: impl Fn(&Case) -> bool) -> Self {
        let absolute = |path: &str| folder.join(path).to_string_lossy().into_owned();
        let cases = self.cases.iter().filter(|case| keep(case)).map(|case| Case {
            scene: absolute(&case.scene),
            object: absolute(&case.object),
            ..case.clone()
        });
        Self { cases: cases.collect(), ..self.clone() }
    }
}
