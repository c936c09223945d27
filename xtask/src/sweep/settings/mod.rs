//! `cargo xtask settings`: query time against error, one setting changed at a time.

mod answers;
mod changes;
mod plot;

use std::{fmt::Write as _, fs, path::Path};

use anyhow::{Context, Result};
use clap::Args;

use super::{
    SEED,
    measures::{Bootstrap, Judged, Measure, Measured, measure},
    plots::{Tradeoff, pareto::on_front},
};
use crate::common::{files::write_whole, machine, table::Table};
use answers::{FAMILIES, POINTS, STD, ask};
use changes::Setting;

/// What `cargo xtask settings` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Poses of each family
    #[arg(long, default_value_t = 64)]
    poses: usize,
    /// Write docs/lab/settings.md and its figure; else everything goes to target/settings/
    #[arg(long)]
    update_docs: bool,
}

/// Asks every setting, prints the table and draws the figure.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let settings = changes::all();
    let answers = ask(&settings, arguments.poses)?;
    let names: Vec<String> = settings.iter().map(Setting::name).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let judged = Judged::pick(&answers, &names, |_, _| true);
    let samples: Vec<_> =
        judged.methods.iter().map(|m| m.0.clone()).zip(judged.samples()).collect();
    let wanted = [Measure::Auc, Measure::Brier];
    let measured = measure(&samples, &wanted, &judged.clusters, Bootstrap::new(SEED));
    let tradeoffs = tradeoffs(&settings, &judged, &measured)?;

    let update = arguments.update_docs;
    let figures = root.join(if update { "docs/lab/figures" } else { "target/settings" });
    fs::create_dir_all(&figures).with_context(|| format!("make {}", figures.display()))?;
    plot::draw(&figures.join("settings.svg"), &settings, &tradeoffs)?;
    let table = table(&settings, &tradeoffs, &judged, &measured);
    let text = text(root, arguments.poses, &judged, &table)?;
    print!("{text}");
    let folder = if update { root.join("docs/lab") } else { figures };
    write_whole(&folder.join("settings.md"), text)
}

fn tradeoffs(settings: &[Setting], judged: &Judged, measured: &Measured) -> Result<Vec<Tradeoff>> {
    let tradeoff = |(number, setting): (usize, &Setting)| {
        let name = setting.name();
        let estimate = |m| measured.estimate(&name, m).context("every setting is measured");
        Ok(Tradeoff {
            query_ms: judged.query_ms(&name, 0.5),
            brier: estimate(Measure::Brier)?,
            auc: estimate(Measure::Auc)?,
            is_default: number == 0,
            name,
        })
    };
    settings.iter().enumerate().map(tradeoff).collect()
}

fn table(
    settings: &[Setting],
    tradeoffs: &[Tradeoff],
    judged: &Judged,
    measured: &Measured,
) -> Table {
    let front = |error: &dyn Fn(&Tradeoff) -> f64| {
        on_front(&tradeoffs.iter().map(|t| (t.query_ms, error(t))).collect::<Vec<_>>())
    };
    let fronts = front(&|t| t.brier.value).into_iter().zip(front(&|t| 1.0 - t.auc.value));
    let mut table = Table::new(&[
        "changed",
        "value",
        "median (ms)",
        "p95 (ms)",
        "Brier",
        "minus default",
        "AUC",
        "minus default",
        "on the front of",
    ]);
    for (((setting, tradeoff), front), number) in
        settings.iter().zip(tradeoffs).zip(fronts).zip(0..)
    {
        let difference = |m| match measured.difference(&tradeoff.name, &tradeoffs[0].name, m) {
            Some(e) if number > 0 && e.excludes_zero() => format!("**{e:+}**"),
            Some(e) if number > 0 => format!("{e:+}"),
            _ => String::new(),
        };
        let fronts = [(front.0, "Brier"), (front.1, "AUC")];
        let fronts: Vec<&str> =
            fronts.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
        table.row([
            setting.changed.to_owned(),
            setting.value.clone(),
            format!("{:.2}", tradeoff.query_ms),
            format!("{:.2}", judged.query_ms(&tradeoff.name, 0.95)),
            tradeoff.brier.to_string(),
            difference(Measure::Brier),
            tradeoff.auc.to_string(),
            difference(Measure::Auc),
            fronts.join(", "),
        ]);
    }
    table
}

fn text(root: &Path, poses: usize, judged: &Judged, table: &Table) -> Result<String> {
    let (count, collisions) = judged.counts();
    let families = FAMILIES.map(|family| format!("`{}`", family.name())).join(", ");
    let mut text = format!(
        "# Speed and error over settings\n\n\
         <!-- Made by `cargo xtask settings --update-docs`; edit xtask/src/sweep/settings/, not \
         this. -->\n\n\
         Each row changes one setting of the calibrated default: the largest leaf (n_max), the \
         highest variation of a leaf (σ_max), the probability below which pairs of boxes are \
         culled (ε), the relative gap at which a kernel problem counts as solved (tolerance), the \
         kernel's width γ and penalty C, the traversal, and the mode. Families {families}; \
         {POINTS} points a cloud, {:.0} mm of noise; {count} poses, {collisions} of them \
         collisions, all settings on the same clouds.\n\n\
         Times are of one thread, the least of three equal queries after a first one: what is \
         computed once for all poses is there. `a [b, c]` is a value with its 95 % bootstrap \
         interval over poses; differences are paired, in bold where the interval excludes zero. On \
         the front: no other row is at most as slow and at most as wrong.\n\n\
         ```text\ncargo run --release -p xtask -- settings --poses {poses} --update-docs\n```\n\n",
        1e3 * STD,
    );
    writeln!(text, "{}", machine::provenance(root, SEED))?;
    writeln!(
        text,
        "Labels in the figure are the values; those next to the default are left out. The scale \
         of the errors is fine: see the intervals below.\n\n\
         ![Speed against error](figures/settings.svg)\n\n{table}"
    )?;
    Ok(text.trim_end().to_owned() + "\n")
}
