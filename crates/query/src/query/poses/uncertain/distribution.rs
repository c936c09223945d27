//! Poses that may be, around one.

use cloudtouch_geom::Pose;
use nalgebra::{Matrix6, Matrix6xX, SymmetricEigen, Vector6};

use crate::error::QueryError;

/// Relative rounding of a covariance.
const ROUNDING: f64 = 1e-9;
/// No entry of one is larger, m²: poses a few deviations out are still where poses can be asked about.
const MOST: f64 = 1e18;

/// A pose that is known only so well: `mean` followed by a small motion in the object's own frame, by
/// translation (m) and rotation vector (rad), drawn from a normal distribution about nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseDistribution {
    /// The most probable pose.
    pub mean: Pose,
    /// Covariance of translation x, y, z (m) and rotation x, y, z (rad); may be singular.
    pub covariance: [[f64; 6]; 6],
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

    /// The axes of the covariance that are not nothing, each as long as its standard deviation.
    pub(super) fn axes(&self) -> Result<Matrix6xX<f64>, QueryError> {
        let covariance = Matrix6::from_fn(|i, j| self.covariance[i][j]);
        let size = covariance.amax();
        let bad = |value: f64| Err(QueryError::PoseCovariance { value });
        if let Some(&value) = covariance.iter().find(|value| value.is_nan() || value.abs() > MOST) {
            return bad(value);
        }
        let skew = (covariance - covariance.transpose()).amax();
        if skew > ROUNDING * size {
            return bad(skew);
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(covariance);
        let is_bad = |value: f64| !value.is_finite() || value < -ROUNDING * size;
        if let Some(&value) = eigenvalues.iter().find(|value| is_bad(**value)) {
            return bad(value);
        }
        let axes: Vec<Vector6<f64>> = (0..6)
            .filter(|&k| eigenvalues[k] > ROUNDING * size)
            .map(|k| eigenvectors.column(k) * eigenvalues[k].sqrt())
            .collect();
        Ok(if axes.is_empty() { Matrix6xX::zeros(0) } else { Matrix6xX::from_columns(&axes) })
    }
}
