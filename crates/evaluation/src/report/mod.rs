//! What pages are made of: sections of text, tables and figures, and what is to be reached.

pub mod figure;
mod machine;
pub mod page;
pub mod table;
pub mod targets;

pub use figure::{Axis, Figure, GREY, Panel, Place, RGBColor, Series};
pub use page::{Page, Section};
pub use table::Table;
pub use targets::{Findings, Part, Target};
