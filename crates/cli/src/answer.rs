//! Answers for programs: one line of JSON each.

use anyhow::Result;
use cloudtouch::geom::Pose;
use cloudtouch::{Placement, Report};
use serde::Serialize;

use crate::load::Input;

/// A report with where the object was.
pub(crate) struct Answer<'a> {
    pub report: &'a Report,
    pub placement: &'a Placement,
    /// Object to scene.
    pub pose: &'a Pose,
}

/// An answer with the name of its case: one line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    id: &'a str,
    #[serde(flatten)]
    report: &'a Report,
    placement: &'a Placement,
    pose: [[f64; 4]; 4],
    scene: &'a Input,
    object: &'a Input,
}

/// A case without an answer.
#[derive(Serialize)]
struct ErrorLine<'a> {
    id: &'a str,
    error: &'a str,
}

pub(crate) fn json_error_line(id: &str, error: &str) -> Result<String> {
    Ok(serde_json::to_string(&ErrorLine { id, error })?)
}

impl Answer<'_> {
    pub(crate) fn json_line(&self, id: &str, [scene, object]: [&Input; 2]) -> Result<String> {
        let matrix = self.pose.isometry().to_homogeneous();
        let pose = std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)]));
        let Self { report, placement, .. } = self;
        Ok(serde_json::to_string(&Line { id, report, placement, pose, scene, object })?)
    }
}
