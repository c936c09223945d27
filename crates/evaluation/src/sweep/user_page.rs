//! docs/accuracy.md: what a user needs to know.

use std::path::Path;

use super::{plan::SEED, stated};
use crate::{
    answers::{Answers, Pair},
    page::{Page, Section},
};

const INTRODUCTION: &str = "How often is cloudtouch right in scenes as users have them: furnished \
rooms, desks, kitchen counters, bins, workbenches, corridors and stairs? Scenes are generated, so \
that the exact answer is known from their meshes; each family of scenes is judged with constants \
fitted on the other families. Half of the poses collide and half are within 3 cm of contact: far \
harder, and with far more collisions, than what a planner meets. Hard cases by design, other \
methods, families one by one, intervals and targets are in [the full report](lab/accuracy.md); \
[what a probability means](probability.md) says what none of this can show.";

pub(super) fn page(root: &Path, arguments: &str, answers: &Answers) -> Page {
    let title = ("accuracy", "Accuracy");
    let mut page = Page::new(title, ("sweep", arguments), INTRODUCTION, root, SEED);
    page.section(
        Section::new("How well it tells collisions from free poses")
            .text(
                "AUC: how often a collision gets a higher probability than a free pose (near: of \
                 poses within 3 cm of contact). Brier: mean squared error of the probability. ECE: \
                 how far stated probabilities are from what happens (by chance: with 15 bins and so \
                 many poses). False stops: share of free poses stopped by a threshold that misses \
                 so many of the collisions. The oracle knows the sampled points without noise. The \
                 alternative is the best by AUC of: distance of the points, distance of the \
                 smoothed points, 1 cm boxes, the paper's method.",
            )
            .text("### Two clouds")
            .text(answers.by_noise(Pair::CloudCloud))
            .text("### A cloud and an exact mesh")
            .text(answers.by_noise(Pair::CloudMesh)),
    );
    page.section(
        Section::new("What a stated probability is worth")
            .text("The share of poses that collide, of those with such a stated probability.")
            .text(stated::table(answers))
            .figure(
                "accuracy-stated",
                "Stated probability against observed rate of collisions",
                stated::figure(answers),
            ),
    );
    page
}
