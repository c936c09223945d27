//! Which noise model to use, and its settings.

use crate::discretization::Discretization;
use crate::posterior::settings::PosteriorSettings;
use crate::settings_error::SettingsError;

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
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NoiseSettings {
    /// How sensor and sampling errors are put together; the surface posterior by default.
    pub combination: Combination,
    /// Eq. 17, for `Precision` and `Convolution`.
    pub discretization: Discretization,
    /// For `SurfacePosterior`.
    pub posterior: PosteriorSettings,
}

impl NoiseSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// When the neighbourhood is empty or larger than 200, its width is not positive, a parameter of the posterior is
    /// negative, or a value is not finite.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.discretization.validate()?;
        self.posterior.validate()
    }
}
