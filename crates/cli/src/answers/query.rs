//! Answers for programs: one line of JSON each.

use anyhow::Result;
use cloudtouch::geom::Pose;
use cloudtouch::{Placement, Report};
use serde::Serialize;

use crate::answers::per_point::Details;
use crate::doubt::Doubt;
use crate::load::Input;
use crate::margin::Nearness;
use crate::remedies;

/// A report with where the object was.
pub(crate) struct Answer<'a> {
    pub report: &'a Report,
    pub placement: &'a Placement,
    /// Object to scene.
    pub pose: &'a Pose,
    /// What was asked for beyond that.
    pub details: Details<'a>,
    pub nearness: Option<Nearness>,
    /// Of the options, beside what the report warns of.
    pub doubt: Option<&'a Doubt>,
}

/// An answer with the name of its case: one line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    id: &'a str,
    #[serde(flatten)]
    report: &'a Report,
    #[serde(flatten)]
    details: &'a Details<'a>,
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

/// A pose as rows.
pub(crate) fn matrix(pose: &Pose) -> [[f64; 4]; 4] {
    let matrix = pose.isometry().to_homogeneous();
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)]))
}

impl Answer<'_> {
    pub(crate) fn json_line(&self, id: &str, [scene, object]: [&Input; 2]) -> Result<String> {
        let pose = matrix(self.pose);
        let Self { report, placement, details, nearness, doubt, .. } = self;
        let line = Line { id, report, details, placement, pose, scene, object };
        if nearness.is_none() && doubt.is_none() {
            return Ok(remedies::in_json(serde_json::to_string(&line)?, &report.warnings));
        }
        let mut line = serde_json::to_value(&line)?;
        if let Some(nearness) = nearness {
            nearness.add_to(&mut line);
        }
        if let (Some(doubt), Some(warnings)) = (doubt, line["warnings"].as_array_mut()) {
            warnings.push(serde_json::to_value(doubt)?);
        }
        Ok(remedies::in_json(line.to_string(), &report.warnings))
    }
}
