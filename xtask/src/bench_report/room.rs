//! The piano in the room, prepared: every method asked about every pose in turn.

use std::fmt::Write as _;

use anyhow::{Context, Result};

use super::{
    Run, Section,
    method::{self, MESHES, Method, OURS, SIZE, Said},
    plots,
    poses::{Class, Posed},
    scene::{POINTS, STD, Scene},
    target::Target,
    timing::{median, p95, ratio, time, timed},
};
use crate::common::{statistics::auc, table::Table};

/// The larger of the two noises, m.
const LARGE_STD: f64 = 0.01;

/// What one method said of all poses and how long it took.
pub(super) struct Asked {
    pub(super) name: &'static str,
    prepare: f64,
    pub(super) said: Vec<Said>,
    /// The least of the repeats, s.
    pub(super) seconds: Vec<f64>,
}

impl Asked {
    /// The times of one class, or of all.
    pub(super) fn of(&self, poses: &[Posed], class: Option<Class>) -> Vec<f64> {
        let is_of = |posed: &Posed| class.is_none_or(|class| posed.class == class);
        poses.iter().zip(&self.seconds).filter(|(p, _)| is_of(p)).map(|(_, &s)| s).collect()
    }

    /// Scores with the truth, of one class or of all.
    pub(super) fn scored(&self, poses: &[Posed], class: Option<Class>) -> Vec<(f64, bool)> {
        let is_of = |posed: &Posed| class.is_none_or(|class| posed.class == class);
        let pairs = poses.iter().zip(&self.said).filter(|(p, _)| is_of(p));
        pairs.map(|(p, said)| (said.score, p.pose.in_collision)).collect()
    }
}

/// Asks every method about each pose once, which is not timed, and then so often in turn.
pub(super) fn ask_in_turn(
    methods: &[Method],
    poses: &[Posed],
    repeats: usize,
) -> Result<Vec<Asked>> {
    let start = |m: &Method| Asked {
        name: m.name,
        prepare: m.prepare,
        said: Vec::new(),
        seconds: Vec::new(),
    };
    let mut asked: Vec<Asked> = methods.iter().map(start).collect();
    for posed in poses {
        let pose = &posed.pose.scene_from_object;
        for (method, asked) in methods.iter().zip(&mut asked) {
            asked.said.push((method.ask)(pose).context(method.name)?);
            asked.seconds.push(f64::INFINITY);
        }
        for _ in 0..repeats {
            for (method, asked) in methods.iter().zip(&mut asked) {
                let (said, seconds) = timed(|| (method.ask)(pose));
                said?;
                if let Some(least) = asked.seconds.last_mut() {
                    *least = least.min(seconds);
                }
            }
        }
    }
    Ok(asked)
}

/// What is said before the tables.
const INTRODUCTION: &str = "Room and piano, 10,000 points each, two clouds in the calibrated mode \
with default settings. A third of the poses is far (at least 10 cm apart), a third near (exact \
surfaces within 2 cm of one another, half free and half in overlap), a third deep (at least 5 cm of overlap). \
The methods take turns at each pose. The first answer is not timed: it fills what is computed once \
for all poses. Of the others the least time counts, for every method alike.";

/// Measures at both noises.
pub(super) fn measure(run: &Run<'_>) -> Result<Section> {
    let mut section = Section { title: "Prepared queries", ..Section::default() };
    writeln!(section.text, "{INTRODUCTION}\n\n{}\n", peers())?;
    for std in [STD, LARGE_STD] {
        let asked = ask_in_turn(&methods(&run.scene, std)?, &run.scene.poses, run.plan.repeats)?;
        section.targets.extend(targets(&asked, &run.scene.poses, std));
        write!(
            section.text,
            "### Noise of {:.0} mm\n\n{}\n{}\n",
            1e3 * std,
            times(&asked, &run.scene.poses),
            errors(&asked, &run.scene.poses)
        )?;
        if std == STD {
            plots::strips(&run.figures.join("performance-room.svg"), &asked, &run.scene.poses)?;
            section.text += "A mark is a pose, the bar is the median.\n\n![Times of queries by \
                             class of pose](figures/performance-room.svg)\n\n";
        }
    }
    section.text += "False stops: free poses that the method calls collisions, of all free poses. \
                     Misses: collisions that it does not, of all collisions. Ours calls from ½ on. \
                     AUC: how often a collision gets a larger score than a free pose, ties counting \
                     half; of a method that says only yes or no, that is what ties leave.\n";
    Ok(section)
}

