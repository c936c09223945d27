//! Pages of `docs/lab/`, each wholly made by one command.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use cloudtouch_io::write_atomically;

use super::figure::Figure;
use super::machine;

/// What a run says, in order; a page is a Markdown file and its figures.
#[derive(Debug)]
pub struct Page {
    name: String,
    head: String,
    sections: Vec<Section>,
}

/// A heading, text and figures.
#[derive(Debug)]
pub struct Section {
    text: String,
    /// Name of the file without `.svg`, and what it shows.
    figures: Vec<(String, Figure)>,
}

/// Where pages go: `docs/lab` when the docs are to be made anew, else `target/lab`.
pub fn folder(root: &Path, update_docs: bool) -> PathBuf {
    root.join(if update_docs { "docs/lab" } else { "target/lab" })
}

impl Page {
    /// A page `NAME.md` that says at its top which xtask made it (`task`), with which command
    /// (arguments included), where, when and from which seed.
    pub fn new(
        (name, title): (&str, &str),
        (task, arguments): (&str, &str),
        introduction: &str,
        root: &Path,
        seed: u64,
    ) -> Self {
        let debug = if cfg!(debug_assertions) {
            "\n**Not a release build: times mean nothing.**\n"
        } else {
            ""
        };
        let command = format!("cargo run --release -p xtask -- {task} {arguments}");
        let (command, provenance) = (command.trim_end(), machine::provenance(root, seed));
        let head = format!(
            "# {title}\n\n<!-- Made by `cargo xtask {task}`; edit crates/evaluation/, not this. -->\n\n\
             {introduction}\n\n```text\n{command}\n```\n{debug}\n{provenance}"
        );
        Self { name: name.to_owned(), head, sections: Vec::new() }
    }

    /// Adds a section.
    pub fn section(&mut self, section: Section) {
        self.sections.push(section);
    }

    /// Writes `NAME.md` and `figures/*.svg` into the folder, each file whole.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let figures = folder.join("figures");
        fs::create_dir_all(&figures).with_context(|| format!("create {}", figures.display()))?;
        for (name, figure) in self.sections.iter().flat_map(|section| &section.figures) {
            let svg = figure.svg()?;
            write_atomically(figures.join(format!("{name}.svg")), |out| {
                out.write_all(svg.as_bytes())
            })?;
        }
        let path = folder.join(format!("{}.md", self.name));
        let sections = self.sections.iter().map(|section| section.text.trim_end());
        let parts: Vec<&str> = std::iter::once(self.head.trim_end()).chain(sections).collect();
        write_atomically(&path, |out| writeln!(out, "{}", parts.join("\n\n")))?;
        println!("wrote {}", path.display());
        Ok(())
    }
}

impl Section {
    /// Starts a section of the second level.
    pub fn new(title: &str) -> Self {
        Self { text: format!("## {title}\n\n"), figures: Vec::new() }
    }

    /// Adds a paragraph, a list, a table or a heading of a lower level.
    #[must_use]
    pub fn text(mut self, text: impl fmt::Display) -> Self {
        self.text += text.to_string().trim_end();
        self.text += "\n\n";
        self
    }

    /// Adds a figure `figures/NAME.svg`, with what it shows for those who cannot see it.
    #[must_use]
    pub fn figure(self, name: &str, shows: &str, figure: Figure) -> Self {
        let mut section = self.text(format_args!("![{shows}](figures/{name}.svg)"));
        section.figures.push((name.to_owned(), figure));
        section
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Axis, Panel, Series};

    #[test]
    fn a_page_and_its_figures_are_written_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let (x, y) = (Axis::linear("x (m)"), Axis::linear("y (m)"));
        let panel = Panel { title: "a".into(), x, y, series: vec![Series::points("a", [])] };
        let names = (("test", "Test"), ("try", "--seed 3"));
        let mut page = Page::new(names.0, names.1, "Says why.", folder.path(), 3);
        let section = Section::new("First").text("Before.\n").figure(
            "one",
            "One point",
            Figure::new("One", [panel]),
        );
        page.section(section.text("After."));
        page.write(folder.path()).unwrap();
        let text = fs::read_to_string(folder.path().join("test.md")).unwrap();
        let end = "## First\n\nBefore.\n\n![One point](figures/one.svg)\n\nAfter.\n";
        assert!(text.starts_with("# Test\n\n<!-- Made by `cargo xtask try`;"), "{text}");
        assert!(text.contains("\ncargo run --release -p xtask -- try --seed 3\n"), "{text}");
        assert!(text.contains("\n- seed: 3\n\n") && text.ends_with(end), "{text}");
        assert!(folder.path().join("figures/one.svg").exists());
    }
}
