//! How a cloud is prepared by the paper.

use cloudtouch_bvh::TreeSettings;
use cloudtouch_noise::{Combination, Discretization, NoiseSettings, SensorModel};

use crate::cloud::Preparation;
use crate::error::PrepareError;
use crate::filter::FilterSettings;

/// How position noise Σ and discretization Ψ make the covariance of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PaperNoise {
    /// (Σ⁻¹ + Ψ⁻¹)⁻¹, as printed below eq. 8: never larger than Σ.
    #[default]
    Precision,
    /// Σ + Ψ, what eq. 1 implies: never smaller than Σ.
    Convolution,
}

impl From<PaperNoise> for Combination {
    fn from(noise: PaperNoise) -> Self {
        match noise {
            PaperNoise::Precision => Self::Precision,
            PaperNoise::Convolution => Self::Convolution,
        }
    }
}

/// Sensor, cleaning, noise model and tree of one cloud.
#[derive(Debug, Clone)]
pub struct PaperCloudSettings {
    /// How noisy the points are (Σ).
    pub sensor: SensorModel,
    /// What is removed before anything else (section 3).
    pub filter: FilterSettings,
    /// How Σ and Ψ are put together.
    pub noise: PaperNoise,
    /// Ψ (eq. 17); its k is that of the coverage weights too (section 5).
    pub discretization: Discretization,
    /// How the tree is split (section 5): its leaves are what the classifier is given.
    pub tree: TreeSettings,
}

impl PaperCloudSettings {
    /// The settings that suit a sensor.
    pub fn new(sensor: SensorModel) -> Self {
        Self {
            filter: FilterSettings::for_sensor(&sensor),
            sensor,
            noise: PaperNoise::default(),
            discretization: Discretization::default(),
            tree: TreeSettings::default(),
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), PrepareError> {
        self.preparation().validate()
    }

    pub(super) fn preparation(&self) -> Preparation<'_> {
        Preparation {
            sensor: &self.sensor,
            filter: &self.filter,
            noise: NoiseSettings {
                combination: self.noise.into(),
                discretization: self.discretization,
                ..NoiseSettings::default()
            },
            tree: &self.tree,
        }
    }
}