fn peers() -> String {
    format!(
        "- `ours`: clouds that were refined (`Cloud::refined`), as for a scene that many poses are \
         tested in; `not refined`: as prepared for a frame that is looked at a few times; `geometry alone`: refined, \
         and no classifier is trained, so that the rest is what training costs.\n\
         - `parry3d, meshes`: `intersection_test` on the surfaces that the clouds were drawn from, in \
         about 10,000 triangles each. No sensor knows them: it is told more than the others.\n\
         - `parry3d, voxels`: cubes of {0:.0} cm about the points of the room, against the surface \
         of the piano.\n\
         - `kiddo, smallest distance`: the nearest point of the room for every point of the piano, \
         sought no farther than the smallest distance so far. It has no threshold, so no verdict.\n\
         - `capt, spheres`: balls of {0:.0} cm about the points of the piano against the points of \
         the room, up to the first hit, in single precision.",
        1e2 * SIZE
    )
}

fn methods(scene: &Scene, std: f64) -> Result<Vec<Method>> {
    let (room, piano) = (scene.room(POINTS, std), scene.piano(std));
    let (room_mesh, piano_mesh) = (scene.room_mesh(POINTS), scene.piano_mesh());
    Ok(vec![
        method::ours([&room, &piano], std)?,
        method::lazy([&room, &piano], std)?,
        method::geometry([&room, &piano], std)?,
        method::meshes([&room_mesh, &piano_mesh])?,
        method::voxels(&room, &piano_mesh)?,
        method::distance([&room, &piano])?,
        method::spheres([&room, &piano])?,
    ])
}

fn targets(asked: &[Asked], poses: &[Posed], std: f64) -> Vec<Target> {
    let of = |name: &str, class| {
        let found = asked.iter().find(|a| a.name == name);
        found.map(|a| a.of(poses, class)).unwrap_or_default()
    };
    let near = p95(&of(OURS, Some(Class::Near)));
    let at = format!("10k × 10k points, {:.0} mm of noise", 1e3 * std);
    if std == LARGE_STD {
        return vec![Target::at_most(format!("{at}: near, p95 ≤ 10 ms"), near, 0.01, time)];
    }
    let [ours, theirs] = [OURS, MESHES].map(|name| median(&of(name, None)));
    let compared = |r: f64| format!("{} ({} to {})", ratio(r), time(ours), time(theirs));
    let far = median(&of(OURS, Some(Class::Far)));
    let deep = median(&of(OURS, Some(Class::Deep)));
    vec![
        Target::at_most(
            format!("{at}: median ≤ 1.0 × parry3d on meshes"),
            ours / theirs,
            1.0,
            compared,
        ),
        Target::at_most(format!("{at}: far, median ≤ 10 µs"), far, 1e-5, time),
        Target::at_most(format!("{at}: deep, median ≤ 0.5 ms"), deep, 5e-4, time),
        Target::at_most(format!("{at}: near, p95 ≤ 3 ms"), near, 3e-3, time),
    ]
}

