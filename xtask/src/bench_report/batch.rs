//! Many poses of one pair on one thread and on two.

use anyhow::{Context, Result};
use cloudtouch::{Cloud, Query, QuerySettings, Report};
use cloudtouch_geom::{Pose, Vector3, seed};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{
    Run, Section,
    scene::{POINTS, STD, prepare},
    target::Target,
    timing::{ratio, time, timed},
};
use crate::common::table::Table;

/// Parts of the batch; one and two threads take turns at each.
const PARTS: usize = 10;
/// How far a pose is moved along each axis at most to make others, m.
const MOVED: f64 = 0.01;
/// How far it is turned about each axis at most, rad.
const TURNED: f64 = 0.02;

/// Asks all poses of the batch three times: untimed, on one thread, on two.
pub(super) fn measure(run: &Run<'_>) -> Result<Section> {
    let clouds = [
        prepare(&run.scene.room(POINTS, STD), STD)?.refined()?,
        prepare(&run.scene.piano(STD), STD)?.refined()?,
    ];
    let query = Query::new(QuerySettings::default())?;
    let base: Vec<Pose> = run.scene.poses.iter().map(|p| p.pose.scene_from_object).collect();
    let poses = jittered(&base, run.plan.batch, run.seed);
    let pools = [threads(1)?, threads(2)?];
    let (mut seconds, mut different) = ([0.0; 2], 0);
    for (number, part) in poses.chunks(poses.len().div_ceil(PARTS).max(1)).enumerate() {
        ask(&pools[1], &query, &clouds, part)?;
        let mut said = [Vec::new(), Vec::new()];
        for which in [number % 2, 1 - number % 2] {
            let (reports, taken) = timed(|| ask(&pools[which], &query, &clouds, part));
            seconds[which] += taken;
            said[which] = reports?;
        }
        let [one, two] = said;
        different += one.iter().zip(&two).filter(|(a, b)| answer(a) != answer(b)).count();
    }
    Ok(section(poses.len(), seconds, different))
}

fn section(poses: usize, seconds: [f64; 2], different: usize) -> Section {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let speedup = seconds[0] / seconds[1];
    let (faster, same) = (
        format!("batch of {poses} poses: two threads ≥ 1.8 × one"),
        format!("batch of {poses} poses: the same answers on one thread and two"),
    );
    let targets = vec![
        if cores < 2 {
            Target::skipped(faster, "one core only")
        } else {
            Target::at_least(faster, speedup, 1.8, ratio)
        },
        Target::holds(same, format!("{different} differ"), different == 0),
    ];
    let mut table = Table::new(&["threads", "time", "poses a second"]);
    for (threads, seconds) in ["1", "2"].iter().zip(seconds) {
        table.row([(*threads).into(), time(seconds), format!("{:.0}", poses as f64 / seconds)]);
    }
    let text = format!(
        "`Query::run_batch` on pools of one thread and of two, {poses} poses: those above, each moved \
         by up to {:.0} cm along and {:.2} rad about every axis. All were asked before; one and two \
         threads take turns at tenths of the batch. Answers are the same when everything in the \
         reports but times and `leaves_prepared` is.\n\n{table}",
        1e2 * MOVED,
        TURNED,
    );
    Section { title: "Many poses at once", text, targets }
}

fn threads(count: usize) -> Result<ThreadPool> {
    ThreadPoolBuilder::new().num_threads(count).build().context("start threads")
}

fn ask(
    pool: &ThreadPool,
    query: &Query,
    [room, piano]: &[Cloud; 2],
    poses: &[Pose],
) -> Result<Vec<Report>> {
    let reports = pool.install(|| query.run_batch(room, piano, poses));
    Ok(reports.into_iter().collect::<Result<_, _>>()?)
}

/// What must not depend on the number of threads.
fn answer(report: &Report) -> Report {
    let mut answer = report.clone();
    answer.stats.prepare_us = 0;
    answer.stats.query_us = 0;
    answer.stats.leaves_prepared = 0;
    answer
}

/// So many poses, each near one of those given.
fn jittered(base: &[Pose], count: usize, from: u64) -> Vec<Pose> {
    let jitter = |i: usize| {
        let draw = |k| 2.0 * seed::unit(seed::derive(seed::derive(from, 5, i as u64), k, 0)) - 1.0;
        let offset = Vector3::new(draw(0), draw(1), draw(2)) * MOVED;
        Pose::from_translation_rpy(offset, [draw(3), draw(4), draw(5)].map(|d| d * TURNED))
    };
    if base.is_empty() {
        return Vec::new();
    }
    (0..count).map(|i| base[i % base.len()].after(&jitter(i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jittered_poses_are_near_their_own_and_none_is_another() {
        let base = [Pose::identity(), Pose::from_translation(Vector3::new(1.0, 2.0, 3.0))];
        let poses = jittered(&base, 9, 1);
        for (i, pose) in poses.iter().enumerate() {
            let off = (pose.translation() - base[i % 2].translation()).amax();
            assert!(off > 0.0 && off <= MOVED + 1e-12, "{off}");
            assert!(poses[..i].iter().all(|other| other.translation() != pose.translation()));
        }
        assert_eq!(poses.len(), 9);
        assert!(jittered(&[], 9, 1).is_empty());
    }

    #[test]
    fn a_batch_that_answers_otherwise_misses_its_target() {
        let said = |seconds, different| {
            let section = section(100, seconds, different);
            super::super::target::table(&section.targets).to_string()
        };
        let good = said([2.0, 1.0], 0);
        assert!(good.contains("| 0 differ") && good.matches("| yes").count() >= 1, "{good}");
        let bad = said([2.0, 1.9], 3);
        assert!(bad.contains("| 3 differ") && !bad.contains("| yes"), "{bad}");
    }
}
