//! The figures: what the methods say against what is true, noise and time.

mod distance;
mod labels;
pub(super) mod lines;
mod noise;
mod pareto;
mod reliability;
mod roc;
#[cfg(test)]
mod samples;
mod speed;

pub(crate) use distance::distance;
pub(crate) use noise::noise;
pub(crate) use pareto::on_front;
pub(crate) use reliability::reliability;
pub(crate) use roc::roc;
pub(crate) use speed::{Tradeoff, speed};