fn times(asked: &[Asked], poses: &[Posed]) -> Table {
    let mut table = Table::new(&[
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
    let ours = asked.iter().find(|a| a.name == OURS);
    let ours = ours.map_or(f64::NAN, |a| median(&a.of(poses, None)));
    for a in asked {
        let of = |class| a.of(poses, class);
        let [far, near, deep] = Class::ALL.map(|class| of(Some(class)));
        let all = of(None);
        let compared = ours / median(&all);
        table.row([
            a.name.into(),
            time(a.prepare),
            time(median(&far)),
            time(median(&near)),
            time(p95(&near)),
            time(median(&deep)),
            time(median(&all)),
            time(p95(&all)),
            if a.name == OURS { String::new() } else { ratio(compared) },
        ]);
    }
    table
}

/// How wrong each method is on these very poses.
pub(super) fn errors(asked: &[Asked], poses: &[Posed]) -> Table {
    let mut table = Table::new(&["method", "AUC", "AUC, near", "false stops", "misses"]);
    for a in asked {
        let wrong = |collides: bool| {
            let of = poses.iter().zip(&a.said).filter(|(p, _)| p.pose.in_collision == collides);
            let verdicts: Option<Vec<bool>> = of.map(|(_, said)| said.verdict).collect();
            verdicts.map_or("-".into(), |v| {
                format!("{} of {}", v.iter().filter(|v| **v != collides).count(), v.len())
            })
        };
        let three = |value: f64| if value.is_nan() { "-".into() } else { format!("{value:.3}") };
        let [all, near] =
            [None, Some(Class::Near)].map(|class| three(auc(&a.scored(poses, class))));
        table.row([a.name.into(), all, near, wrong(false), wrong(true)]);
    }
    table
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;
    use cloudtouch_testkit::poses::LabelledPose;

    use super::*;

    fn posed(class: Class, signed_distance: f64) -> Posed {
        let in_collision = signed_distance < 0.0;
        let scene_from_object = Pose::identity();
        Posed { class, pose: LabelledPose { scene_from_object, in_collision, signed_distance } }
    }

    fn asked(name: &'static str, said: &[(f64, bool)], seconds: &[f64]) -> Asked {
        let said = said.iter().map(|&(score, v)| Said { score, verdict: Some(v) }).collect();
        Asked { name, prepare: 0.01, said, seconds: seconds.to_vec() }
    }

    fn three() -> [Posed; 3] {
        [posed(Class::Far, 0.3), posed(Class::Near, 0.01), posed(Class::Deep, -0.1)]
    }

    #[test]
    fn times_are_those_of_a_class() {
        let a = asked(OURS, &[(0.0, false); 3], &[1.0, 2.0, 3.0]);
        assert_eq!(a.of(&three(), Some(Class::Near)), [2.0]);
        assert_eq!(a.of(&three(), None), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn a_slow_class_misses_its_target_alone() {
        let said = [(0.0, false); 3];
        let both = [asked(OURS, &said, &[5e-6, 2e-3, 6e-4]), asked(MESHES, &said, &[1e-3; 3])];
        let table = super::super::target::table(&targets(&both, &three(), STD)).to_string();
        let met: Vec<bool> = table.lines().skip(2).map(|line| line.contains("| yes")).collect();
        assert_eq!(met, [true, true, false, true], "{table}");
        let table = super::super::target::table(&targets(&both, &three(), LARGE_STD)).to_string();
        assert!(table.contains("near, p95 ≤ 10 ms | 2.00 ms  | yes"), "{table}");
    }

    #[test]
    fn false_stops_and_misses_are_counted_apart() {
        let a = asked("wrong", &[(0.2, false), (0.9, true), (0.1, false)], &[1.0; 3]);
        let table = errors(&[a], &three()).to_string();
        assert!(table.contains("| 1 of 2      | 1 of 1"), "{table}");
        assert!(table.contains("| 0.000 | -"), "{table}");
    }

    #[test]
    fn methods_take_turns_and_the_first_answer_is_not_timed() {
        use std::{cell::RefCell, rc::Rc};
        let calls = Rc::new(RefCell::new(String::new()));
        let method = |name: &'static str| {
            let calls = Rc::clone(&calls);
            let ask = move |_: &Pose| {
                calls.borrow_mut().push_str(name);
                Ok(Said { score: 0.0, verdict: None })
            };
            Method { name, prepare: 0.0, ask: Box::new(ask) }
        };
        let asked = ask_in_turn(&[method("a"), method("b")], &three()[..1], 2).unwrap();
        assert_eq!(*calls.borrow(), "ababab");
        assert!(asked.iter().all(|a| a.said.len() == 1 && a.seconds[0] < 1.0));
    }
}
