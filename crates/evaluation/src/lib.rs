//! The lab beside the product: what its accuracy and speed are measured with.
//!
//! A command measures, fills [`report::Table`]s and [`report::Figure`]s, and hands them to a
//! [`report::Page`], which writes `docs/lab/NAME.md` whole. Commands have no drawing code and no date
//! or commit of their own. Each fails where something cannot be read, asked or written; `evaluate` and
//! the short sweep also where what they hold is missed.

pub mod answers;
pub mod calibrate;
pub mod measures;
pub mod methods;
pub mod motion;
pub mod paper;
pub mod performance;
pub mod real_scans;
pub mod report;
pub mod statistics;
pub mod sweep;

/// All randomness of the lab comes from this.
pub const SEED: u64 = 2011;
