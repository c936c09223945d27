//! How a cloud of the default path is prepared.

use cloudtouch_bvh::{Split, TreeSettings};
use cloudtouch_noise::{Combination, MotionNoise, NoiseSettings, PosteriorSettings, SensorModel};

use crate::error::PrepareError;
use crate::filter::FilterSettings;

use super::preparation::Preparation;

/// Sensor, cleaning, surface posterior and tree of one cloud.
#[derive(Debug, Clone)]
pub struct CloudSettings {
    /// How noisy the points are.
    pub sensor: SensorModel,
    /// What is removed before anything else.
    pub filter: FilterSettings,
    /// How a surface is fitted to the neighbours of a point, and the point drawn to it.
    pub posterior: PosteriorSettings,
    /// How the tree is split.
    pub tree: TreeSettings,
}

impl CloudSettings {
    /// The settings that suit a sensor.
    pub fn new(sensor: SensorModel) -> Self {
        Self {
            filter: FilterSettings::for_sensor(&sensor),
            sensor,
            posterior: PosteriorSettings::default(),
            // Contact patches do not end where leaves do: small ones are searched sooner, and nothing is
            // gained where siblings overlap.
            tree: TreeSettings {
                max_leaf_points: 12,
                min_leaf_points: 6,
                sibling_overlap: 0.0,
                split: Split::SurfaceArea,
                ..TreeSettings::default()
            },
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
                combination: Combination::SurfacePosterior,
                posterior: self.posterior,
                ..NoiseSettings::default()
            },
            tree: &self.tree,
            motion: MotionNoise::default(),
        }
    }
}
