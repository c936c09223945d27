//! The document docs/lab/accuracy.md, wholly made by a run.

use std::{fmt::Write as _, path::Path};

use anyhow::Result;

use super::{SEED, tables::Section};
use crate::common::{files::write_whole, machine};

/// What the document says before the tables.
const INTRODUCTION: &str = "Every method answers the same poses of generated scenes whose exact \
answer is known from their meshes (parry3d in double precision, checked against a brute-force \
triangle test). For every condition and pose both clouds are drawn anew. Nine families of scenes \
in four variants each: a piano in a furnished room, a gripper (known mesh) against household \
objects in a simulated depth image, a ball and a wedge on a plate, crossing sheets, a peg in a \
hole, interlocked tori, a board of 2 cm, and assembled furniture. Half of the poses are within \
3 cm of contact, half collide. Contacts at surface that no sensor sees are left out: no method could \
tell them.

Methods: `calibrated` is what users get by default, its constants fitted on the other families \
(`cargo xtask calibrate`), `oracle` the same given noise-free points and true normals, `paper` the \
method as printed. The others are alternatives: the smallest or 5th smallest distance of the clouds, as measured or after our own \
surface fit, in units of noise and spacing; 1 cm boxes around the points of the scene against \
those of the object, or against its exact mesh, which the cloud methods do not see; a support \
vector machine without robust terms. Alternatives without a probability get one by a logistic function of their score, \
fitted on the other families.

`a [b, c]` is a value with its 95 % bootstrap interval; poses are resampled, with all conditions of \
a pose together. False stops: the share of free poses that a threshold stops which misses at most \
so many of the collisions. ECE is over 15 bins; chance alone makes it positive.";

/// The figures: file, title, what to see in it.
const FIGURES: [[&str; 3]; 5] = [
    [
        "sweep-distance.svg",
        "Probability and distance",
        "After the paper's figure 4: a hundred \
      queries at two noise levels, with their regression curve.",
    ],
    [
        "sweep-reliability.svg",
        "Reliability",
        "Observed rate of collisions against stated \
      probability; below, how many answers.",
    ],
    ["sweep-roc.svg", "ROC", "Collisions found against free poses stopped."],
    ["sweep-noise.svg", "AUC and Brier score against noise", "All families and densities pooled."],
    [
        "sweep-speed.svg",
        "Speed against error",
        "Median query time against the Brier score and 1 − AUC.",
    ],
];

/// The whole text.
pub(super) fn text(root: &Path, poses: usize, sections: &[Section]) -> Result<String> {
    let mut text = String::from(
        "# Accuracy\n\n\
         <!-- Made by `cargo xtask sweep --update-docs`; edit xtask/src/sweep/, not this. -->\n\n",
    );
    writeln!(
        text,
        "{INTRODUCTION}\n\n```text\ncargo run --release -p xtask -- sweep --poses {poses} --update-docs\n```\n"
    )?;
    writeln!(text, "{}", machine::provenance(root, SEED))?;
    for [file, title, caption] in FIGURES {
        writeln!(text, "## {title}\n\n{caption}\n\n![{title}](figures/{file})\n")?;
    }
    for section in sections {
        writeln!(text, "## {}\n\n{}\n", section.title, section.text.trim_end())?;
    }
    Ok(text.trim_end().to_owned() + "\n")
}

/// Writes the document.
pub(super) fn write(root: &Path, text: &str) -> Result<()> {
    write_whole(&root.join("docs/lab/accuracy.md"), text)
}
