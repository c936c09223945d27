//! One kind of figure for every report: panels with axes, and series of marks as plain data.
//!
//! Series of one name look alike in all panels of a figure and share a row of its legend; those
//! without a name are left out of it.
//!
//! ```
//! use cloudtouch_evaluation::figure::{Axis, Figure, Panel, Series};
//! let panel = Panel::new(Axis::linear("noise (mm)"), Axis::log("time (ms)"))
//!     .series(Series::curve("ours", [(2.0, 0.7), (10.0, 1.3)]))
//!     .series(Series::whiskers("ours", [(2.0, 0.2, 3.7), (10.0, 0.4, 4.8)]));
//! let svg = Figure::new("Times").panel(panel).svg()?;
//! assert!(svg.starts_with("<svg"));
//! # Ok::<(), anyhow::Error>(())
//! ```

mod axis;
mod data;
mod draw;

pub use axis::Axis;
pub use data::{Figure, Panel, Place, Series, palette};
pub use plotters::style::RGBColor;
