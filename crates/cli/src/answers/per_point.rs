//! What a query says of each point: in JSON, and as a table for other programs.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use cloudtouch::geom::{Point3, Pose};
use cloudtouch::paper::LeafClassifier;
use cloudtouch::{Penetration, PointProbabilities, PoseGradient, Report, UnderPoses};
use cloudtouch_io::write_atomically;
use serde::Serialize;

use crate::body::{Body, PreparedCloud};

/// What `--points` adds to a report: P(xᵢ) as pairs of an index among the points kept and a
/// probability, and both ways of pooling them (section 4.4).
#[derive(Serialize)]
pub(crate) struct Points<'a> {
    max_probability: f64,
    noisy_or_probability: f64,
    points: &'a PointProbabilities,
}

impl<'a> From<&'a Report> for Points<'a> {
    fn from(report: &'a Report) -> Self {
        Self {
            max_probability: report.max_probability,
            noisy_or_probability: report.noisy_or_probability,
            points: &report.point_probabilities,
        }
    }
}

/// What one query tells beyond its report, where it was asked to.
#[derive(Default, Serialize)]
pub(crate) struct Details<'a> {
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub points: Option<Points<'a>>,
    /// Over all poses that may be.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose_uncertainty: Option<UnderPoses>,
    /// By a small motion of the object.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient: Option<PoseGradient>,
    /// The way out, where it was asked for, if one was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub penetration: Option<Option<Penetration>>,
    /// Every classifier trained (eq. 10 to 16).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub classifiers: Option<&'a [LeafClassifier]>,
}

/// Writes a row for each point of the clouds, in the scene's frame; 0 where no query looked.
pub(crate) fn write_csv<C: PreparedCloud>(
    path: &Path,
    scene: &Body<C>,
    object: &Body<C>,
    scene_from_object: &Pose,
    report: &Report,
) -> Result<()> {
    let likely = &report.point_probabilities;
    let identity = Pose::identity();
    let bodies =
        [("scene", scene, &identity, &likely.a), ("object", object, scene_from_object, &likely.b)];
    Ok(write_atomically(path, |out| {
        writeln!(out, "body,index,x,y,z,probability")?;
        for (name, body, pose, likely) in bodies {
            let Body::Cloud(cloud) = body else { continue };
            let likely: BTreeMap<usize, f64> = likely.iter().copied().collect();
            for (index, point) in cloud.points().iter().enumerate() {
                let Point3 { coords } = pose.transform_point(point);
                let probability = likely.get(&index).unwrap_or(&0.0);
                let (x, y, z) = (coords.x, coords.y, coords.z);
                writeln!(out, "{name},{index},{x},{y},{z},{probability}")?;
            }
        }
        Ok(())
    })?)
}
