//! `cloudtouch settings`: all settings of the paper's mode, as a file to start from.

use std::process::ExitCode;

use anyhow::Result;

use crate::{print, settings_file};

pub(crate) fn run() -> Result<ExitCode> {
    print::to_stdout(settings_file::DEFAULTS)?;
    Ok(ExitCode::SUCCESS)
}
