//! Options that a command does not take and another does.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Error};

/// What concerns the paper's mode, which is not known wherever these are not.
const OF_MODES: [&str; 4] = ["--mode", "--settings", "--pooling", "--seed"];

/// The error of an option that this command does not take, which says whose it is.
pub(super) fn told(mut error: Error, tool: &Command) -> Error {
    if error.kind() == ErrorKind::UnknownArgument
        && let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg)
        && let Some(tip) = tip(option, tool)
    {
        // Clap would name an option that is spelt alike.
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

fn tip(option: &str, tool: &Command) -> Option<String> {
    let name = option.strip_prefix("--")?;
    let takes =
        |command: &&Command| command.get_arguments().any(|arg| arg.get_long() == Some(name));
    let takers: Vec<&str> = tool.get_subcommands().filter(takes).map(Command::get_name).collect();
    let (last, others) = takers.split_last()?;
    if option == "--robot" && std::env::args_os().any(|argument| argument == "robot") {
        return Some("--robot is of a scan without a URDF: give --scan-joints".to_owned());
    }
    let others = others.join(", ");
    let and = if others.is_empty() { "" } else { " and " };
    let mode =
        if OF_MODES.contains(&option) { ", this command of the calibrated mode" } else { "" };
    Some(format!("{option} is of {others}{and}{last}{mode}: leave {option} out"))
}
