//! Many poses of one pair on one thread and on two.

use anyhow::{Context, Result};
use cloudtouch::{Cloud, Query, QuerySettings, Report};
use cloudtouch_geom::{Pose, Vector3, seed};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{
    methods::prepare,
    scene::{POINTS, STD, Scene},
    target::{Findings, Target},
    timing::{ratio, time, timed},
};
use crate::{page::Section, table::Table};

/// Poses of the batch.
const POSES: usize = 10_000;
/// Parts of the batch; one and two threads take turns at each.
const PARTS: usize = 10;
/// How far a pose is moved along each axis at most to make others, m.
const MOVED: f64 = 0.01;
/// How far it is turned about each axis at most, rad.
const TURNED: f64 = 0.02;

/// Asks all poses of the batch three times: untimed, on one thread, on two.
pub(super) fn measure(scene: &Scene) -> Findings {
    let room = prepare(&scene.room(POINTS, STD), STD)?.refined()?;
    let piano = prepare(&scene.piano(STD), STD)?.refined()?;
    let query = Query::new(QuerySettings::default())?;
    let base: Vec<Pose> = scene.poses.iter().map(|posed| posed.pose).collect();
    let poses: Vec<Pose> = (0..POSES).map(|i| jittered(&base, i, scene.seed)).collect();
    let pools = [threads(1)?, threads(2)?];
    let (mut seconds, mut different) = ([0.0; 2], 0);
    for (number, part) in poses.chunks(POSES / PARTS).enumerate() {
        ask(&pools[1], &query, [&room, &piano], part)?;
        let mut said = [Vec::new(), Vec::new()];
        for which in [number % 2, 1 - number % 2] {
            let (reports, taken) = timed(|| ask(&pools[which], &query, [&room, &piano], part));
            seconds[which] += taken;
            said[which] = reports?.iter().map(answer).collect();
        }
        different += said[0].iter().zip(&said[1]).filter(|(one, two)| one != two).count();
    }
    let mut table = Table::new(["threads", "time", "poses a second"]);
    for (threads, seconds) in ["1", "2"].into_iter().zip(seconds) {
        table.row([threads.into(), time(seconds), format!("{:.0}", POSES as f64 / seconds)]);
    }
    let section = Section::new("Many poses at once").text(format_args!(
        "`Query::run_batch` on pools of one thread and of two, {POSES} poses: those above, each \
         moved by up to {:.0} cm along and {TURNED:.2} rad about every axis. All were asked before; \
         one and two threads take turns at tenths of the batch. Answers are the same when everything \
         in the reports but times and `leaves_prepared` is.",
        1e2 * MOVED,
    ));
    Ok((section.text(table), targets(seconds, different)))
}

fn targets(seconds: [f64; 2], different: usize) -> Vec<Target> {
    let faster = format!("batch of {POSES} poses: two threads ≥ 1.8 × one");
    let same = format!("batch of {POSES} poses: the same answers on one thread and two");
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    vec![
        if cores < 2 {
            Target::skipped(faster, "one core only")
        } else {
            Target::at_least(faster, seconds[0] / seconds[1], 1.8, ratio)
        },
        Target::holds(same, format!("{different} differ"), different == 0),
    ]
}

fn threads(count: usize) -> Result<ThreadPool> {
    ThreadPoolBuilder::new().num_threads(count).build().context("start threads")
}

fn ask(
    pool: &ThreadPool,
    query: &Query,
    [room, piano]: [&Cloud; 2],
    poses: &[Pose],
) -> Result<Vec<Report>> {
    let reports = pool.install(|| query.run_batch(room, piano, poses));
    Ok(reports.into_iter().collect::<Result<_, _>>()?)
}

/// What must not depend on the number of threads.
fn answer(report: &Report) -> Report {
    let mut answer = report.clone();
    let stats = &mut answer.stats;
    (stats.prepare_us, stats.query_us, stats.leaves_prepared) = (0, 0, 0);
    answer
}

/// The pose with this number: near one of those given, and like no other.
fn jittered(base: &[Pose], number: usize, from: u64) -> Pose {
    let stream = seed::derive(from, 5, number as u64);
    let draw = |k| 2.0 * seed::unit(seed::derive(stream, k, 0)) - 1.0;
    let offset = Vector3::new(draw(0), draw(1), draw(2)) * MOVED;
    let jitter =
        Pose::from_translation_rpy(offset, [draw(3), draw(4), draw(5)].map(|d| d * TURNED));
    base[number % base.len()].after(&jitter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jittered_poses_are_near_their_own_and_none_is_another() {
        let base = [Pose::identity(), Pose::from_translation(Vector3::new(1.0, 2.0, 3.0))];
        let poses: Vec<Pose> = (0..9).map(|i| jittered(&base, i, 1)).collect();
        for (i, pose) in poses.iter().enumerate() {
            let off = (pose.translation() - base[i % 2].translation()).amax();
            assert!(off > 0.0 && off <= MOVED + 1e-12, "{off}");
            assert!(poses[..i].iter().all(|other| other.translation() != pose.translation()));
        }
    }

    #[test]
    fn a_batch_that_answers_otherwise_misses_its_target() {
        assert_eq!(targets([2.0, 1.0], 0)[1].met, Some(true));
        let bad = targets([2.0, 1.9], 3);
        assert!(bad.iter().all(|target| target.met != Some(true)), "{bad:?}");
    }
}
