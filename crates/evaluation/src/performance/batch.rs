//! Many poses of one pair on one thread and on two.

use anyhow::Context;
use cloudtouch::{Detail, Query, QuerySettings};
use cloudtouch_geom::Pose;
use rayon::ThreadPoolBuilder;

use super::scene::Scene;
use super::timing::{ratio, timed};
use crate::report::{Findings, Section, Target};

/// Poses of the batch, and its parts; one and two threads take turns at each.
const POSES: usize = 10_000;
const PARTS: usize = 10;

/// Asks all poses of the batch three times: untimed, on one thread, on two.
pub(super) fn measure(scene: &Scene) -> Findings {
    let [room, piano] = scene.refined()?;
    let settings = QuerySettings { detail: Detail::Probability, ..QuerySettings::default() };
    let query = Query::new(settings)?;
    let poses: Vec<Pose> =
        scene.poses.iter().map(|p| p.scene_from_object).cycle().take(POSES).collect();
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [pool(1).context("start a thread")?, pool(2).context("start threads")?];
    let mut seconds = [0.0; 2];
    for (number, part) in poses.chunks(POSES / PARTS).enumerate() {
        pools[1].install(|| query.run_batch(&room, &piano, part));
        for which in [number % 2, 1 - number % 2] {
            let ask = || Ok(pools[which].install(|| query.run_batch(&room, &piano, part)));
            seconds[which] += timed(ask)?.1;
        }
    }
    let section = Section::new("Many poses at once").text(format_args!(
        "`Query::run_batch` for probabilities alone (`Detail::Probability`) on one thread and on two, {POSES} poses: \
         those above over and over. All were asked before; one and two threads take turns at tenths of the batch."
    ));
    let what = format!("batch of {POSES} poses: two threads ≥ 1.9 × one");
    let faster = seconds[0] / seconds[1];
    let rate = POSES as f64 / seconds[0];
    let targets = vec![
        Target::new(what, ratio(faster), faster >= 1.9),
        Target::new("batch: ≥ 5,000 poses a second and core", format!("{rate:.0}"), rate >= 5e3),
    ];
    Ok((section, targets))
}
