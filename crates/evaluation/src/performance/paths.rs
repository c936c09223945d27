//! Paths: the poses along them asked about one by one, and swept as a whole.

use anyhow::Result;
use cloudtouch::{Detail, Path, Query, QuerySettings, Verdict};
use cloudtouch_geom::seed::{derive, unit};
use cloudtouch_geom::{Pose, Vector3};

use super::scene::Scene;
use super::timing::{least_of, ratio, time};
use crate::SEED;
use crate::report::{Findings, Section, Table, Target};
use crate::statistics::median;

/// Length of a path, m, and poses on it, 2 mm from one to the next.
const LENGTH: f64 = 0.2;
const POSES: u32 = 101;

const INTRODUCTION: &str = "A straight path of 20 cm through each of the poses above, both clouds refined. *One by \
one*: its 101 poses, 2 mm apart, by `Query::run`, to which it is all the same how far apart poses are. *Swept*: \
`Query::sweep`, which misses nothing between them either; `verdict alone` ends with the first pose that is not free, \
`probability` finds where a collision begins too. Times of a path over its poses, medians over paths, the least of three.";

/// Times every path both ways, by what is asked and by whether the path is free.
pub(super) fn measure(scene: &Scene) -> Findings {
    let [room, piano] = scene.refined()?;
    let mut table = Table::new(["asked", "paths", "how many", "one by one", "swept", "faster"]);
    let mut verdicts = Vec::new();
    for (asked, detail) in
        [("verdict alone", Detail::Verdict), ("probability", Detail::Probability)]
    {
        let query = Query::new(QuerySettings { detail, ..QuerySettings::default() })?;
        // Of paths that are free, and of the others: seconds one by one, swept, and how many times faster.
        let mut kinds: [[Vec<f64>; 3]; 2] = Default::default();
        for (number, pose) in (0..).zip(&scene.poses) {
            let path = through(&pose.scene_from_object, number)?;
            let share = |k: u32| f64::from(k) / f64::from(POSES - 1);
            let ask = |k| query.run(&room, &piano, &path.pose(share(k))).map(drop);
            let (_, alone) = least_of(3, || Ok((0..POSES).try_for_each(ask)?))?;
            let sweep = || Ok(query.sweep(&room, &piano, &path, 1.0 / f64::from(POSES - 1))?);
            let (swept, together) = least_of(3, sweep)?;
            let times = [alone / f64::from(POSES), together / f64::from(POSES), alone / together];
            let kind = kinds[usize::from(swept.verdict != Verdict::Free)].iter_mut();
            kind.zip(times).for_each(|(all, one)| all.push(one));
        }
        for (name, kind) in ["free", "others"].into_iter().zip(&kinds) {
            let [alone, swept, faster] = kind.each_ref().map(|all| median(all));
            let how_many = kind[0].len().to_string();
            table.row([asked, name, &how_many, &time(alone), &time(swept), &ratio(faster)]);
            verdicts.extend((detail == Detail::Verdict).then_some(faster));
        }
    }
    let least = verdicts.into_iter().fold(f64::INFINITY, f64::min);
    let what = "paths of close poses, verdict alone, free and others: a pose ≥ 3 × faster swept";
    let target = Target::new(what, ratio(least), least >= 3.0);
    Ok((Section::new("Paths").text(INTRODUCTION).text(table), vec![target]))
}

/// A path with its middle at a pose, along a direction of its own.
fn through(middle: &Pose, number: u64) -> Result<Path> {
    let draw = |k: u64| 2.0 * unit(derive(SEED, 9 + k, number)) - 1.0;
    let way = Vector3::new(draw(0), draw(1), draw(2)).normalize() * LENGTH;
    let [from, to] = [-0.5, 0.5].map(|part| Pose::from_translation(way * part).after(middle));
    Ok(Path::linear(&from, &to)?)
}
