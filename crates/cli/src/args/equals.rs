//! A number behind an option that takes none there: a flag, or one whose value is written with `=`.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};

/// The error of an argument that nothing takes, which says how the option before a number is written.
pub(super) fn told(mut error: Error, tool: &Command) -> Error {
    let arguments: Vec<String> =
        std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
    if error.kind() == ErrorKind::UnknownArgument
        && let Some(tip) = tip(&arguments, tool)
    {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

fn tip(arguments: &[String], tool: &Command) -> Option<String> {
    let command = arguments.iter().find_map(|argument| tool.find_subcommand(argument))?;
    arguments.windows(2).find_map(|pair| {
        let [option, number] = pair else { return None };
        let name = option.strip_prefix("--")?;
        // Of several, or with a comma for the point, all are.
        number.split(',').try_for_each(|part| part.parse::<f64>().map(|_| ())).ok()?;
        let is_named = |arg: &&Arg| arg.get_long() == Some(name);
        let arg = command.get_arguments().find(is_named)?;
        if arg.is_require_equals_set() {
            Some(format!("a value of {option} is written with `=`: {option}={number}"))
        } else if !arg.get_action().takes_values() {
            Some(format!("{option} takes no value: leave {number} out"))
        } else {
            None
        }
    })
}
