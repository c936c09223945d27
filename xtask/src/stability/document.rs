//! The document docs/lab/stability.md, wholly made by a run.

use std::{fmt::Write as _, path::Path};

use anyhow::Result;

use super::{SEED, sheet::Sheet};
use crate::common::{files::write_whole, machine, table::Table};

/// What the document says before the tables.
const INTRODUCTION: &str = "What the solver, the hierarchy and whole queries do with input that \
breaks careless numerics: no panic, no number that is not one, bounded work, and a verdict that is \
right or says that it is none. Apart from the times every number is the same in each run.";

/// The whole text.
pub(super) fn text(root: &Path, sheet: &Sheet) -> Result<String> {
    let mut text = String::from(
        "# Numerical stability\n\n\
         <!-- Made by `cargo xtask stability --update-docs`; edit xtask/src/stability/, not this. -->\n\n",
    );
    writeln!(text, "{INTRODUCTION}\n\n```text\ncargo xtask stability --update-docs\n```\n")?;
    writeln!(text, "{}", machine::provenance(root, SEED))?;
    writeln!(text, "## Goals\n\n{}", goals(sheet))?;
    if !sheet.faults.is_empty() {
        writeln!(text, "## Faults\n")?;
        for fault in &sheet.faults {
            writeln!(text, "- {fault}")?;
        }
        writeln!(text)?;
    }
    for section in &sheet.sections {
        writeln!(text, "## {}\n\n{}\n", section.title, section.text.trim_end())?;
    }
    Ok(text.trim_end().to_owned() + "\n")
}

fn goals(sheet: &Sheet) -> Table {
    let mut table = Table::new(&["goal", "measured", "met"]);
    for goal in &sheet.goals {
        let met = if goal.met { "yes" } else { "**no**" };
        table.row([goal.what.clone(), goal.measured.clone(), met.into()]);
    }
    let sound = format!("{} faults", sheet.faults.len());
    let all = "no panic, no number that is not one, no wrong verdict, bounded steps";
    let met = if sheet.faults.is_empty() { "yes" } else { "**no**" };
    table.row([all.into(), sound, met.into()]);
    table
}

/// Writes the document.
pub(super) fn write(root: &Path, text: &str) -> Result<()> {
    write_whole(&root.join("docs/lab/stability.md"), text)
}
