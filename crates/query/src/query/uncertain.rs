//! A collision where the pose itself is known only so well.

use cloudtouch_geom::{Pose, Vector3, normal};
use nalgebra::{DMatrix, Matrix6, Matrix6xX, SymmetricEigen, UnitQuaternion, Vector6};
use serde::Serialize;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::report::Report;

use super::run::Query;
use super::settings::Detail;

/// Pairs of opposite poses that stand for all.
const PAIRS: usize = 128;
/// Where even the farthest of them is not within reach with this probability, none is looked at.
const OUT_OF_REACH: f64 = 0.005;
/// Relative rounding of a covariance.
const ROUNDING: f64 = 1e-9;

/// A pose that is known only so well: `mean` followed by a small motion in the object's own frame, by
/// translation (m) and rotation vector (rad), drawn from a normal distribution about nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseDistribution {
    /// The most probable pose.
    pub mean: Pose,
    /// Covariance of translation x, y, z (m) and rotation x, y, z (rad); may be singular.
    pub covariance: [[f64; 6]; 6],
}

/// How likely a collision is over all the poses that may be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct UnderPoses {
    /// Mean collision probability of the poses.
    pub probability: f64,
    /// Means of the lower and the upper bounds; `probability` lies within.
    pub bounds: [f64; 2],
    /// The standard error that as many poses drawn at random would leave; what is left is less as a
    /// rule, since they are spread evenly.
    pub std_error: f64,
    /// How many poses were asked about.
    pub poses: usize,
}

impl PoseDistribution {
    /// Independent errors with these standard deviations, of translation (m) and rotation (rad).
    pub fn from_std(mean: Pose, stds: [f64; 6]) -> Self {
        let mut covariance = [[0.0; 6]; 6];
        for (k, std) in stds.into_iter().enumerate() {
            covariance[k][k] = std * std;
        }
        Self { mean, covariance }
    }

