//! Figure 3 (a, b) and storage: collisions missed where leaves are cut, found as ε grows.

use anyhow::Result;
use cloudtouch::bvh::{Traversal, TreeSettings};
use cloudtouch::paper::Scaling;
use cloudtouch::{PaperCloud, PaperModel, PaperQuery, PaperSettings};
use cloudtouch_geom::seed::derive;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::poses::{LabelledPose, poses_near_contact};
use cloudtouch_testkit::scene;

use super::clouds::{SEED, by_paper, sampled};
use crate::report::{Section, Table};

/// ε, as a part of the parent; the paper takes 1 to 5 %.
const OVERLAPS: [f64; 7] = [0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3];
/// Points of each cloud, and of a leaf at most.
const POINTS: usize = 4000;
const LEAF: usize = 20;
const STD: f64 = 0.001;
/// Overlap of the exact surfaces, m: a sheet that is cut there hides it.
const DEEPEST: f64 = 0.015;

pub(super) fn section(poses: usize) -> Result<Section> {
    let (slab, peg) = (scene::thin_slab(0.4), scene::peg(0.03, 0.2));
    let exact = [&slab, &peg].map(ExactMesh::new);
    let shallow = |pose: &LabelledPose| pose.in_collision && pose.signed_distance > -DEEPEST;
    let poses: Vec<LabelledPose> = (0..)
        .flat_map(|batch| poses_near_contact(&exact[0], &exact[1], 16, derive(SEED, 3, batch)))
        .filter(shallow)
        .take(poses)
        .collect();
    let clouds = [sampled(&slab, POINTS, STD, 10), sampled(&peg, POINTS, STD, 11)];
    let count = poses.len();
    let mut table = Table::new([
        "ε (%)",
        "missed, one scale a scene",
        "missed, one a leaf pair",
        "stored / n",
        "1 + ε lg(n/n_max)",
    ]);
    for overlap in OVERLAPS {
        let usual = PaperModel::default();
        let tree = TreeSettings { max_leaf_points: LEAF, sibling_overlap: overlap, ..usual.tree };
        let by = by_paper(STD, PaperModel { tree, ..usual });
        let [slab, peg] = clouds.each_ref().map(|cloud| PaperCloud::prepare(cloud, &by));
        let (slab, peg) = (slab?, peg?);
        let mut row = vec![format!("{:.0}", 100.0 * overlap)];
        for scaling in [Scaling::Scene, Scaling::LeafPair] {
            let settings = PaperSettings {
                scaling,
                traversal: Traversal::Certified,
                ..PaperSettings::default()
            };
            let places: Vec<_> = poses.iter().map(|pose| pose.scene_from_object).collect();
            let mut misses = 0;
            for report in PaperQuery::new(settings)?.run_batch(&slab, &peg, &places) {
                misses += usize::from(report?.collision_probability < 0.5);
            }
            row.push(misses.to_string());
        }
        let measured = slab.stored_points() as f64 / slab.len() as f64;
        let formula = 1.0 + overlap * (slab.len() as f64 / LEAF as f64).log2();
        row.extend([measured, formula].map(|factor| format!("{factor:.2}")));
        table.row(row);
    }
    let text = format!(
        "A peg at {count} poses in a thin slab, no deeper than {:.0} mm; {POINTS} points each, {:.0} mm \
         of noise, n_max = {LEAF}, every leaf pair classified. Missed is what reads below ½. ε is \
         a part of the extent of the parent along the cut; points within it belong to both halves. \
         Storage counts the points of all leaves; the formula is the paper's (section 5).",
        1e3 * DEEPEST,
        1e3 * STD
    );
    Ok(Section::new("Figure 3 (a, b): overlap, and storage").text(text).text(table))
}
