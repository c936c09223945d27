//! One file per command.

pub(crate) mod batch;
pub(crate) mod demo;
pub(crate) mod info;
pub(crate) mod path;
pub(crate) mod query;
pub(crate) mod robot;
pub(crate) mod scene;
pub(crate) mod settings;
