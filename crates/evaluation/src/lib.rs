//! The lab beside the product: what its accuracy, speed and stability are measured with.
//!
//! A report measures, fills [`table::Table`]s and [`figure::Figure`]s, and hands them to a
//! [`page::Page`], which writes `docs/lab/NAME.md` whole. Reports have no drawing code and no date
//! or commit of their own.

pub mod answers;
pub mod calibrate;
pub mod figure;
pub mod growth;
pub mod leaf;
pub mod machine;
pub mod measures;
pub mod methods;
pub mod motion;
pub mod page;
pub mod paper;
pub mod performance;
pub mod real_scans;
pub mod settings;
pub mod stability;
pub mod statistics;
pub mod sweep;
pub mod table;
pub mod targets;
