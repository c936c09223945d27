//! `cargo xtask evaluate`: the tool's own answers on real scans and on exact mesh poses.

mod approach;
pub(crate) mod case_file;
mod chart;
mod piano;
mod piano_data;
mod real_scans;
mod report;
mod side_view;
mod tool;

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail};
use clap::Args;

use tool::Tool;

/// All randomness of the evaluation comes from this.
const SEED: u64 = 2011;

/// What `cargo xtask evaluate` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Folder with cases.json, piano_cases.json, clouds/ and meshes/, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// Write docs/lab/real-scans.md and its figures; else the figures go to target/evaluate/
    #[arg(long)]
    update_docs: bool,
    /// A built `cloudtouch` to use instead of building it with --release
    #[arg(long, value_name = "PATH")]
    tool: Option<PathBuf>,
}

/// One part of the evaluation, for the terminal and the document alike.
struct Section {
    title: String,
    /// Markdown: paragraphs, tables and figures.
    text: String,
    /// The commands of the tool that gave the numbers.
    commands: Vec<String>,
    /// What should hold and does not.
    failures: Vec<String>,
}

/// Where a run reads and writes.
struct Places {
    data: PathBuf,
    work: PathBuf,
    figures: PathBuf,
}

/// Runs every part, prints it, and fails when a check does.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let data = root.join(&arguments.data);
    if !data.join("cases.json").is_file() || !data.join("piano_cases.json").is_file() {
        println!(
            "skipped: no real scans at {}; put cases.json, piano_cases.json, clouds/ and meshes/ \
             there or name their folder with --data DIR",
            arguments.data.display()
        );
        return Ok(());
    }
    let work = root.join("target/evaluate");
    let figures =
        if arguments.update_docs { root.join("docs/lab/figures") } else { work.join("figures") };
    for folder in [&work, &figures] {
        fs::create_dir_all(folder).with_context(|| format!("make {}", folder.display()))?;
    }
    let tool = Tool::find(root, arguments.tool.as_deref())?;
    let places = Places { data: data.canonicalize()?, work, figures };

    let mut sections = Vec::new();
    for part in [real_scans::evaluate, approach::evaluate, piano::evaluate] {
        let section = part(&tool, &places)?;
        println!("## {}\n\n{}", section.title, section.text);
        sections.push(section);
    }
    if arguments.update_docs {
        report::write(root, &tool, &sections)?;
    }
    let failures: Vec<&str> =
        sections.iter().flat_map(|s| &s.failures).map(String::as_str).collect();
    if !failures.is_empty() {
        bail!("{} checks failed\n  {}", failures.len(), failures.join("\n  "));
    }
    println!("evaluate: all checks hold");
    Ok(())
}
