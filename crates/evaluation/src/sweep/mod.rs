//! `cargo xtask sweep`: collision probabilities of many scenes, noises and methods against exact
//! truth.

mod ask;
mod camera;
mod judged;
mod pages;
mod plan;
mod scenes;
mod short;
mod stated;
mod tables;
mod targets;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;

pub use ask::{Asked, ask};
pub use judged::Judged;
pub use plan::{GEOMETRY, ORACLE, OURS, Plan};
pub use scenes::Scenes;
pub use short::run as check;
pub use tables::ordinary;

use crate::methods::{Boxes, Distance, Ours, Paper};
use crate::report::page;

/// What `cargo xtask sweep` is given.
#[derive(Args)]
pub struct Arguments {
    /// Draws of each family: a scene of its own, and fresh clouds under every condition
    #[arg(long, default_value_t = 4)]
    draws: u32,
    /// Poses of each draw, half of them collisions
    #[arg(long, default_value_t = 56)]
    poses: usize,
    /// One condition, compared with recorded bounds; what CI runs
    #[arg(long)]
    short: bool,
    /// Folder with real meshes, from the project's root
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// Write docs/accuracy.md, docs/lab/accuracy.md and figures; else everything goes to target/
    #[arg(long, conflicts_with = "short")]
    update_docs: bool,
}

/// Runs the sweep, and writes answers, pages and figures.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Arguments { draws, poses, short, ref data, update_docs } = *arguments;
    if short {
        return check();
    }
    let mut plan = Plan::full(draws, poses);
    plan.families.extend(Scenes::real(&root.join(data))?);
    let answers = ask(&plan, &methods()?)?;
    let folder = page::folder(root, update_docs);
    let arguments = format!("--draws {draws} --poses {poses} --update-docs");
    pages::in_full(root, &arguments, &answers).write(&folder)?;
    let for_users = if update_docs { root.join("docs") } else { folder.join("user") };
    pages::for_users(root, &arguments, &answers, &camera::answers(draws, poses)?).write(&for_users)
}

/// Ours, the oracle, the paper's mode and the alternatives. What takes long answers less: the paper's
/// mode every seventh pose, what smooths every point every second draw.
fn methods() -> Result<Vec<Asked>> {
    let mut paper = Paper::new("paper");
    // A dense cloud beside a large mesh is to be answers, however long that takes.
    paper.query.max_mesh_parts = 1_000_000;
    let smoothed = Asked::always(Distance { smoothed: true });
    Ok(vec![
        Asked::always(Ours::new(OURS)?),
        Asked::always(Ours::oracle(ORACLE)?),
        Asked::always(Ours::new(GEOMETRY)?.without_classifier()),
        Asked::always(Distance { smoothed: false }),
        Asked { draw_of: 2, ..smoothed },
        Asked::always(Boxes),
        Asked { pose_of: 7, ..Asked::always(paper) },
    ])
}
