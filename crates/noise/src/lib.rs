#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod discretization;
mod ends;
mod error;
mod finite;
mod grid;
mod index;
mod lanes;
mod limited;
mod model;
mod motion;
mod neighborhoods;
mod parallel;
mod posterior;
mod radius;
mod refined;
mod representatives;
mod scratch;
mod sensor;
mod settings;
mod settings_error;
mod surface;
mod typical_spacing;

/// Points, covariances, clouds and poses.
pub use cloudtouch_geom as geom;
pub use discretization::{Discretization, Summed, discretization};
pub use ends::Face;
pub use error::NoiseError;
pub use grid::quantize_to_grid;
pub use index::neighbor::Neighbor;
pub use index::places::repeated;
pub use model::NoiseModel;
pub use motion::MotionNoise;
pub use neighborhoods::Neighborhoods;
pub use posterior::settings::{PosteriorSettings, SurfaceError};
pub use radius::{RadiusRule, radius_chebyshev, radius_gaussian};
pub use refined::{Bounds, Refined};
pub use representatives::Representatives;
pub use scratch::Scratch;
pub use sensor::model::SensorModel;
pub use sensor::noise::SensorNoise;
pub use sensor::ranging::{Kinect, Lidar, StereoCamera, TimeOfFlight};
pub use sensor::{Sensor, along_ray, position_noise};
pub use settings::{Combination, NoiseSettings};
pub use settings_error::SettingsError;
pub use typical_spacing::{spacings_at, typical_of_spacings, typical_spacing};
