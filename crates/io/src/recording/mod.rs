//! Scans out of recordings: `.mcap` files of robots, read with the feature `mcap`.

mod name;
mod scan;

#[cfg(feature = "mcap")]
mod between;
#[cfg(feature = "mcap")]
mod chunk;
#[cfg(feature = "mcap")]
mod index;
#[cfg(feature = "mcap")]
mod read;
#[cfg(feature = "mcap")]
mod source;
#[cfg(feature = "mcap")]
mod whole;

pub use crate::recording_fault::{Names, RecordingFault};
pub use name::{ScanName, file_of};
pub use scan::RecordedScan;

#[cfg(feature = "mcap")]
pub use read::{Recording, Topic};
