//! `cargo xtask bench-report`: how fast ours and its peers are on the same scenes, against the
//! targets.

mod batch;
mod document;
mod first_query;
mod growth;
mod memory;
mod method;
mod parts;
mod plan;
mod plots;
mod poses;
mod room;
mod scene;
mod solvers;
mod stream;
mod target;
mod timing;

use std::{
    fs,
    path::{Path, PathBuf},
    time::Instant,
};

use anyhow::{Context, Result};
use clap::Args;
use rayon::ThreadPoolBuilder;

use parts::Part;
use plan::Plan;
use scene::Scene;
use target::Target;

/// What `cargo xtask bench-report` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Poses of the piano in the room; fewer than 30 make everything else small too
    #[arg(long, default_value_t = 100)]
    poses: usize,
    /// Everything random comes from this
    #[arg(long, default_value_t = 2011)]
    seed: u64,
    /// Write docs/lab/performance.md and its figures; else everything goes to target/bench-report/
    #[arg(long, conflicts_with = "only")]
    update_docs: bool,
    /// Folder of the real scans, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// Measure these parts only
    #[arg(long, value_name = "PART", value_delimiter = ',')]
    only: Vec<Part>,
    /// Measures the memory of one cloud in this process, as the run asks of a child
    #[arg(long, hide = true, value_name = "FILE")]
    probe_memory: Option<PathBuf>,
}

/// What a part has found.
#[derive(Default)]
struct Section {
    title: &'static str,
    text: String,
    targets: Vec<Target>,
}

/// What every part is given.
struct Run<'a> {
    root: &'a Path,
    data: PathBuf,
    /// Where figures go.
    figures: PathBuf,
    seed: u64,
    plan: Plan,
    scene: Scene,
}

/// Measures, prints the document, and writes it with its figures.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    if let Some(file) = &arguments.probe_memory {
        return memory::probe(file);
    }
    let folder = root.join(if arguments.update_docs { "docs/lab" } else { "target/bench-report" });
    let figures = folder.join("figures");
    // What is there of a document that is being made, or of one whose run was broken off.
    let draft = root.join("target/bench-report");
    for place in [&figures, &draft] {
        fs::create_dir_all(place).with_context(|| format!("make {}", place.display()))?;
    }
    let plan = Plan::of(arguments.poses);
    let start = Instant::now();
    let done = |what: &str| {
        eprintln!("bench-report: {what} done after {:.0} s", start.elapsed().as_secs_f64());
    };
    let scene = Scene::draw(arguments.poses, arguments.seed)?;
    done("poses");
    let data = root.join(&arguments.data);
    let run = Run { root, data, figures, seed: arguments.seed, plan, scene };
    // Whatever uses rayon gets one thread; the batch brings pools of its own.
    let alone = ThreadPoolBuilder::new().num_threads(1).build().context("start a thread")?;
    let mut sections = Vec::new();
    for part in Part::ALL {
        if !arguments.only.is_empty() && !arguments.only.contains(&part) {
            continue;
        }
        let measured = alone.install(|| part.measure(&run));
        sections.push(measured.with_context(|| format!("measure {}", part.name()))?);
        document::write(&draft, &document::text(&run, arguments, &sections)?)?;
        done(part.name());
    }
    let text = document::text(&run, arguments, &sections)?;
    print!("{text}");
    document::write(&folder, &text)
}
