//! Figure 4 and section 6.2: the piano in the room, probabilities against signed distance, and times.

use std::time::Instant;

use anyhow::{Context, Result};
use cloudtouch_geom::seed::derive;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::poses::poses_near_contact;
use cloudtouch_testkit::scene;

use crate::SEED;
use crate::answers::{Pair, Said};
use crate::measures::{Sample, brier, wrong_from};
use crate::methods::{Draw, Method, Ours, Paper, sampled};
use crate::report::{Axis, Figure, Panel, Section, Series, Table};
use crate::statistics::quantile;

/// Standard deviations of the noise, m.
const STDS: [f64; 2] = [0.002, 0.01];
/// Distances beyond this are drawn at the edge, mm.
const WIDEST: f64 = 60.0;

/// Asks all methods about the same poses, at both noises.
pub(super) fn section(points: usize, poses: usize) -> Result<Section> {
    let meshes = [scene::room(), scene::piano()];
    let exact = meshes.each_ref().map(ExactMesh::new);
    let poses = poses_near_contact(&exact[0], &exact[1], poses, derive(SEED, 4, 0));
    let methods: [&dyn Method; 3] =
        [&Ours::new("default")?, &Paper::new("printed"), &Paper::amended("amended")];
    const HEADER: &str = "noise (mm), method, false alarms, misses, Brier score, \
                          prepare (ms), median (ms), p95 (ms)";
    let mut table = Table::new(HEADER.split(", "));
    let mut panels = Vec::new();
    for (number, std) in (0..).zip(STDS) {
        let [room, piano] = [0, 1].map(|body| {
            let seeds = [1, 2].map(|part| derive(SEED, part, 20 + 2 * number + body as u64));
            sampled(&meshes[body], points, std, seeds)
        });
        let draw = Draw { family: "", a: &room, b: &piano, mesh: &meshes[1] };
        for method in methods {
            let start = Instant::now();
            let ask = method.prepare(&draw)?;
            let prepare = start.elapsed().as_secs_f64();
            let said = poses.iter().map(|pose| {
                let said = ask(Pair::CloudCloud, &pose.scene_from_object)?;
                said.context("an answer about two clouds")
            });
            let said: Vec<Said> = said.collect::<Result<_>>()?;
            let both = || poses.iter().zip(&said);
            let sample = Sample::of_probabilities(both().map(|(q, s)| (s.score, q.in_collision)));
            let [free, hit] = [false, true].map(|collides| {
                let of = both().filter(|(pose, _)| pose.in_collision == collides);
                let in_mm = |d: f64| (1e3 * d).clamp(-WIDEST, WIDEST);
                of.map(|(pose, said)| (in_mm(pose.signed_distance), said.score)).collect::<Vec<_>>()
            });
            let mut row = vec![format!("{:.0}", 1e3 * std), method.name()];
            let wrong = wrong_from(&sample, &sample.ones(), 0.5);
            row.extend(wrong.map(|[count, _]| count.to_string()));
            row.push(format!("{:.3}", brier(&sample, &sample.ones())));
            let times: Vec<f64> = said.iter().map(|said| 1e-3 * said.micros).collect();
            row.push(format!("{:.0}", 1e3 * prepare));
            row.extend([0.5, 0.95].map(|share| format!("{:.2}", quantile(&times, share))));
            table.row(row);
            let (x, y) = (Axis::linear("signed distance (mm)"), Axis::unit("probability"));
            let series = vec![
                Series::points("free", free).named_at(35.0, 0.62),
                Series::points("in collision", hit).named_at(-55.0, 0.25),
            ];
            let title = format!("{}, {:.0} mm", method.name(), 1e3 * std);
            panels.push(Panel { title, x, y, series });
        }
    }
    let mut figure = Figure::new(
        "Right is orange (in collision) above, blue (free) below; left of 0 the bodies overlap",
        panels,
    );
    (figure.columns, figure.panel_size) = (3, (360, 280));
    let text = format!(
        "The piano in the room, {points} points each, {} poses. A false alarm is a free pose at ½ or \
         above, a miss a collision below it. Distances are of the exact meshes, in overlap minus the \
         penetration depth. Bodies are prepared once; queries come one at a time, each pose asked \
         once, so that what a cloud computes lazily is in their times. The paper says 500 to 1000 ms \
         of its machine of 2011, 50 to 100 ms of PQP on exact meshes, and more than 10 s of the \
         reconstruction of a surface; an exact checker of today is in \
         [performance.md](performance.md).",
        poses.len()
    );
    let shows = "Probability against signed distance at two noise levels in three modes";
    let section = Section::new("Figure 4 and section 6.2: the piano").text(text).text(table);
    Ok(section.figure("paper-distances", shows, figure))
}
