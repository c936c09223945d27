//! How an answer about many poses or bodies is given.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use clap::{ArgGroup, Args};
use cloudtouch::Verdict;

use crate::output::{self, Output};

/// What path, scene and robot share.
#[derive(Debug, Args)]
pub(crate) struct AnswerArguments {
    /// Print the answer as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Exit by the worst: 0 free, 10 uncertain, 20 in collision, 30 undecided
    #[arg(long, help_heading = "Output")]
    exit_code: bool,
    /// Write a page that shows all of it in any browser
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub html: Option<PathBuf>,
    /// With --html: replace a file that is there already
    #[arg(long, requires = "html", help_heading = "Output")]
    force: bool,
}

impl AnswerArguments {
    /// Whether the page may be written, which is told before the work is done that it shows.
    pub(crate) fn check_page<'a>(
        &self,
        inputs: impl Iterator<Item = &'a Path> + Clone,
    ) -> Result<()> {
        output::check(&[Output::of("html", &self.html)], inputs, self.force)
    }

    /// A failure where a pair has no answer; else the verdict where that was asked for.
    pub(crate) fn exit_code(&self, verdict: Verdict, has_failed: bool) -> ExitCode {
        match (has_failed, self.exit_code) {
            (true, _) => ExitCode::FAILURE,
            (false, true) => exit_code(verdict),
            (false, false) => ExitCode::SUCCESS,
        }
    }
}

/// Options that name a file to be written, of which `--force` needs one.
pub(super) fn written(options: &'static [&'static str]) -> ArgGroup {
    ArgGroup::new("written").args(options).multiple(true)
}

/// The verdict for the shell.
pub(crate) fn exit_code(verdict: Verdict) -> ExitCode {
    ExitCode::from(match verdict {
        Verdict::Free => 0,
        Verdict::Uncertain => 10,
        Verdict::InCollision => 20,
        Verdict::Undecided => 30,
    })
}
