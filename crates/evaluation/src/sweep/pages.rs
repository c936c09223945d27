//! The two pages on accuracy.

use std::path::Path;

use cloudtouch_testkit::family::Kind;

use super::judged::Judged;
use super::tables::is_of;
use super::{OURS, camera, stated, targets};
use crate::SEED;
use crate::answers::{Answers, Pair};
use crate::report::{Page, Section};

const FOR_USERS: &str = "How often is cloudtouch right in scenes as users have them: furnished rooms, desks, kitchen \
counters, bins, workbenches, corridors and stairs? Scenes are generated, so that the exact answer is known from \
their meshes; each family of scenes is judged with constants fitted on the other families. Half of the poses collide \
and half are within 3 cm of contact: far harder, and with far more collisions, than what a planner meets. Hard cases \
by design, other methods, families one by one, intervals and targets are in [the full report](lab/accuracy.md); \
[what a probability means](probability.md) says what none of this can show.";

/// docs/accuracy.md: what a user needs to know.
pub(super) fn for_users(root: &Path, arguments: &str, answers: &Answers, views: &Answers) -> Page {
    let title = ("accuracy", "Accuracy");
    let mut page = Page::new(title, ("sweep", arguments), FOR_USERS, root, SEED);
    page.section(camera::section(views));
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
    page.section(Section::new("What a stated probability is worth").figure(
        "accuracy-stated",
        "Stated probability against observed rate of collisions",
        stated::figure(answers),
    ));
    page
}

const IN_FULL: &str = "Every method answers the same poses of generated scenes whose exact answer is known from \
their meshes (parry3d in double precision, checked against a brute-force triangle test). A family is a kind of \
scene; each of its draws is a scene of its own with fresh clouds, prepared once and asked at many poses. Ordinary \
families are what users meet: rooms, tables, counters, bins, corridors. Adversarial ones, in brackets, are chosen to \
be hard: thin, open, nested or linked bodies. Families whose name begins with real have meshes of real things and \
are pooled with none. Exactly half of the poses of every draw collide, half are within 3 cm of contact (near), \
whatever the size of the run; out there most poses are free. Contacts at surface that no sensor sees are left out: \
no method could tell them. The moving body is given as a second cloud or as its exact mesh.

Methods: `calibrated` is what users get by default, its constants fitted on the other families (`cargo xtask \
calibrate`), `oracle` the same given noise-free points and true normals, `geometry alone` the same without the \
classifier, `paper` the method as printed. Alternatives: the least distance of the points, as measured or after our \
own surface fit, in units of noise and spacing; 1 cm boxes around the points (yes or no). They rank poses and state \
no probability. `paper` answers every seventh pose, the smoothed distance every second draw.
Noise by noise, with the best alternative, and stated against observed: [accuracy.md](../accuracy.md).

`a [b, c]` is a value with its 95 % interval: draws are resampled within each family, then the poses of a draw, with \
all conditions of a pose together. False stops: the share of free poses that a threshold stops which misses at most \
so many of the collisions. ECE is over 15 bins; in brackets what chance alone gives a perfect forecaster. Times are \
medians of queries on clouds of 10,000 points, prepared once for the poses of a draw, as many at a time as there are \
cores; the noise model of `calibrated` is computed where queries first come near, so early poses pay for later ones.";

/// docs/lab/accuracy.md: everything that is measured.
pub(super) fn in_full(root: &Path, arguments: &str, answers: &Answers) -> Page {
    let title = ("accuracy", "Accuracy, in full");
    let mut page = Page::new(title, ("sweep", arguments), IN_FULL, root, SEED);
    page.section(targets::section(answers));
    for pair in Pair::ALL {
        let name = pair.pick("Two clouds", "Cloud and mesh");
        let mut section = Section::new(&format!("{name}: methods"));
        for (scenes, kind) in [("Ordinary", Kind::Ordinary), ("Adversarial", Kind::Adversarial)] {
            let keep = is_of(pair, kind);
            let count = Judged::pick(answers, &[OURS], keep).questions().len();
            section = section
                .text(format_args!(
                    "{scenes} scenes, {count} answers; bold: the interval excludes zero."
                ))
                .text(answers.by_method(keep));
        }
        page.section(section);
        let section = Section::new(&format!("{name}: families"));
        page.section(section.text(answers.by_family(pair)));
    }
    page
}