    /// The motions that stand for all, in opposite pairs: along the axes of the covariance that are not
    /// nothing, normal quantiles of an even sequence (the generalised golden ratio of M. Roberts).
    fn motions(&self) -> Result<Vec<Vector6<f64>>, QueryError> {
        let covariance = Matrix6::from_fn(|i, j| self.covariance[i][j]);
        let size = covariance.amax();
        let bad = |value: f64| Err(QueryError::PoseCovariance { value });
        if let Some(&value) = covariance.iter().find(|value| !value.is_finite()) {
            return bad(value);
        }
        let skew = (covariance - covariance.transpose()).amax();
        if skew > ROUNDING * size {
            return bad(skew);
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(covariance);
        if let Some(&value) = eigenvalues.iter().find(|value| **value < -ROUNDING * size) {
            return bad(value);
        }
        let axes: Vec<Vector6<f64>> = (0..6)
            .filter(|&k| eigenvalues[k] > ROUNDING * size)
            .map(|k| eigenvectors.column(k) * eigenvalues[k].sqrt())
            .collect();
        if axes.is_empty() {
            return Ok(Vec::new());
        }
        let axes = Matrix6xX::from_columns(&axes);
        let motions = &axes * spread(axes.ncols());
        Ok(motions.column_iter().flat_map(|m| [m.into_owned(), -m.into_owned()]).collect())
    }
}

/// Columns that stand for a standard normal distribution of so many dimensions: with their opposites
/// they have its mean and covariance.
fn spread(dimensions: usize) -> DMatrix<f64> {
    let ratio = golden_ratio(dimensions);
    let even = DMatrix::from_fn(dimensions, PAIRS, |k, number| {
        let part = ratio.powi(-(k as i32 + 1));
        normal::quantile((0.5 + part * (number + 1) as f64).fract().clamp(1e-9, 1.0 - 1e-9))
    });
    let covariance = &even * even.transpose() / PAIRS as f64;
    // Far more columns than dimensions: it is positive definite, and nearly the identity.
    let Some(factor) = covariance.cholesky() else { return even };
    factor.l().solve_lower_triangular(&even).unwrap_or(even)
}

/// The root above one of x^(d+1) = x + 1.
fn golden_ratio(dimensions: usize) -> f64 {
    let mut ratio = 1.5_f64;
    for _ in 0..60 {
        ratio = (1.0 + ratio).powf(1.0 / (dimensions + 1) as f64);
    }
    ratio
}

impl Query {
    /// How likely a collision is where the pose is uncertain: the mean over what it may be, and the
    /// report on the most probable pose.
    ///
    /// The error of the pose moves all of a body together; that is why no noise of single points can
    /// stand for it. Without any uncertainty it is the plain answer, to the bit. Takes 257 queries as a
    /// rule, on all threads of the pool, and two where no pose comes near.
    ///
    /// # Errors
    /// When the covariance is not finite, not symmetric or has a negative eigenvalue, and those of
    /// [`Self::run`].
    pub fn run_uncertain<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &PoseDistribution,
    ) -> Result<(Report, UnderPoses), QueryError> {
        let (a, b) = (a.into(), b.into());
        let mean = &a_from_b.mean;
        let motions = a_from_b.motions()?;
        let report = self.run(a, b, mean)?;
        let [low, high] = report.bounds;
        let plain = UnderPoses {
            probability: report.collision_probability,
            bounds: report.bounds,
            std_error: 0.0,
            poses: 1,
        };
        if motions.is_empty() {
            return Ok((report, plain));
        }
        let shape = b.shape();
        let radius = shape.corners().map(|p| (p.coords + shape.origin()).abs());
        let radius = radius[0].sup(&radius[1]).norm();
        let moves = |motion: &Vector6<f64>| {
            let (shift, turn) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
            shift.norm() + turn.norm() * radius
        };
        let farthest = motions.iter().map(moves).fold(0.0, f64::max);
        let near = self.beyond_collision((a, b), mean, farthest, &report)?;
        if near.bounds[1] < OUT_OF_REACH {
            let bounds = [low, high.max(near.bounds[1])];
            return Ok((report, UnderPoses { bounds, ..plain }));
        }
        let poses: Vec<Pose> = motions.iter().map(|motion| moved(mean, motion)).collect();
        let mut sums = [0.0; 4];
        for answer in self.with_detail(Detail::Probability).run_batch(a, b, &poses) {
            let Report { collision_probability: p, bounds: [low, high], .. } = answer?;
            for (sum, term) in sums.iter_mut().zip([p, low, high, p * p]) {
                *sum += term / poses.len() as f64;
            }
        }
        let [probability, low, high, square] = sums;
        let std_error = ((square - probability * probability).max(0.0) / poses.len() as f64).sqrt();
        let under = UnderPoses { probability, bounds: [low, high], std_error, poses: poses.len() };
        Ok((report, under))
    }
}

/// A pose followed by a small motion in the object's frame.
fn moved(mean: &Pose, motion: &Vector6<f64>) -> Pose {
    let (shift, turn) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
    mean.after(&Pose::from_translation_rotation(Vector3::from(shift), turn))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_have_the_covariance_they_stand_for() {
        let mut covariance = [[0.0; 6]; 6];
        for (i, row) in covariance.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = if i == j {
                    1e-4
                } else if i / 3 == j / 3 {
                    3e-5
                } else {
                    0.0
                };
            }
        }
        let motions = PoseDistribution { mean: Pose::identity(), covariance }.motions().unwrap();
        assert_eq!(motions.len(), 2 * PAIRS);
        let found: Matrix6<f64> =
            motions.iter().map(|m| m * m.transpose()).sum::<Matrix6<f64>>() / motions.len() as f64;
        let wanted = Matrix6::from_fn(|i, j| covariance[i][j]);
        assert!((found - wanted).amax() < 1e-15, "{found}");
    }

    #[test]
    fn one_direction_that_is_known_badly_takes_all_poses() {
        let of = |stds| PoseDistribution::from_std(Pose::identity(), stds).motions().unwrap();
        assert!(of([0.0; 6]).is_empty());
        let along = of([0.0, 0.0, 0.02, 0.0, 0.0, 0.0]);
        assert!(along.iter().all(|m| m[0] == 0.0 && m[3] == 0.0));
        let below = along.iter().filter(|m| m[2] < -0.02).count() as f64 / along.len() as f64;
        assert!((below - 0.159).abs() < 0.01, "{below}");
    }
}
