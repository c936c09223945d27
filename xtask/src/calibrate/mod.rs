//! `cargo xtask calibrate`: the constants that turn evidence into a probability.

mod fit;
mod stored;

use std::{collections::BTreeMap, fs, path::Path};

use anyhow::Result;
use clap::Args;

use crate::sweep::{ORACLE, OURS, answer, plan::Plan, record::Answers};
use fit::{Coefficients, fit, records};
pub(crate) use stored::Fitted;

/// What `cargo xtask calibrate` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Poses of each family; the same ones under every condition
    #[arg(long, default_value_t = 32)]
    poses: usize,
    /// Write xtask/recalibration.json
    #[arg(long)]
    update: bool,
}

/// Gathers evidence on all families of clouds and fits: on all, and for each on all others.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let folder = root.join("target/sweep");
    fs::create_dir_all(&folder)?;
    let answers = answer::all(&Plan::evidence(arguments.poses))?;
    answers.write_csv(&folder.join("evidence.csv"))?;
    let fitted = Fitted {
        command: format!("cargo xtask calibrate --poses {}", arguments.poses),
        all: fit(&records(answers.blocks().iter(), OURS)?)?,
        without: without_each(&answers, OURS)?,
        oracle_without: without_each(&answers, ORACLE)?,
    };
    println!("{}", serde_json::to_string_pretty(&fitted)?);
    if arguments.update {
        fitted.write(root)?;
    }
    Ok(())
}

fn without_each(answers: &Answers, method: &str) -> Result<BTreeMap<String, Coefficients>> {
    let mut all = BTreeMap::new();
    for judged in answers.families() {
        let others = answers.blocks().iter().filter(|block| block.condition.family != judged);
        all.insert(judged.to_owned(), fit(&records(others, method)?)?);
    }
    Ok(all)
}
