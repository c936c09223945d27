//! `cargo xtask bench-report`: times of ours and of its peers on the same scenes, with the errors
//! on the same poses.

mod batch;
mod fresh;
mod growth;
mod paths;
mod room;
mod scene;
mod solvers;
mod timing;
mod turns;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use rayon::ThreadPoolBuilder;

use crate::SEED;
use crate::real_scans::cases;
use crate::report::{Page, Part, page, targets};
use scene::Scene;

/// What `cargo xtask bench-report` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Poses of the piano in the room
    #[arg(long, default_value_t = 100)]
    poses: usize,
    /// Write docs/lab/performance.md; else everything goes to target/lab/
    #[arg(long)]
    update_docs: bool,
    /// Folder of the real scans, from the project's root
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
}

const INTRODUCTION: &str = "How long queries, preparation and the solver take, beside other libraries on the same \
scenes in the same run. Times are wall times of single calls on one thread, but for the batch. Methods that are \
compared take turns, so that a slow minute of the machine slows all of them. No speed without its error: each table \
of times of methods says what they get wrong on the same poses. Speed against error over methods and noises is in \
[accuracy.md](accuracy.md).";

/// Why targets are missed, where they are.
const MISSED: &str = "Where targets are missed, it is for these reasons; profiles, and what was tried, are in \
[decision 42](../decisions/0042-where-the-time-is.md). *Exact meshes*: parry3d is told the surfaces and stops at the \
first triangles that cut; a probability takes every place within 1.5 deviations of the likeliest, though none beyond \
3.5 but that one, and samples 10 cm apart stand for discs that reach far. *Kiddo and capt*: they are told nothing of \
noise and spacing, and rank poses worse; balls stop at the first that touches. *Far*: no coarse map of distances is \
kept of a scene, so that every query goes down both trees. *Deep*, and with it the batch: the search stops at P > \
.999 only. *Refining*: of each point up to 60 neighbours are put in order and fitted four times, and edges and the \
ends of discs come with it. *Boxes and frames*: blurred boxes have their noise model computed everywhere at the first \
query; half of preparing a frame is its tree, and to prepare the stereo scan alone takes as long as all is to take. \
*Leaf problems*: an easy one takes SMO some 220 steps of a third of a microsecond; of the hard ones it finishes none, \
and of the interior point method, though it starts beside what SMO found, every step is cubic in the points. \
*Memory*: scans, index and tree each hold a position of their own.";

/// Measures and writes the page.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Arguments { poses, update_docs, ref data } = *arguments;
    let scene = Scene::draw(poses)?;
    let data = cases::folder(root, data);
    // Whatever uses rayon gets one thread; the batch brings pools of its own.
    let alone = ThreadPoolBuilder::new().num_threads(1).build().context("start a thread")?;
    let parts: [Part<'_>; 6] = [
        ("prepared queries", &|| room::measure(&scene)),
        ("fresh bodies", &|| fresh::measure(&scene, data.as_deref())),
        ("leaf problems", &solvers::measure),
        ("larger scenes", &|| growth::measure(&scene)),
        ("batch", &|| batch::measure(&scene)),
        ("paths", &|| paths::measure(&scene)),
    ];
    let command = ("bench-report", &*format!("--poses {poses} --update-docs"));
    let page = Page::new(("performance", "Performance"), command, INTRODUCTION, root, SEED);
    let folder = page::folder(root, update_docs);
    alone.install(|| targets::report(page, &folder, MISSED, &parts)).map(drop)
}
