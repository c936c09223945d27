//! The figures: what the methods say against what is true, noise and time.

mod distance;
pub(super) mod labels;
pub(crate) mod lines;
mod noise;
pub(super) mod pareto;
mod reliability;
mod roc;
#[cfg(test)]
mod samples;
mod speed;

pub(crate) use distance::distance;
pub(crate) use noise::noise;
pub(crate) use reliability::reliability;
pub(crate) use roc::roc;
pub(crate) use speed::{Tradeoff, speed};
