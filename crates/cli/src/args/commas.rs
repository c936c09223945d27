//! Numbers of one option that were written as several arguments.

use clap::Error;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// The error of an argument that nothing takes, or of a value with too few numbers, which says that commas
/// are wanted where numbers follow one another. No option takes two arguments.
pub(super) fn told(mut error: Error) -> Error {
    let arguments: Vec<String> =
        std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect();
    if matches!(error.kind(), ErrorKind::UnknownArgument | ErrorKind::ValueValidation)
        && let Some(numbers) = in_a_row(&arguments)
    {
        let tip = format!("numbers of one option go together, with commas, as in {numbers}");
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

/// The first numbers that follow one another, with commas.
fn in_a_row(arguments: &[String]) -> Option<String> {
    let mut runs = arguments.chunk_by(|a, b| is_number(a) == is_number(b));
    runs.find(|run| run.len() > 1 && is_number(&run[0])).map(|run| run.join(","))
}

fn is_number(argument: &str) -> bool {
    argument.parse::<f64>().is_ok()
}
