//! Options about what is doubted, and how long an answer may take.

use std::time::Duration;

use clap::{Args, ValueEnum};
use cloudtouch::Safeguards;
use cloudtouch_cli::numbers;

use super::parse::parse_milliseconds;

/// What keeps a pair from reading as free beside the evidence.
#[derive(Debug, Args)]
#[command(next_help_heading = "Caution")]
pub(crate) struct CautionArguments {
    /// Undecided when more of an object is unseen, 0 to 1 [default: 0.02]
    #[arg(long, value_name = "SHARE", value_parser = numbers::share, allow_negative_numbers = true)]
    pub max_unseen: Option<f64>,
    /// Undecided when more rows are missing, 0 to 1 [default: 0.25]
    #[arg(long, value_name = "SHARE", value_parser = numbers::share, allow_negative_numbers = true)]
    pub max_missing: Option<f64>,
    /// Sizes and distances are meant: warn of them, and decide all the same
    #[arg(long)]
    trust_units: bool,
}

impl CautionArguments {
    /// What is given in place of what is usual.
    pub(crate) fn safeguards(&self, usual: Safeguards) -> Safeguards {
        Safeguards {
            max_unseen: self.max_unseen.unwrap_or(usual.max_unseen),
            max_missing: self.max_missing.unwrap_or(usual.max_missing),
            doubt_units: usual.doubt_units && !self.trust_units,
        }
    }
}

/// How much work is done for an answer, and when.
#[derive(Debug, Args)]
#[command(next_help_heading = "Effort")]
pub(crate) struct EffortArguments {
    /// Time for a query, or a whole path, scene or robot; cut short, none is free
    #[arg(long, value_name = "MS", value_parser = parse_milliseconds,
          allow_negative_numbers = true)]
    deadline: Option<u64>,
    /// Compute surfaces before the first query: auto, yes or no [auto]
    #[arg(long, value_enum, hide_possible_values = true)]
    pub refine: Option<Refine>,
}

impl EffortArguments {
    pub(crate) fn deadline(&self) -> Option<Duration> {
        self.deadline.map(Duration::from_millis)
    }

    pub(crate) fn refine(&self) -> Refine {
        self.refine.unwrap_or(Refine::Auto)
    }
}

/// Whether the surface of a cloud is computed before the first query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Refine {
    /// Where enough poses are asked of it.
    Auto,
    Yes,
    No,
}

/// The surface at so many points takes no longer than what one more pose saves by it. On a scan of
/// 209,280 points with noise of 5 mm it pays from some 200 poses on, 1000 points a pose; on the piano in the
/// room, whose queries are short anyway, from some 2000 on, 15 points: there what comes too soon takes a quarter
/// of a second.
const POINTS_A_POSE: usize = 500;

impl Refine {
    /// Whether a cloud of so many points that is asked about in so many poses is refined.
    pub(crate) fn pays(self, points: usize, poses: usize) -> bool {
        match self {
            Self::Auto => poses > 1 && poses.saturating_mul(POINTS_A_POSE) >= points,
            Self::Yes => true,
            Self::No => false,
        }
    }
}
