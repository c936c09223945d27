//! `cloudtouch settings`: all settings of the paper's mode, as a file to start from.

use std::process::ExitCode;

use anyhow::Result;

use crate::answers::print;
use crate::load;

pub(crate) fn run() -> Result<ExitCode> {
    print::to_stdout(load::settings::DEFAULTS)?;
    Ok(ExitCode::SUCCESS)
}
