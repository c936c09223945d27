//! How good answers are: measures with intervals, and differences on the same poses.

mod bootstrap;
mod bounds;
mod calibrate;
mod calibration;
mod judged;
mod logistic;
mod measured;
mod proper;
mod rank;
mod rows;
mod sample;
mod threshold;

pub(crate) use bootstrap::{Bootstrap, Clusters, Estimate, replicate};
pub(crate) use calibrate::calibrate_scores;
pub(crate) use calibration::{Bin, chance_error, reliability};
pub(crate) use judged::Judged;
pub(crate) use logistic::fit_plainly;
pub(crate) use measured::{Measure, Measured, measure};
pub(crate) use rank::roc;
pub(crate) use rows::{Row, write_csv, write_json};
pub(crate) use sample::Sample;
