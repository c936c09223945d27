//! The command: its arguments, its parts in order, and the page.

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use rayon::ThreadPoolBuilder;

use super::{
    batch, first_query, frames, growth, memory, prepared,
    scene::Scene,
    solvers,
    target::{self, Findings},
};
use crate::{
    page::{self, Page, Section},
    real_scans::cases,
};

/// What `cargo xtask bench-report` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Poses of the piano in the room
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u16).range(6..))]
    poses: u16,
    /// Everything random comes from this
    #[arg(long, default_value_t = 2011)]
    seed: u64,
    /// Write docs/lab/performance.md and its figures; else everything goes to target/lab/
    #[arg(long, conflicts_with = "only")]
    update_docs: bool,
    /// Folder of the real scans, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// Measure these parts only
    #[arg(long, value_name = "PART", value_delimiter = ',')]
    only: Vec<Part>,
    /// Measures the memory of one cloud in this process, as the run asks of a child
    #[arg(long, hide = true, value_name = "FOLDER")]
    probe_memory: Option<PathBuf>,
}

/// A part of a run that can be measured alone, in the order of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Prepared queries of the piano in the room, beside the peers.
    Prepared,
    /// The first query of two fresh clouds.
    FirstQuery,
    /// Depth frames with a gripper.
    Frames,
    /// Leaf problems, beside other solvers.
    Solvers,
    /// Larger and larger scenes.
    Growth,
    /// Many poses on two threads.
    Batch,
}

impl Part {
    fn measure(self, scene: &Scene, data: Option<&Path>) -> Findings {
        match self {
            Self::Prepared => prepared::measure(scene),
            Self::FirstQuery => first_query::measure(scene),
            Self::Frames => frames::measure(scene, data),
            Self::Solvers => solvers::measure(scene),
            Self::Growth => growth::measure(scene),
            Self::Batch => batch::measure(scene),
        }
    }
}

const INTRODUCTION: &str = "How long queries, preparation and the solver take, beside other \
libraries on the same scenes in the same run. Times are wall times of single calls on one thread, \
but for the batch. Methods that are compared take turns, so that a slow minute of the machine slows \
all of them. No speed without its error: each table of times of methods has one of what they get \
wrong on the same poses. Speed against error over the settings is in [settings.md](settings.md), and \
over methods and noises in [accuracy.md](accuracy.md): a point on the front there is a setting that \
nothing else beats in both.";

/// Why targets are missed, where they are.
const MISSED: &str = "Where targets are missed, it is for these reasons. *Exact meshes*: parry3d is \
told the surfaces and stops at the first triangles that cut; a probability needs every place within \
three standard deviations, and samples 10 cm apart stand for discs that reach as far. Between the \
search and the training of the classifier the time of a query is about halved (`geometry alone` \
below). *Fresh clouds and frames*: the noise model, a robust fit over up to 60 neighbours for every \
point a query comes near, takes most of the first query; at noise of several spacings (the stereo \
scan) it looks at a thousand neighbours. Index and tree take most of preparation. *Hard leaf \
problems*: SMO gives up on all of them, and the interior point method that takes over is cubic in \
the points. *Memory*: positions, covariances, boxes and what queries have computed are all kept, in \
double precision.";

/// Measures and writes the page with its figures.
///
/// # Errors
/// When a part cannot be measured or the page not be written.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    if let Some(folder) = &arguments.probe_memory {
        return memory::probe(folder);
    }
    let Arguments { poses, seed, update_docs, .. } = *arguments;
    let start = Instant::now();
    let done = |what: &str| {
        eprintln!("bench-report: {what} done after {:.0} s", start.elapsed().as_secs_f64());
    };
    let scene = Scene::draw(poses.into(), seed)?;
    done("poses");
    // Whatever uses rayon gets one thread; the batch brings pools of its own.
    let alone = ThreadPoolBuilder::new().num_threads(1).build().context("start a thread")?;
    let data = cases::folder(root, &arguments.data);
    let (mut sections, mut targets) = (Vec::new(), Vec::new());
    let mut command = format!("--poses {poses} --seed {seed} --update-docs");
    for &part in Part::value_variants() {
        if !arguments.only.is_empty() && !arguments.only.contains(&part) {
            command = format!("--poses {poses} --seed {seed} --only ...");
            continue;
        }
        let measured = alone.install(|| part.measure(&scene, data.as_deref()));
        let (section, judged) = measured.with_context(|| format!("measure {part:?}"))?;
        sections.push(section);
        targets.extend(judged);
        done(&format!("{part:?}"));
    }
    let names = ("performance", "Performance");
    let mut page = Page::new(names, ("bench-report", &command), INTRODUCTION, root, seed);
    page.section(Section::new("Targets").text(target::table(&targets)).text(MISSED));
    sections.into_iter().for_each(|section| page.section(section));
    page.write(&page::folder(root, update_docs))
}
