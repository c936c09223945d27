#![doc = include_str!("../README.md")]

mod candidates;
mod discretization;
mod error;
mod finite;
mod grid;
mod limited;
mod model;
mod motion;
mod neighborhoods;
mod parallel;
mod patch;
mod posterior;
mod posterior_settings;
mod radius;
mod ranging;
mod refined;
mod scratch;
mod sensor;
mod sensor_model;
mod sensor_noise;
mod sensor_spec;
mod settings;
mod settings_error;
mod smallest_axis;
mod spacing;
mod surface;
mod wide;

/// Points, covariances, clouds and poses.
pub use cloudtouch_geom as geom;
pub use discretization::{Discretization, Summed, discretization};
pub use error::NoiseError;
pub use grid::quantize_to_grid;
pub use model::NoiseModel;
pub use motion::MotionNoise;
pub use neighborhoods::{Neighbor, Neighborhoods};
pub use posterior_settings::{PosteriorSettings, SurfaceError};
pub use radius::{RadiusRule, radius_chebyshev, radius_gaussian};
pub use ranging::{Kinect, Lidar, StereoCamera};
pub use refined::{Bounds, Refined};
pub use scratch::Scratch;
pub use sensor::{Sensor, along_ray, position_noise};
pub use sensor_model::SensorModel;
pub use sensor_noise::SensorNoise;
pub use settings::{Combination, NoiseSettings};
pub use settings_error::SettingsError;
pub use spacing::typical_spacing;
