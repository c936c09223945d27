//! Figure 4 and section 6.2: the piano in the room, probabilities against signed distance, and times.

use std::time::Instant;

use anyhow::{Context, Result};
use cloudtouch_geom::seed::derive;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::poses::{LabelledPose, poses_near_contact};
use cloudtouch_testkit::scene;

use super::clouds::{SEED, sampled};
use crate::answers::{Pair, Said};
use crate::methods::{Draw, Method, Ours, Paper, observed};
use crate::report::{Axis, Figure, Panel, Section, Series, Table};
use crate::statistics::quantile;

/// Standard deviations of the noise, m; times are those at the first.
const STDS: [f64; 2] = [0.002, 0.01];
/// Distances beyond this are drawn at the edge, mm.
const WIDEST: f64 = 60.0;

const TIMES: &str = "The same poses at 2 mm, one query at a time, each asked once, the first included: \
what a cloud computes lazily is in it. Preparation is done once. The last row is what the paper says of \
its machine of 2011. An exact checker on the same bodies is in [performance.md](performance.md).";

/// Asks all methods about the same poses, at both noises.
pub(super) fn sections(points: usize, poses: usize) -> Result<[Section; 2]> {
    let meshes = [scene::room(), scene::piano()];
    let exact = meshes.each_ref().map(ExactMesh::new);
    let poses = poses_near_contact(&exact[0], &exact[1], poses, derive(SEED, 4, 0));
    let paths: [&dyn Method; 3] =
        [&Ours::new("default")?, &Paper::new("printed"), &Paper::amended("amended")];
    let mut panels = Vec::new();
    let mut errors = Table::new([
        "noise (mm)",
        "method",
        "false alarms",
        "misses",
        "Brier score",
        "mean P, free",
        "mean P, collision",
    ]);
    let mut times =
        Table::new(["method", "prepare (ms)", "median (ms)", "p95 (ms)", "longest (ms)"]);
    for (number, std) in (0..).zip(STDS) {
        let [room, piano] = [0, 1].map(|body| {
            let stream = 20 + 2 * number + body as u64;
            observed(sampled(&meshes[body], points, std, stream), std)
        });
        let draw = Draw { family: "", a: &room, b: &piano, mesh: &meshes[1] };
        for method in paths {
            let (prepare, said) = ask(method, &draw, &poses)?;
            let [free, hit] = [false, true].map(|collides| {
                let of = poses.iter().zip(&said).filter(|(pose, _)| pose.in_collision == collides);
                let in_mm = |d: f64| (1e3 * d).clamp(-WIDEST, WIDEST);
                of.map(|(pose, said)| (in_mm(pose.signed_distance), said.score)).collect::<Vec<_>>()
            });
            let noise = format!("{:.0}", 1e3 * std);
            errors.row([vec![noise.clone(), method.name()], wrong(&free, &hit)].concat());
            let (x, y) = (Axis::linear("signed distance (mm)"), Axis::unit("probability"));
            let series = vec![Series::points("free", free), Series::points("in collision", hit)];
            panels.push(Panel { title: format!("{}, {noise} mm", method.name()), x, y, series });
            if std == STDS[0] {
                times.row(timed(method.name(), prepare, &said));
            }
        }
    }
    times.row(["the paper's; PQP; reconstruction", "> 10 000", "500–1000; 50–100", "–", "–"]);
    let mut figure = Figure::new("Probability against signed distance", panels);
    (figure.columns, figure.panel_size) = (3, (360, 280));
    let text = format!(
        "The piano in the room, {points} points each, {} poses. A false alarm is a free pose at ½ or \
         above, a miss a collision below it. Distances are of the exact meshes, in overlap minus the \
         penetration depth.",
        poses.len()
    );
    let shows = "Probability against signed distance at two noise levels in three modes";
    let of_errors = Section::new("Figure 4: the piano").text(text).text(errors);
    Ok([
        of_errors.figure("paper-distances", shows, figure),
        Section::new("Section 6.2: times").text(TIMES).text(times),
    ])
}

/// How long it takes to prepare both bodies, s, and what is said of every pose.
fn ask(method: &dyn Method, draw: &Draw<'_>, poses: &[LabelledPose]) -> Result<(f64, Vec<Said>)> {
    let start = Instant::now();
    let ask = method.prepare(draw)?;
    let prepare = start.elapsed().as_secs_f64();
    let said = poses.iter().map(|pose| {
        ask(Pair::CloudCloud, &pose.scene_from_object)?.context("an answer about two clouds")
    });
    Ok((prepare, said.collect::<Result<_>>()?))
}

/// False alarms, misses, Brier score and mean probabilities, of distances with probabilities.
fn wrong(free: &[(f64, f64)], hit: &[(f64, f64)]) -> Vec<String> {
    let mean = |all: &[(f64, f64)]| all.iter().map(|(_, p)| p).sum::<f64>() / all.len() as f64;
    let squares = free.iter().map(|(_, p)| p * p).chain(hit.iter().map(|(_, p)| (1.0 - p).powi(2)));
    let brier = squares.sum::<f64>() / (free.len() + hit.len()) as f64;
    let counts = [
        free.iter().filter(|(_, p)| *p >= 0.5).count(),
        hit.iter().filter(|(_, p)| *p < 0.5).count(),
    ];
    let means = [brier, mean(free), mean(hit)].map(|value| format!("{value:.3}"));
    counts.iter().map(usize::to_string).chain(means).collect()
}

fn timed(name: String, prepare: f64, said: &[Said]) -> [String; 5] {
    let milliseconds: Vec<f64> = said.iter().map(|said| 1e-3 * said.micros).collect();
    let of = |share| format!("{:.2}", quantile(&milliseconds, share));
    [name, format!("{:.0}", 1e3 * prepare), of(0.5), of(0.95), of(1.0)]
}
