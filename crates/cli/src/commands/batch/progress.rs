//! How far a batch is.

use indicatif::{ProgressBar, ProgressStyle};

/// Drawn on standard error, and only when that is a terminal.
pub(super) fn progress_bar(length: usize, unit: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg} ({eta})")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64).with_style(style).with_message(unit)
}
