//! How an answer about many poses or bodies is given.

use std::process::ExitCode;

use clap::Args;
use cloudtouch::Verdict;

/// What path, scene and robot share.
#[derive(Debug, Args)]
pub(crate) struct AnswerArguments {
    /// Print the answer as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Exit by the worst: 0 free, 10 uncertain, 20 in collision, 30 undecided
    #[arg(long, help_heading = "Output")]
    exit_code: bool,
}

impl AnswerArguments {
    /// A failure where a pair has no answer; else the verdict where that was asked for.
    pub(crate) fn exit_code(&self, verdict: Verdict, has_failed: bool) -> ExitCode {
        match (has_failed, self.exit_code) {
            (true, _) => ExitCode::FAILURE,
            (false, true) => exit_code(verdict),
            (false, false) => ExitCode::SUCCESS,
        }
    }
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
