//! How a cloud is prepared.

use cloudtouch_bvh::TreeSettings;
use cloudtouch_noise::{Combination, NoiseError, NoiseSettings, SensorModel};

use crate::error::PrepareError;
use crate::filter::FilterSettings;
use crate::mode::Mode;

/// Sensor, cleaning, noise model and tree of one cloud.
#[derive(Debug, Clone)]
pub struct CloudSettings {
    /// How noisy the points are.
    pub sensor: SensorModel,
    /// What is removed before anything else.
    pub filter: FilterSettings,
    /// How position noise and discretization make an uncertain point.
    pub noise: NoiseSettings,
    /// How the tree is split.
    pub tree: TreeSettings,
}

impl CloudSettings {
    /// The settings that suit a sensor and a mode: the paper's mode combines noise by
    /// [`Combination::Precision`], the calibrated one by [`Combination::SurfacePosterior`].
    pub fn new(sensor: SensorModel, mode: Mode) -> Self {
        let combination = match mode {
            Mode::Paper => Combination::Precision,
            Mode::Calibrated => Combination::SurfacePosterior,
        };
        Self {
            filter: FilterSettings::for_sensor(&sensor),
            sensor,
            noise: NoiseSettings { combination, ..NoiseSettings::default() },
            tree: match mode {
                Mode::Paper => TreeSettings::default(),
                // Contact patches do not end where leaves do: small ones are searched sooner.
                Mode::Calibrated => TreeSettings {
                    max_leaf_points: 12,
                    min_leaf_points: 6,
                    ..TreeSettings::default()
                },
            },
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), PrepareError> {
        self.sensor.validate()?;
        self.filter.validate()?;
        self.noise.validate().map_err(NoiseError::from)?;
        Ok(self.tree.validate()?)
    }
}
