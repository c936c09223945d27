//! Many poses of one pair on one thread and on two.

use anyhow::{Context, Result};
use cloudtouch::{Query, QuerySettings, Report};
use cloudtouch_geom::{Pose, Vector3, seed};
use rayon::ThreadPoolBuilder;

use super::{
    fresh::prepare,
    scene::{POINTS, STD, Scene},
    timing::{ratio, time, timed},
};
use crate::{
    page::Section,
    table::Table,
    targets::{Findings, Target},
};

/// Poses of the batch, and its parts; one and two threads take turns at each.
const POSES: usize = 10_000;
const PARTS: usize = 10;
/// How far a pose is moved along each axis and turned about it at most to make others, m and rad.
const MOVED: f64 = 0.01;
const TURNED: f64 = 0.02;

/// Asks all poses of the batch three times: untimed, on one thread, on two.
pub(super) fn measure(scene: &Scene) -> Findings {
    let room = prepare(&scene.room(POINTS, STD).cloud, STD)?.refined()?;
    let piano = prepare(&scene.piano(STD).cloud, STD)?.refined()?;
    let query = Query::new(QuerySettings::default())?;
    let poses: Vec<Pose> = (0..POSES).map(|i| jittered(scene, i)).collect();
    let ask = |threads: usize, poses: &[Pose]| -> Result<Vec<Report>> {
        let pool =
            ThreadPoolBuilder::new().num_threads(threads).build().context("start threads")?;
        let reports = pool.install(|| query.run_batch(&room, &piano, poses));
        Ok(reports.into_iter().collect::<Result<_, _>>()?)
    };
    let (mut seconds, mut different) = ([0.0; 2], 0);
    for (number, part) in poses.chunks(POSES / PARTS).enumerate() {
        ask(2, part)?;
        let mut said = [Vec::new(), Vec::new()];
        for which in [number % 2, 1 - number % 2] {
            let (reports, taken) = timed(|| ask(1 + which, part))?;
            seconds[which] += taken;
            said[which] = reports.into_iter().map(without_times).collect();
        }
        different += said[0].iter().zip(&said[1]).filter(|(one, two)| one != two).count();
    }
    let mut table = Table::new(["threads", "time", "poses a second"]);
    for (threads, seconds) in ["1", "2"].into_iter().zip(seconds) {
        table.row([threads.into(), time(seconds), format!("{:.0}", POSES as f64 / seconds)]);
    }
    let section = Section::new("Many poses at once").text(format_args!(
        "`Query::run_batch` on one thread and on two, {POSES} poses: those above, each moved by up \
         to {:.0} cm along and {TURNED:.2} rad about every axis. All were asked before; one and two \
         threads take turns at tenths of the batch. {different} reports differ in anything but \
         times.",
        1e2 * MOVED,
    ));
    let what = format!("batch of {POSES} poses");
    let speedup = seconds[0] / seconds[1];
    let targets = vec![
        Target::at_least(format!("{what}: two threads ≥ 1.8 × one"), speedup, 1.8, ratio),
        Target::at_most(format!("{what}: same answers"), different as f64, 0.0, |n| {
            format!("{n:.0} differ")
        }),
    ];
    Ok((section.text(table), targets))
}

/// What must not depend on the number of threads.
fn without_times(mut report: Report) -> Report {
    let stats = &mut report.stats;
    (stats.prepare_us, stats.query_us, stats.leaves_prepared) = (0, 0, 0);
    report
}

/// The pose with this number: near one of the scene's, and like no other.
fn jittered(scene: &Scene, number: usize) -> Pose {
    let stream = seed::derive(scene.seed, 5, number as u64);
    let draw = |k| 2.0 * seed::unit(seed::derive(stream, k, 0)) - 1.0;
    let offset = Vector3::new(draw(0), draw(1), draw(2)) * MOVED;
    let jitter =
        Pose::from_translation_rpy(offset, [draw(3), draw(4), draw(5)].map(|d| d * TURNED));
    scene.poses[number % scene.poses.len()].pose.after(&jitter)
}
