//! `cargo xtask settings`: query time against error, one setting changed at a time.

use std::path::Path;

use anyhow::Result;
use clap::Args;
use cloudtouch_testkit::family::Family;

use crate::answers::Pair;
use crate::measures::Measure;
use crate::methods::{Ours, Paper};
use crate::report::{Page, Section, Table, page};
use crate::sweep::{Asked, Judged, Plan, SEED, ask};

const DEFAULT: &str = "default";
/// Rooms, tables and small things: what users meet.
const FAMILIES: [Family; 3] = [Family::PianoRoom, Family::Furniture, Family::Tabletop];
const POINTS: usize = 5_000;
const STD: f64 = 0.005;

/// What `cargo xtask settings` is given.
#[derive(Args)]
pub struct Arguments {
    /// Draws of each family
    #[arg(long, default_value_t = 6)]
    draws: u32,
    /// Poses of each draw
    #[arg(long, default_value_t = 28)]
    poses: usize,
    /// Write docs/lab/settings.md; else it goes to target/lab/
    #[arg(long)]
    update_docs: bool,
}

/// Asks the defaults and every change, and writes the page.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Arguments { draws, poses, update_docs } = *arguments;
    let changed = |(name, change): (&str, Change)| -> Result<Asked> {
        let mut ours = Ours::new(name)?;
        change(&mut ours);
        Ok(Asked::always(ours))
    };
    let mut asked: Vec<Asked> = SETTINGS.into_iter().map(changed).collect::<Result<_>>()?;
    asked.push(Asked::always(Paper::new("mode paper")));
    let plan = Plan {
        pairs: vec![Pair::CloudCloud],
        ..Plan::of(FAMILIES.map(Into::into).to_vec(), draws, poses, POINTS, STD)
    };
    let answers = ask(&plan, &asked)?;
    let names: Vec<&str> = answers.methods.iter().map(String::as_str).collect();
    let judged = Judged::pick(&answers, &names, |_| true);
    let (count, collisions) = judged.counts();
    let introduction = format!(
        "Each row changes one setting of the default: the largest leaf (n_max), the relative gap at which a kernel problem \
         counts as solved (tolerance), the kernel's width γ and penalty C; the last is the paper's \
         mode. Families {}; {POINTS} points a cloud, {} mm of noise; {count} poses, {collisions} of \
         them collisions, the same clouds for all. Differences are paired, in bold where the 95 % \
         interval excludes zero; as many queries run at a time as there are cores.",
        FAMILIES.map(Family::name).join(", "),
        1e3 * STD
    );
    let command = format!("--draws {draws} --poses {poses} --update-docs");
    let title = ("settings", "Speed and error over settings");
    let mut page = Page::new(title, ("settings", &command), &introduction, root, SEED);
    page.section(Section::new("One change at a time").text(table(&judged, &names)));
    page.write(&page::folder(root, update_docs))
}

/// A setting that is changed.
type Change = fn(&mut Ours);

/// The defaults first, then one change at a time.
const SETTINGS: [(&str, Change); 13] = [
    (DEFAULT, |_| {}),
    ("n_max 20", |ours| ours.tree.max_leaf_points = 20),
    ("n_max 40", |ours| ours.tree.max_leaf_points = 40),
    ("tolerance 1e-1", |ours| ours.query.relative_gap = 1e-1),
    ("tolerance 1e-2", |ours| ours.query.relative_gap = 1e-2),
    ("γ 1", |ours| ours.query.gamma = 1.0),
    ("γ 3", |ours| ours.query.gamma = 3.0),
    ("γ 20", |ours| ours.query.gamma = 20.0),
    ("γ 40", |ours| ours.query.gamma = 40.0),
    ("C 1", |ours| ours.query.penalty = 1.0),
    ("C 10", |ours| ours.query.penalty = 10.0),
    ("C 1000", |ours| ours.query.penalty = 1000.0),
    ("γ 1, C 1", |ours| (ours.query.gamma, ours.query.penalty) = (1.0, 1.0)),
];

fn table(judged: &Judged<'_>, names: &[&str]) -> Table {
    let header = "setting, median (ms), p95 (ms), Brier, minus default, AUC, minus default";
    let mut table = Table::new(header.split(", "));
    for name in names {
        let mut row = vec![(*name).to_owned()];
        row.extend([0.5, 0.95].map(|share| format!("{:.2}", judged.query_ms(name, share))));
        for measure in [Measure::Brier, Measure::Auc] {
            row.push(judged.estimate(name, measure).to_string());
            row.push(judged.compared(name, DEFAULT, measure));
        }
        table.row(row);
    }
    table
}
