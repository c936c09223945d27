//! The report page of a robot along a path: where it is at each position given and where the path ends to be
//! free, and the worst pair there.

use std::path::Path;

use anyhow::Result;
use cloudtouch::{PairAnswer, Scene};
use cloudtouch_cli::files::joints::Joints;
use cloudtouch_page::{Cast, Fact, MOST_VIEWS, Page, View};
use cloudtouch_robot::{PathChecked, RobotChecker, SURROUNDINGS, Stopped};

use crate::pages::scene::{cast, doubts};
use crate::{answers, pages};

/// A position of the path that is shown.
struct Shown<'a> {
    /// Segments and a share of the next.
    at: f64,
    name: String,
    scene: Scene,
    worst: Option<&'a PairAnswer>,
}

impl Shown<'_> {
    fn view(&self, cast: &Cast) -> Result<View<'static>> {
        if let Some(pair) = self.worst {
            let name = format!("{}, {} / {}", self.name, pair.a, pair.b);
            if let Some(view) = cast.view(&self.scene, name, pair)? {
                return Ok(view);
            }
        }
        Ok(cast.overview(&self.scene, self.name.as_str())?)
    }
}

/// Writes a page of a path of positions; `taken_for` tells what each body is.
pub(crate) fn write(
    output: &Path,
    (checker, path, checked): (&RobotChecker, &[Joints], &PathChecked),
    (title, facts): (String, Vec<Fact>),
    taken_for: impl Fn(&str) -> String,
) -> Result<()> {
    let count = path.len();
    // Evenly many are left out where there are too many.
    let step = count.div_ceil(MOST_VIEWS - 2);
    let mut shown = Vec::new();
    for (index, (joints, found)) in path.iter().zip(&checked.given).enumerate().step_by(step) {
        let name = format!("Position {} of {count}: {}", index + 1, found.verdict());
        let (scene, worst) = (checker.scene_at(joints)?, found.pairs.first());
        shown.push(Shown { at: index as f64, name, scene, worst });
    }
    let ends = [(&checked.stopped, "free for certain no longer"), (&checked.later, "a collision")];
    for (stopped, what) in ends {
        if let Some(stopped) = stopped {
            insert(&mut shown, stopped, what, &joints_at(path, stopped), checker)?;
        }
    }
    let Some(first) = shown.first() else { return Ok(()) };
    let cast = cast(&first.scene, Some(SURROUNDINGS), taken_for)?;
    let views = shown.iter().map(|shown| shown.view(&cast)).collect::<Result<Vec<_>>>()?;
    let gravest = |shown: &Shown<'_>| shown.worst.is_some_and(|w| w.verdict() == checked.verdict());
    let until = if checked.is_unchecked() {
        answers::scene::NONE_ASKED.to_owned()
    } else {
        let until = answers::path::percent(checked.certified_free_until);
        format!("free for certain until {until} of the path")
    };
    let mut summary = vec![Fact::new(format!("All in all: {}", checked.verdict()), until)];
    summary.extend(facts);
    summary.extend(checked.given.first().into_iter().flat_map(doubts));
    let notes =
        (step > 1).then(|| format!("Of the {count} positions given every {step}th is shown."));
    let page = Page {
        title,
        summary,
        notes: notes.into_iter().collect(),
        start: shown.iter().position(gravest).unwrap_or(0),
        views,
        bodies: cast.into_bodies(),
        is_one_scene: true,
        ..Page::default()
    };
    pages::write(output, page)
}

/// Puts a place between positions among these, which are in order.
fn insert<'a>(
    shown: &mut Vec<Shown<'a>>,
    stopped: &'a Stopped,
    what: &str,
    joints: &Joints,
    checker: &RobotChecker,
) -> Result<()> {
    let at = stopped.segment as f64 + stopped.t;
    let index = shown.partition_point(|shown| shown.at < at);
    if let Some(same) = shown.get_mut(index).filter(|same| same.at == at) {
        same.name = format!("{}: {what}", same.name);
        return Ok(());
    }
    let name = format!("Segment {}, t = {:.3}: {what}", stopped.segment + 1, stopped.t);
    let scene = checker.scene_at(joints)?;
    shown.insert(index, Shown { at, name, scene, worst: stopped.pair.as_ref() });
    Ok(())
}

/// Each joint as far from one of its positions to the next.
fn joints_at(path: &[Joints], &Stopped { segment, t, .. }: &Stopped) -> Joints {
    let (from, to) = (&path[segment], &path[segment + 1]);
    let between = |(name, from): (&String, &f64)| {
        let to = to.get(name).unwrap_or(from);
        (name.clone(), from + (to - from) * t)
    };
    from.iter().map(between).collect()
}
