//! A single depth image: what its camera did not look at, or not see, was never seen to be empty.

mod about;
mod between;
mod extent;
mod grid;
mod image;
mod lens;
mod lines;
pub(super) mod near;
mod past;
pub(super) mod range;
pub(super) mod raster;
mod robot;
mod seeing;
pub(super) mod seen;
mod single;
mod straight;

pub(super) use image::{Image, OtherReturn};
pub(crate) use seeing::Seeing;
pub(super) use seeing::{AT_SENSOR, Hiding};
pub(crate) use single::SingleView;
