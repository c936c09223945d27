//! What is in range: settings, coordinates and poses.

pub(crate) mod coordinates;
pub(crate) mod rounded;
pub(crate) mod settings;
