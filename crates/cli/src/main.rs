//! The `cloudtouch` command: queries, paths, scenes, robots, batches, file information and a demo.

mod answers;
mod args;
mod body;
mod commands;
mod doubt;
mod inside;
mod interrupt;
mod load;
mod margin;
mod ordered;
mod output;
mod pages;
mod paper_settings;
mod picture;
mod progress;
mod remedies;
mod unused;
mod usage;

use std::io::{IsTerminal as _, Write as _};
use std::process::ExitCode;

use cloudtouch_cli::sensor;

use args::{Arguments, Command};
use usage::WrongUsage;

fn main() -> ExitCode {
    let arguments = Arguments::read();
    tracing_subscriber::fmt()
        .with_max_level(arguments.log_level())
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .without_time()
        .init();
    if let Err(error) = interrupt::leave_nothing_behind() {
        tracing::warn!("an interruption may leave a hidden file behind: {error}");
    }
    let shows_work = arguments.shows_work();
    let outcome = match &arguments.command {
        Command::Query(arguments) => commands::query::run(arguments, shows_work),
        Command::Batch(arguments) => commands::batch::run(arguments),
        Command::Path(arguments) => commands::path::run(arguments),
        Command::Scene(arguments) => commands::scene::run(arguments),
        Command::Robot(arguments) => commands::robot::run(arguments),
        Command::Info(arguments) => commands::info::run(arguments),
        Command::Demo(arguments) => commands::demo::run(arguments, shows_work),
        Command::Settings => commands::settings::run(),
    };
    outcome.unwrap_or_else(|error| {
        // When standard error is gone too, the exit code still tells.
        let _ = writeln!(std::io::stderr(), "error: {}", remedies::error(&error));
        if error.is::<WrongUsage>() { ExitCode::from(usage::EXIT_CODE) } else { ExitCode::FAILURE }
    })
}
