//! Surface where something was taken for the robot, and with it out of a scan.

use cloudtouch_geom::Pose;

use crate::cloud::Prepared;
use crate::doubt::safeguards::Safeguards;
use crate::doubt::warning::{Warning, Which};
use crate::shape::Shape;

/// What is to be said where more of one body lies where points of the other were taken for the robot, though farther
/// from it than their noise tells, or within a margin (m) of there. Rises with the margin.
pub(crate) fn taken_for_robot(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    margin: f64,
    limits: &Safeguards,
) -> Option<Warning> {
    let limit = limits.most_rather_there()?;
    let told = |cloud: Shape<'_>, other: Shape<'_>, body: Which, cloud_from_other: &Pose| {
        let Shape::Cloud(cloud) = cloud else { return None };
        let share = share(cloud, other, cloud_from_other, margin).filter(|share| *share > limit)?;
        Some(Warning::TakenForRobot { body, share, limit })
    };
    told(a, b, Which::B, a_from_b).or_else(|| told(b, a, Which::A, &a_from_b.inverse()))
}

/// Whether a body may say so of a place.
pub(crate) fn knows_taken(body: Shape<'_>) -> bool {
    matches!(body, Shape::Cloud(cloud) if cloud.was_more_taken())
}

fn share(cloud: &Prepared, other: Shape<'_>, cloud_from_other: &Pose, margin: f64) -> Option<f64> {
    cloud.was_more_taken().then(|| {
        let samples: Vec<_> = other.dense_samples().collect();
        let is_there =
            |sample: &&_| cloud.may_be_taken(&cloud_from_other.transform_point(sample), margin);
        samples.iter().filter(is_there).count() as f64 / samples.len().max(1) as f64
    })
}
