//! How far work is, told on standard error, and only when that is a terminal.

use std::io::{IsTerminal as _, stderr};
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};

/// Files together smaller than this are read and asked about before anybody wonders.
const LARGE_BYTES: u64 = 20_000_000;

/// How far a batch is.
pub(crate) fn progress_bar(length: usize, unit: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg} ({eta})")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64).with_style(style).with_message(unit)
}

/// What is being done about some files, a line for each thing; nothing where they are small.
#[derive(Debug)]
pub(crate) struct Steps {
    are_told: bool,
}

impl Steps {
    /// About files that are there.
    pub(crate) fn about<'a>(files: impl IntoIterator<Item = &'a Path>) -> Self {
        let size = |file: &Path| file.metadata().map_or(0, |of| of.len());
        let bytes: u64 = files.into_iter().map(size).sum();
        Self { are_told: bytes >= LARGE_BYTES && stderr().is_terminal() }
    }

    /// That something begins, such as `reading`.
    pub(crate) fn tell(&self, begins: &str) {
        if self.are_told {
            // Between warnings, which would run into a line that is drawn again and again.
            eprintln!("{begins} ...");
        }
    }
}
