//! How a classifier is trained.

use cloudtouch_svm::Kernel;

use crate::check::settings::{fraction, not_negative, positive};
use crate::error::SettingsError;

/// What the robust classifier takes from the settings of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClassifierSettings {
    /// The kernel, its width γ in the unit box.
    pub kernel: Kernel,
    /// C, before balancing.
    pub penalty: f64,
    /// Whether C is balanced by class size, so that both sides weigh the same in sum.
    pub is_balanced: bool,
    /// How many times as much a misclassified mesh point costs.
    pub mesh_penalty_factor: f64,
    /// r: radius of the uncertainty ellipsoids, in standard deviations (eq. 11, 12), of points that
    /// bring none of their own.
    pub ellipsoid_radius: f64,
    /// Relative gap at which a problem counts as solved.
    pub relative_gap: f64,
    /// Box lengths per metre; `None` where each problem fills the unit box.
    pub scale: Option<f64>,
    /// Whether an answer "apart" is not believed where the noise is large.
    pub distrusts_noise: bool,
}

impl ClassifierSettings {
    /// Checks every field.
    pub(crate) fn validate(&self) -> Result<(), SettingsError> {
        if let Kernel::Gaussian { gamma } = self.kernel {
            positive("gamma", gamma)?;
        }
        positive("penalty", self.penalty)?;
        positive("mesh_penalty_factor", self.mesh_penalty_factor)?;
        not_negative("ellipsoid_radius", self.ellipsoid_radius)?;
        fraction("relative_gap", self.relative_gap)
    }
}

#[cfg(test)]
impl Default for ClassifierSettings {
    /// The defaults of the default path.
    fn default() -> Self {
        Self {
            kernel: Kernel::Gaussian { gamma: 3.0 },
            penalty: 10.0,
            is_balanced: true,
            mesh_penalty_factor: 10.0,
            ellipsoid_radius: 1.0,
            relative_gap: 1e-3,
            scale: None,
            distrusts_noise: true,
        }
    }
}
