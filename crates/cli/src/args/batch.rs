//! What `batch` is given.

use std::path::PathBuf;

use clap::Args;

use crate::sensor::SensorChoice;

use super::answer::written;
use super::asked::AskedArguments;
use super::parse::parse_sensor_for;

/// Many poses from a case file.
#[derive(Debug, Args)]
#[command(after_help = super::SENSORS, group = written(&["jsonl", "html"]))]
pub(crate) struct BatchArguments {
    /// Case file (JSON); its paths are relative to it
    pub cases: PathBuf,
    /// Print one JSON object per case instead of a table
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Write one JSON object per case to this file
    #[arg(long, value_name = "OUT.jsonl", help_heading = "Output")]
    pub jsonl: Option<PathBuf>,
    /// Write a page that shows the cases in any browser, with a slider
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub html: Option<PathBuf>,
    /// Replace an output file that is there already
    #[arg(long, requires = "written", help_heading = "Output")]
    pub force: bool,
    /// Sensor of files with NAME in their path in the case file; the first counts
    #[arg(long, value_name = "NAME=SPEC", value_parser = parse_sensor_for,
          help_heading = "Files")]
    pub sensor_for: Vec<(String, SensorChoice)>,
    #[command(flatten)]
    pub asked: AskedArguments,
}
