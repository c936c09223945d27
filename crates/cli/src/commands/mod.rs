//! One file per command.

pub(crate) mod batch;
pub(crate) mod demo;
pub(crate) mod info;
pub(crate) mod path;
pub(crate) mod query;
#[cfg(feature = "mcap")]
mod recording;
pub(crate) mod robot;
pub(crate) mod scene;
pub(crate) mod settings;
