//! The first query of two clouds that nobody has prepared yet.

use anyhow::{Result, ensure};
use cloudtouch::{Query, QuerySettings};

use super::{
    methods::prepare,
    scene::{Class, POINTS, STD, Scene},
    target::{Findings, Target},
    timing::{time, timed, times},
};
use crate::{page::Section, statistics::median, table::Table};

/// Prepares both clouds anew for every near pose.
pub(super) fn measure(scene: &Scene) -> Findings {
    let (room, piano) = (scene.room(POINTS, STD), scene.piano(STD));
    let query = Query::new(QuerySettings::default())?;
    let mut seconds = [const { Vec::new() }; 3];
    for posed in scene.poses.iter().filter(|posed| posed.class == Class::Near) {
        let prepared = || -> Result<_> { Ok((prepare(&room, STD)?, prepare(&piano, STD)?)) };
        let (bodies, preparing) = timed(prepared);
        let (a, b) = bodies?;
        let (report, asking) = timed(|| query.run(&a, &b, &posed.pose));
        let again = query.run(&a, &b, &posed.pose)?;
        let [first, again] = [report?, again].map(|r| r.collision_probability);
        ensure!(first == again, "the first answer is {first}, the second {again}");
        for (list, value) in seconds.iter_mut().zip([preparing, asking, preparing + asking]) {
            list.push(value);
        }
    }
    let mut table = Table::new(["part", "median", "p95"]);
    for (name, part) in ["prepare both clouds", "first query", "both"].into_iter().zip(&seconds) {
        let [median, p95] = times(part);
        table.row([name.to_owned(), median, p95]);
    }
    let target = Target::at_most(
        "first query of a fresh 10k pair, preparation included: near, median ≤ 15 ms",
        median(&seconds[2]),
        0.015,
        time,
    );
    let section = Section::new("First query of two fresh clouds").text(format_args!(
        "The near poses again, {} of them, with {:.0} mm of noise. Both clouds are prepared anew for \
         each: filter, sensor model, neighbour index, tree. The query then computes the noise model \
         where it looks. Its answers are those of the prepared queries, to the bit, and so are its \
         errors.",
        seconds[2].len(),
        1e3 * STD,
    ));
    Ok((section.text(table), vec![target]))
}
