//! How a classifier is trained.

use crate::checks::{fraction, positive};
use crate::error::SettingsError;

/// What the robust classifier takes from the settings of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClassifierSettings {
    /// Kernel width γ in the unit box.
    pub gamma: f64,
    /// C, before balancing by class size.
    pub penalty: f64,
    /// How many times as much a misclassified mesh point costs.
    pub mesh_penalty_factor: f64,
    /// r: radius of the uncertainty ellipsoids, in standard deviations (eq. 11, 12).
    pub ellipsoid_radius: f64,
    /// Relative gap at which a problem counts as solved.
    pub relative_gap: f64,
}

impl ClassifierSettings {
    /// Checks every field.
    pub(crate) fn validate(&self) -> Result<(), SettingsError> {
        positive("gamma", self.gamma)?;
        positive("penalty", self.penalty)?;
        positive("mesh_penalty_factor", self.mesh_penalty_factor)?;
        positive("ellipsoid_radius", self.ellipsoid_radius)?;
        fraction("relative_gap", self.relative_gap)
    }
}

#[cfg(test)]
impl Default for ClassifierSettings {
    /// The defaults of both paths.
    fn default() -> Self {
        Self {
            gamma: 10.0,
            penalty: 100.0,
            mesh_penalty_factor: 10.0,
            ellipsoid_radius: 1.0,
            relative_gap: 1e-3,
        }
    }
}
