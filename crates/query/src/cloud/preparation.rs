//! What a path prepares a cloud by.

use cloudtouch_bvh::TreeSettings;
use cloudtouch_noise::{MotionNoise, NoiseError, NoiseSettings, SensorModel};

use crate::error::PrepareError;
use crate::filter::FilterSettings;

/// What a path prepares a cloud by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Preparation<'a> {
    pub sensor: &'a SensorModel,
    pub filter: &'a FilterSettings,
    pub noise: NoiseSettings,
    pub tree: &'a TreeSettings,
    /// Added to what the sensor makes of position noise.
    pub motion: MotionNoise,
}

impl Preparation<'_> {
    /// Checks every field.
    pub(crate) fn validate(&self) -> Result<(), PrepareError> {
        self.sensor.validate()?;
        self.motion.validate()?;
        self.filter.validate()?;
        self.noise.validate().map_err(NoiseError::from)?;
        Ok(self.tree.validate()?)
    }
}
