#![doc = include_str!("../README.md")]

mod candidates;
mod discretization;
mod error;
mod grid;
mod model;
mod neighborhoods;
mod parallel;
mod patch;
mod radius;
mod sensor;
mod sensor_spec;
mod settings;
mod smallest_axis;
mod spacing;
mod surface;

pub use discretization::{Discretization, discretization};
pub use error::NoiseError;
pub use grid::quantize_to_grid;
pub use model::{Bounds, NoiseModel, Refined, Scratch};
pub use neighborhoods::{Neighbor, Neighborhoods};
pub use radius::{radius_chebyshev, radius_gaussian};
pub use sensor::SensorModel;
pub use settings::{Combination, NoiseSettings};
pub use spacing::typical_spacing;
