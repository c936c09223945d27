//! The first query of two clouds that nobody has prepared yet.

use anyhow::{Result, ensure};
use cloudtouch::{Query, QuerySettings};

use super::{
    Run, Section,
    poses::Class,
    scene::{POINTS, STD, prepare},
    target::Target,
    timing::{median, p95, time, timed},
};
use crate::common::table::Table;

/// Prepares both clouds anew for every near pose.
pub(super) fn measure(run: &Run<'_>) -> Result<Section> {
    let (room, piano) = (run.scene.room(POINTS, STD), run.scene.piano(STD));
    let query = Query::new(QuerySettings::default())?;
    let mut seconds = [const { Vec::new() }; 3];
    for posed in run.scene.poses.iter().filter(|posed| posed.class == Class::Near) {
        let (bodies, preparing) = timed(|| Ok([prepare(&room, STD)?, prepare(&piano, STD)?]));
        let [a, b]: [_; 2] = bodies.map_err(|error: anyhow::Error| error)?;
        let (report, asking) = timed(|| query.run(&a, &b, &posed.pose.scene_from_object));
        let again = query.run(&a, &b, &posed.pose.scene_from_object)?;
        let [first, again] = [report?, again].map(|r| r.collision_probability);
        ensure!(first == again, "the first answer is {first}, the second {again}");
        for (list, value) in seconds.iter_mut().zip([preparing, asking, preparing + asking]) {
            list.push(value);
        }
    }
    let mut table = Table::new(&["part", "median", "p95"]);
    for (name, part) in ["prepare both clouds", "first query", "both"].iter().zip(&seconds) {
        table.row([(*name).into(), time(median(part)), time(p95(part))]);
    }
    let target = Target::at_most(
        "first query of a fresh 10k pair, preparation included: near, median ≤ 15 ms",
        median(&seconds[2]),
        0.015,
        time,
    );
    let text = format!(
        "The near poses again, {} of them, with {:.0} mm of noise. Both clouds are prepared anew for \
         each: filter, sensor model, neighbour index, tree. The query then computes the noise model \
         where it looks. Its answers are those of the prepared queries, to the bit, and so are its \
         errors.\n\n{table}",
        seconds[2].len(),
        1e3 * STD,
    );
    Ok(Section { title: "First query of two fresh clouds", text, targets: vec![target] })
}
