//! What is to be reached, and whether it was: reports of parts that each bring targets.

use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::page::{Page, Section};
use super::table::Table;

/// A target with what was measured of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    what: String,
    measured: String,
    met: bool,
}

/// What a part of a report finds.
pub type Findings = Result<(Section, Vec<Target>)>;

impl Target {
    /// Whether it is met is a comparison that what is no number does not pass.
    pub fn new(what: impl Into<String>, measured: impl Into<String>, met: bool) -> Self {
        Self { what: what.into(), measured: measured.into(), met }
    }
}

/// All targets in a table, and how many are met.
pub fn section(targets: &[Target]) -> Section {
    let mut table = Table::new(["target", "measured", "met"]);
    for Target { what, measured, met } in targets {
        table.row([what.as_str(), measured, if *met { "yes" } else { "**no**" }]);
    }
    let met = targets.iter().filter(|target| target.met).count();
    Section::new("Targets").text(format_args!("{met} of {} are met.", targets.len())).text(table)
}

/// A part of a report: its name, and what measures it.
pub type Part<'a> = (&'static str, &'a (dyn Fn() -> Findings + Sync));

/// Measures the parts one after the other, and writes a page of all targets, a note on them, and
/// what was found.
pub fn report(
    mut page: Page,
    folder: &Path,
    note: &str,
    parts: &[Part<'_>],
) -> Result<Vec<Target>> {
    let (mut sections, mut targets) = (Vec::new(), Vec::new());
    for (name, measure) in parts {
        let (section, of_part) = measure().with_context(|| format!("measure {name}"))?;
        eprintln!("{name} done");
        sections.push(section);
        targets.extend(of_part);
    }
    page.section(section(&targets).text(note));
    sections.into_iter().for_each(|section| page.section(section));
    page.write(folder)?;
    Ok(targets)
}

/// For reports that judge: a target that is missed is a failure.
///
/// # Errors
/// When a target is missed.
pub fn require(targets: &[Target]) -> Result<()> {
    let missed = targets.iter().filter(|target| !target.met);
    let missed: Vec<String> = missed.map(|t| format!("{}: {}", t.what, t.measured)).collect();
    ensure!(missed.is_empty(), "missed: {}", missed.join("\n  "));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_missed_target_is_a_failure_and_named() {
        let [met, missed] = [true, false].map(|met| Target::new("t", format!("{met}"), met));
        assert!(require(&[met.clone(), met.clone()]).is_ok());
        assert_eq!(require(&[met, missed]).unwrap_err().to_string(), "missed: t: false");
    }
}
