//! The noise of the points of scans, and what it says about them.

use cloudtouch_geom::{Covariance, Point3, PointCloud};
use cloudtouch_noise::{MotionNoise, SensorNoise};

use crate::check::rounded::single_step;
use crate::cloud::makeup::SensorDoubt;
use crate::cloud::preparation::Preparation;
use crate::error::PrepareError;
use crate::filter::Taken;

/// Σ of returns, which may have moved since they were seen.
pub(super) fn noise_of(
    returns: &PointCloud,
    by: Preparation<'_>,
) -> Result<SensorNoise, PrepareError> {
    Ok(moved(by.sensor.covariances(returns)?, &by.motion, &returns.points))
}

fn moved(noise: SensorNoise, motion: &MotionNoise, points: &[Point3]) -> SensorNoise {
    if *motion == MotionNoise::default() {
        return noise;
    }
    let sum = |(seen, place): (&Covariance, &Point3)| seen.sum(&motion.covariance(place));
    SensorNoise::from(noise.iter().zip(points).map(sum).collect::<Vec<_>>())
}

/// The noise of several lists of points, one after the other; stored once where all have the same.
pub(super) fn joined(parts: &[&SensorNoise]) -> SensorNoise {
    if let [one] = parts {
        return (*one).clone();
    }
    let first = parts.first().and_then(|part| part.as_uniform());
    match first.filter(|first| parts.iter().all(|part| part.as_uniform() == Some(first))) {
        Some(same) => SensorNoise::uniform(*same, parts.iter().map(|part| part.len()).sum()),
        None => parts.iter().flat_map(|part| part.iter()).copied().collect::<Vec<_>>().into(),
    }
}

/// How far apart coordinates kept in single precision are, m, where that is more than any noise.
pub(super) fn coarse_step(points: &[Point3], noise: &SensorNoise) -> Option<f64> {
    let step = single_step(points)?;
    let most = noise.iter().map(Covariance::max_std_at_most).fold(0.0, f64::max);
    (step > most).then_some(step)
}

/// What was taken for the robot and is rather of something beside it; and a sign where too many points are farther
/// from it than their noise tells.
pub(super) fn padded(
    of_robot: &PointCloud,
    kept: &[Point3],
    by: Preparation<'_>,
) -> Result<(Option<Taken>, Option<SensorDoubt>), PrepareError> {
    /// Cables and joints that are a little off leave fewer.
    const MOST: f64 = 0.5;
    if of_robot.is_empty() {
        return Ok((None, None));
    }
    let noise = noise_of(of_robot, by)?;
    let points = of_robot.points.iter().zip(noise.iter().map(Covariance::max_std_at_most));
    let (taken, share) = Taken::of(points, kept, &by.filter.robot)?;
    Ok((taken, (share > MOST).then_some(SensorDoubt::Padding { share })))
}
