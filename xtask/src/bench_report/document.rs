//! The document docs/lab/performance.md, wholly made by a run.

use std::{fmt::Write as _, path::Path};

use anyhow::Result;

use super::{Arguments, Run, Section, parts::Part, target};
use crate::common::{files::write_whole, machine};

/// What the document says first.
const INTRODUCTION: &str = "How long queries, preparation and the solver take, beside other \
libraries on the same scenes in the same run. Times are wall times of single calls on one thread, \
but for the batch. Methods that are compared take turns, so that a slow minute of the machine slows \
all of them. No speed without its error: each table of times of methods has one of what they get \
wrong on the same poses.";

/// Where more is said.
const ELSEWHERE: &str = "Speed against error over the settings is in [settings.md](settings.md), and \
over methods and noises in [accuracy.md](accuracy.md): a point on the front there is a setting that \
nothing else beats in both.";

/// Why targets are missed, where they are.
const MISSED: &str = "Where targets are missed, it is for these reasons. *Exact meshes*: parry3d is \
told the surfaces and stops at the first triangles that cut; a probability needs every place within \
three standard deviations, and samples 10 cm apart stand for discs that reach as far. Between the \
search and the training of the classifier the time of a query is about halved (`geometry alone` \
below). *Fresh clouds and frames*: the noise model, a robust fit over up to 60 neighbours for every \
point a query comes near, takes most of the first query; at noise of several spacings (the stereo \
scan) it looks at a thousand neighbours. Index and tree take most of preparation. *Hard leaf \
problems*: SMO gives up on all of them, and the interior point method that takes over is cubic in \
the points. *Memory*: positions, covariances, boxes and what queries have computed are all kept, in \
double precision.";

/// The whole text.
pub(super) fn text(run: &Run<'_>, arguments: &Arguments, sections: &[Section]) -> Result<String> {
    let mut text = String::from(
        "# Performance\n\n\
         <!-- Made by `cargo xtask bench-report --update-docs`; edit xtask/src/bench_report/, not \
         this. -->\n\n",
    );
    writeln!(text, "{INTRODUCTION} {ELSEWHERE}\n")?;
    writeln!(text, "```text\n{}\n```\n", command(arguments))?;
    if cfg!(debug_assertions) {
        writeln!(text, "**Not a release build: times mean nothing.**\n")?;
    }
    writeln!(text, "{}", machine::provenance(run.root, run.seed))?;
    let targets = target::table(sections.iter().flat_map(|s| &s.targets));
    writeln!(text, "## Targets\n\n{targets}\n{MISSED}\n")?;
    for section in sections {
        writeln!(text, "## {}\n\n{}\n", section.title, section.text.trim_end())?;
    }
    Ok(text.trim_end().to_owned() + "\n")
}

fn command(arguments: &Arguments) -> String {
    let mut command = format!(
        "cargo run --release -p xtask -- bench-report --poses {} --seed {}",
        arguments.poses, arguments.seed
    );
    if !arguments.only.is_empty() {
        let names: Vec<&str> = arguments.only.iter().copied().map(Part::name).collect();
        command += &format!(" --only {}", names.join(","));
    }
    if arguments.update_docs {
        command += " --update-docs";
    }
    command
}

/// Writes the document.
pub(super) fn write(folder: &Path, text: &str) -> Result<()> {
    write_whole(&folder.join("performance.md"), text)
}
