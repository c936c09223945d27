//! The piano in the room, prepared: every method asked about every pose in turn.

use anyhow::Result;

use super::{
    asked::{Asked, ask_in_turn, errors, seconds},
    methods::{self, LAZY, MESHES, Method, OURS},
    scene::{Class, POINTS, STD, Scene},
    target::{Findings, Target},
    timing::{p95, ratio, time},
};
use crate::{
    figure::{Axis, Figure, Panel, Series, palette},
    page::Section,
    statistics::median,
    table::Table,
};

/// The larger of the two noises, m.
const LARGE_STD: f64 = 0.01;

const INTRODUCTION: &str = "Room and piano, 10,000 points each, two clouds in the calibrated mode \
with default settings. A third of the poses is far (at least 10 cm apart), a third near (exact \
surfaces within 2 cm of one another, half free and half in overlap), a third deep (at least 5 cm of \
overlap). The methods take turns at each pose. The first answer is not timed: it fills what is \
computed once for all poses. Of the others the least time counts, for every method alike.

- `ours`: clouds that were refined (`Cloud::refined`), as for a scene that many poses are tested in; \
`not refined`: as prepared for a frame that is looked at a few times; `geometry alone`: refined, and \
no classifier is trained, so that the rest is what training costs.
- `parry3d, meshes`: `intersection_test` on the surfaces that the clouds were drawn from, in about \
10,000 triangles each. No sensor knows them: it is told more than the others.
- `parry3d, voxels`: cubes of 1 cm about the points of the room, against the surface of the piano.
- `kiddo, smallest distance`: the nearest point of the room for every point of the piano, sought no \
farther than the smallest distance so far. It has no threshold, so no verdict.
- `capt, spheres`: balls of 1 cm about the points of the piano against the points of the room, up to \
the first hit, in single precision.

False stops: free poses that the method calls collisions, of all free poses. Misses: collisions that \
it does not, of all collisions. Ours calls from ½ on. AUC: how often a collision gets a larger score \
than a free pose, ties counting half; of a method that says only yes or no, that is what ties leave.";

/// Measures at both noises.
pub(super) fn measure(scene: &Scene) -> Findings {
    let mut section = Section::new("Prepared queries").text(INTRODUCTION);
    let mut targets = Vec::new();
    for std in [STD, LARGE_STD] {
        let asked = ask_in_turn(&methods(scene, std)?, &scene.poses)?;
        targets.extend(judged(&asked, std));
        section = section
            .text(format_args!("### Noise of {:.0} mm", 1e3 * std))
            .text(times(&asked))
            .text(errors(&asked));
        if std == STD {
            section = section.text("A mark is a pose, the bar is the median.").figure(
                "performance-room",
                "Times of queries by class of pose",
                strips(&asked),
            );
        }
    }
    Ok((section, targets))
}

fn methods(scene: &Scene, std: f64) -> Result<Vec<Method>> {
    let (room, piano) = (scene.room(POINTS, std), scene.piano(std));
    let meshes = scene.meshes(POINTS);
    Ok(vec![
        methods::ours([&room, &piano], std)?,
        methods::lazy(LAZY, [&room, &piano], std)?,
        methods::geometry([&room, &piano], std)?,
        methods::meshes(&meshes)?,
        methods::voxels(&room, &meshes[1])?,
        methods::distance([&room, &piano])?,
        methods::spheres([&room, &piano])?,
    ])
}

fn judged(asked: &[Asked], std: f64) -> Vec<Target> {
    let near = p95(&seconds(asked, OURS, Some(Class::Near)));
    let at = format!("10k × 10k points, {:.0} mm of noise", 1e3 * std);
    if std == LARGE_STD {
        return vec![Target::at_most(format!("{at}: near, p95 ≤ 10 ms"), near, 0.01, time)];
    }
    let [ours, theirs] = [OURS, MESHES].map(|name| median(&seconds(asked, name, None)));
    let compared = |r: f64| format!("{} ({} to {})", ratio(r), time(ours), time(theirs));
    let [far, deep] =
        [Class::Far, Class::Deep].map(|class| median(&seconds(asked, OURS, Some(class))));
    let meshes = format!("{at}: median ≤ 1.0 × parry3d on meshes");
    vec![
        Target::at_most(meshes, ours / theirs, 1.0, compared),
        Target::at_most(format!("{at}: far, median ≤ 10 µs"), far, 1e-5, time),
        Target::at_most(format!("{at}: deep, median ≤ 0.5 ms"), deep, 5e-4, time),
        Target::at_most(format!("{at}: near, p95 ≤ 3 ms"), near, 3e-3, time),
    ]
}

fn times(asked: &[Asked]) -> Table {
    let mut table = Table::new([
        "method",
        "prepare",
        "far, median",
        "near, median",
        "near, p95",
        "deep, median",
        "all, median",
        "all, p95",
        "ours to it, medians",
    ]);
    let ours = median(&seconds(asked, OURS, None));
    for a in asked {
        let of = |class| seconds(asked, a.name, class);
        let [far, near, deep] = Class::ALL.map(|class| of(Some(class)));
        let all = of(None);
        let mut row = vec![a.name.to_owned()];
        row.extend([a.prepare, median(&far), median(&near), p95(&near), median(&deep)].map(time));
        row.extend([median(&all), p95(&all)].map(time));
        row.push(if a.name == OURS { String::new() } else { ratio(ours / median(&all)) });
        table.row(row);
    }
    table
}

/// A panel for each class of pose, a row for each method, a mark for each pose.
fn strips(asked: &[Asked]) -> Figure {
    let all = || asked.iter().flat_map(|a| seconds(asked, a.name, None)).map(|s| 1e3 * s);
    let range = 0.8 * all().fold(f64::INFINITY, f64::min)..1.25 * all().fold(0.0, f64::max);
    let names = || asked.iter().rev().map(|a| a.name);
    let panel = |class: Class| {
        let x = Axis::log("query (ms)").range(range.clone());
        let mut panel = Panel::new(x, Axis::names("", names()));
        for (row, name) in names().enumerate() {
            let (row, seconds) = (row as f64, seconds(asked, name, Some(class)));
            let spread = |i: usize| row + 0.28 * ((i % 7) as f64 / 3.0 - 1.0);
            let marks = seconds.iter().enumerate().map(|(i, s)| (1e3 * s, spread(i)));
            let middle = (1e3 * median(&seconds), row - 0.42, row + 0.42);
            panel = panel
                .series(Series::points("", marks).color(palette::SKY).size(3))
                .series(Series::whiskers("", [middle]).color(palette::BLACK));
        }
        panel.title(&format!("{} poses", class.name()))
    };
    let figure = Figure::new("Prepared queries, 2 mm of noise").columns(1).panel_size(800, 230);
    Class::ALL.into_iter().map(panel).fold(figure, Figure::panel)
}

#[cfg(test)]
mod tests {
    use super::{super::asked::tests::asked, *};

    #[test]
    fn a_slow_class_misses_its_target_alone() {
        let right = [false, false, true];
        let both = [asked(OURS, right, [5e-6, 2e-3, 6e-4]), asked(MESHES, right, [1e-3; 3])];
        let met: Vec<_> = judged(&both, STD).iter().map(|target| target.met).collect();
        assert_eq!(met, [true, true, false, true].map(Some));
        assert_eq!(judged(&both, LARGE_STD)[0].met, Some(true));
        strips(&both).svg().unwrap();
    }
}
