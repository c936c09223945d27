//! The commands of the documentation run in a clone, and print what stands below them.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeSet;
use std::path::Path;

use assert_cmd::Command;

const PAGES: [&str; 5] =
    ["README.md", "crates/cli/README.md", "docs/use.md", "docs/scenes.md", "docs/robot.md"];

/// A command on files of the repository, and the lines below it.
struct Shown<'a> {
    arguments: Vec<&'a str>,
    lines: Vec<&'a str>,
}

/// What stands in the blocks of a page. Those of commands alone (`sh`) show no lines.
fn shown(page: &str) -> Vec<Shown<'_>> {
    page.split("```").skip(1).step_by(2).flat_map(of_block).collect()
}

fn of_block(block: &str) -> Vec<Shown<'_>> {
    let mut found = Vec::<Shown<'_>>::new();
    let (kind, lines) = block.split_once('\n').unwrap();
    for line in lines.lines().filter(|_| ["sh", "console"].contains(&kind)) {
        let command = line.strip_prefix("$ ").unwrap_or(line);
        if command.starts_with("cloudtouch ") && command.contains("fixtures/") {
            let arguments = command.split_whitespace().skip(1).collect();
            found.push(Shown { arguments, lines: Vec::new() });
        } else if kind == "console"
            && let Some(last) = found.last_mut()
        {
            last.lines.push(line);
        }
    }
    found
}

/// A path, a scene file, a robot and its joints were in no folder.
#[test]
fn commands_of_the_documentation_named_files_that_were_not_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut commands = BTreeSet::new();
    for name in PAGES {
        let page = std::fs::read_to_string(root.join(name)).unwrap();
        for Shown { arguments, lines } in shown(&page) {
            let mut tool = Command::cargo_bin("cloudtouch").unwrap();
            let run = tool.current_dir(&root).args(&arguments).output().unwrap();
            let [out, error] =
                [run.stdout, run.stderr].map(|text| String::from_utf8(text).unwrap());
            assert_eq!((run.status.code(), error.as_str()), (Some(0), ""), "{name}: {arguments:?}");
            let printed: Vec<&str> = out.lines().collect();
            assert!(lines.is_empty() || lines == printed, "{name}: {arguments:?}: {out}");
            commands.insert(arguments[0].to_owned());
        }
    }
    let all = ["batch", "info", "path", "query", "robot", "scene"].map(str::to_owned);
    assert_eq!(commands, BTreeSet::from(all));
}
