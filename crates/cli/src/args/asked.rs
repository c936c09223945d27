//! How pairs are asked about and read, by either mode.

use clap::Args;

use super::bodies::{BodyOptions, PairArguments};
use super::common::CommonArguments;
use super::mode::ModeArguments;

/// What query and batch take beside what is theirs.
#[derive(Debug, Args)]
pub(crate) struct AskedArguments {
    #[command(flatten)]
    pub mode: ModeArguments,
    #[command(flatten)]
    pub common: CommonArguments,
    #[command(flatten)]
    pub pair: PairArguments,
}

impl AskedArguments {
    pub(crate) fn bodies(&self) -> BodyOptions<'_> {
        let settings = self.mode.settings.as_ref();
        BodyOptions { settings, ..self.pair.bodies(&self.common) }
    }

    /// Refuses options of the other mode; the message names them.
    pub(super) fn check(
        &self,
        of_the_paper: &[(&str, bool)],
        of_the_default: &[(&str, bool)],
    ) -> Result<(), String> {
        self.mode.check(&self.common, of_the_paper, of_the_default)
    }
}
