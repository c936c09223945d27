//! The `cloudtouch` command: queries, batches, file information and a demo.

mod args;
mod case_file;
mod commands;
mod load;
mod picture;
mod pose_file;
mod print;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    tracing_subscriber::fmt()
        .with_max_level(arguments.log_level())
        .with_writer(std::io::stderr)
        .init();
    let outcome = match &arguments.command {
        Command::Query(arguments) => commands::query::run(arguments),
        Command::Batch(arguments) => commands::batch::run(arguments),
        Command::Info(arguments) => commands::info::run(arguments),
        Command::Demo(arguments) => commands::demo::run(arguments),
    };
    match outcome {
        Ok(code) => code,
        Err(error) if is_closed_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// `cloudtouch … | head` is no reason to complain.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<std::io::Error>()
            .is_some_and(|e| e.kind() == std::io::ErrorKind::BrokenPipe)
    })
}
