//! The document docs/lab/real-scans.md, wholly made by a run.

use std::{fmt::Write as _, path::Path};

use anyhow::Result;

use super::{SEED, Section, tool::Tool};
use crate::common::{files::write_whole, machine};

/// Writes the document; every number in it comes from this run.
pub(super) fn write(root: &Path, tool: &Tool, sections: &[Section]) -> Result<()> {
    let path = root.join("docs/lab/real-scans.md");
    write_whole(&path, text(root, tool, sections)?)?;
    println!("wrote {}", path.display());
    Ok(())
}

fn text(root: &Path, tool: &Tool, sections: &[Section]) -> Result<String> {
    let mut text = String::from(
        "# Answers on real scans\n\n\
         <!-- Made by `cargo xtask evaluate --update-docs`; edit xtask/src/evaluate/, not this. -->\n\n\
         What the `cloudtouch` tool answers on real point clouds with labelled poses, along an \
         approach of a gripper to a mug, and on sampled meshes whose exact answers are known. This \
         whole page and its figures come from one run:\n\n\
         ```text\ncargo xtask evaluate --data DIR --update-docs\n```\n\n",
    );
    writeln!(text, "- date: {}", machine::date())?;
    writeln!(text, "- commit: {}", machine::commit(root))?;
    writeln!(text, "- machine: {}; the tool runs on one thread", machine::processor())?;
    writeln!(text, "- tool: {}", tool.build)?;
    writeln!(text, "- seed of samples and noise: {SEED}")?;
    let failures: Vec<&String> = sections.iter().flat_map(|s| &s.failures).collect();
    if failures.is_empty() {
        writeln!(text, "- checks: all hold")?;
    } else {
        writeln!(text, "- checks that failed: {}", failures.len())?;
        for failure in failures {
            writeln!(text, "  - {failure}")?;
        }
    }
    text += "\nDIR is the folder of the scans, which are not part of the project.\n";
    for section in sections {
        writeln!(text, "\n## {}\n\n{}", section.title, section.text.trim_end())?;
        writeln!(text, "\n```text\n{}\n```", section.commands.join("\n"))?;
    }
    Ok(text)
}
