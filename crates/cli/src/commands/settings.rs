//! `cloudtouch settings`: all settings of the paper's mode, as a file to start from.

use std::process::ExitCode;

use anyhow::Result;

use crate::answers::print;
use crate::paper_settings::DEFAULTS;

pub(crate) fn run() -> Result<ExitCode> {
    print::to_stdout(DEFAULTS)?;
    Ok(ExitCode::SUCCESS)
}
