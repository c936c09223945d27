//! Which noise model to use, and its checked settings.

use crate::{Discretization, NoiseError};

/// How position noise Σᵢ and sampling become the mean and covariance of a surface point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Combination {
    /// (Σᵢ⁻¹ + Ψᵢ⁻¹)⁻¹ about xᵢ, as printed in the paper (below eq. 8).
    ///
    /// Never larger than Σᵢ: sampling can only make a point look better known than the sensor
    /// knows it, and a noise-free cloud has no uncertainty however sparse.
    Precision,
    /// Σᵢ + Ψᵢ about xᵢ, what eq. 1 implies.
    ///
    /// Never smaller than Σᵢ; a sparse noise-free cloud stays uncertain, also along the normal
    /// where its surface is curved.
    Convolution,
    /// The point given its measurement and a surface fitted to its neighbours; beyond the paper.
    ///
    /// Along the normal the point moves toward the surface and becomes better known; across it
    /// the covariance is a disc that covers the gap to the next sample.
    #[default]
    SurfacePosterior,
}

/// Settings of a [`NoiseModel`](crate::NoiseModel).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseSettings {
    /// How sensor and sampling errors are put together; the surface posterior by default.
    pub combination: Combination,
    /// The neighbourhood of eq. 17, for `Precision` and `Convolution`.
    pub discretization: Discretization,
    /// Standard deviation of the disc of `SurfacePosterior` across the normal, in local spacings.
    /// 0.35 by default, a little more than the 1/√12 of a uniform square of side one.
    pub disc_std: f64,
}

impl Default for NoiseSettings {
    fn default() -> Self {
        Self {
            combination: Combination::default(),
            discretization: Discretization::default(),
            disc_std: 0.35,
        }
    }
}

impl NoiseSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// When the neighbourhood is empty, its width is not positive, the disc is negative, or a
    /// value is not finite.
    pub fn validate(&self) -> Result<(), NoiseError> {
        self.discretization.validate()?;
        if self.disc_std.is_finite() && self.disc_std >= 0.0 {
            return Ok(());
        }
        Err(NoiseError::Setting {
            name: "disc_std",
            value: self.disc_std,
            requirement: "not negative",
        })
    }
}

pub(crate) fn check_positive(name: &'static str, value: f64) -> Result<(), NoiseError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(NoiseError::Setting { name, value, requirement: "positive" })
}

pub(crate) fn check_at_least(
    name: &'static str,
    value: usize,
    least: usize,
) -> Result<(), NoiseError> {
    if value >= least {
        return Ok(());
    }
    Err(NoiseError::Setting { name, value: value as f64, requirement: "at least 1" })
}
