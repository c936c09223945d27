//! How to estimate, for the commands that know both modes.

use clap::{Args, ValueEnum};
use cloudtouch::{PaperSettings, Pooling};

use crate::paper_settings::{self, SettingsFile};

use super::caution::Refine;
use super::common::CommonArguments;
use super::parse::{parse_length, parse_whole};

/// What query and batch take beside what they share with the rest.
#[derive(Debug, Args)]
pub(crate) struct ModeArguments {
    /// How to estimate: calibrated, or paper (as printed)
    #[arg(long, value_enum, hide_possible_values = true, default_value_t = ModeName::Calibrated, help_heading = "Estimate")]
    pub mode: ModeName,
    /// Paper: its settings, as `cloudtouch settings` prints them
    #[arg(long, value_name = "FILE", value_parser = paper_settings::read,
          help_heading = "Estimate")]
    pub settings: Option<SettingsFile>,
    /// Calibrated: also how likely they are nearer than this; the verdict stays
    #[arg(long, value_name = "METRES", value_parser = parse_length, allow_negative_numbers = true, help_heading = "Estimate")]
    pub margin: Option<f64>,
    /// Paper: how point probabilities make one: max, or noisy-or [max]
    #[arg(long, value_enum, hide_possible_values = true, help_heading = "Estimate")]
    pub pooling: Option<PoolingName>,
    /// Paper: seed of the stochastic traversal [0]
    #[arg(long, value_name = "N", value_parser = parse_whole::<u64>, allow_negative_numbers = true,
          help_heading = "Estimate")]
    pub seed: Option<u64>,
}

impl ModeArguments {
    pub(crate) fn paper_settings(&self, common: &CommonArguments) -> PaperSettings {
        let given = self.settings.as_ref();
        let usual = given.map_or_else(PaperSettings::default, |file| file.settings.query);
        PaperSettings {
            accept: common.accept.unwrap_or(usual.accept),
            reject: common.reject.unwrap_or(usual.reject),
            pooling: self.pooling.map_or(usual.pooling, Pooling::from),
            seed: self.seed.unwrap_or(usual.seed),
            deadline: common.effort.deadline().or(usual.deadline),
            safeguards: common.caution.safeguards(usual.safeguards),
            ..usual
        }
    }

    /// Refuses options that the mode has no use for. `of_the_paper` and `of_the_default` are more of them,
    /// and whether they are given.
    pub(super) fn check(
        &self,
        common: &CommonArguments,
        of_the_paper: &[(&str, bool)],
        of_the_default: &[(&str, bool)],
    ) -> Result<(), String> {
        let paper = [
            ("--pooling", self.pooling.is_some()),
            ("--seed", self.seed.is_some()),
            ("--settings", self.settings.is_some()),
        ];
        let default = [
            ("--margin", self.margin.is_some()),
            ("--prior", common.prior.is_some()),
            ("--refine", common.effort.refine == Some(Refine::Yes)),
        ];
        let given = match self.mode {
            ModeName::Calibrated => paper.iter().chain(of_the_paper).find(|(_, given)| *given),
            ModeName::Paper => of_the_default.iter().chain(&default).find(|(_, given)| *given),
        };
        match (given, self.mode) {
            (None, _) => Ok(()),
            (Some((name, _)), ModeName::Calibrated) => Err(format!(
                "{name} has no effect in the calibrated mode: leave it out, or give --mode paper"
            )),
            (Some((name, _)), ModeName::Paper) => {
                Err(format!("{name} has no effect in the paper's mode: leave it out"))
            }
        }
    }
}

/// Name of a mode on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModeName {
    Calibrated,
    Paper,
}

/// Name of a way of pooling on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PoolingName {
    Max,
    NoisyOr,
}

impl From<PoolingName> for Pooling {
    fn from(name: PoolingName) -> Self {
        match name {
            PoolingName::Max => Self::Max,
            PoolingName::NoisyOr => Self::NoisyOr,
        }
    }
}
