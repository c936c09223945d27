//! The report page of a scene, or of a robot at one position: all bodies, and each pair that may touch.

use std::path::Path;

use anyhow::Result;
use cloudtouch::{Checked, PairAnswer, Report, Scene};
use cloudtouch_page::{Fact, MOST_VIEWS, Page};

use crate::pages::cast::{Cast, colored, doubts, names};
use crate::{answers, pages};

/// What a page of a scene is about.
pub(crate) struct About<'a> {
    pub title: String,
    /// The body that keeps its place, or the largest does.
    pub first: &'a str,
    pub threshold: f64,
    /// What is to be said of the question.
    pub facts: Vec<Fact>,
}

/// Writes a page of what was found; `taken_for` tells what each body is.
pub(crate) fn write(
    output: &Path,
    (scene, checked): (&Scene, &Checked),
    about: About<'_>,
    taken_for: impl Fn(&str) -> String,
) -> Result<()> {
    let cast = Cast::of(scene, about.first, taken_for)?;
    let answered = checked.pairs.iter().filter_map(|pair| Some((pair, colored(pair, scene)?)));
    let answered: Vec<(&PairAnswer, Report)> = answered.take(MOST_VIEWS - 1).collect();
    let mut views = vec![cast.overview(scene, "All bodies")?.with_more(cast.facts(scene))];
    for (pair, report) in &answered {
        views.push(cast.view(scene, names(pair), (pair, report))?);
    }
    let mut summary =
        vec![Fact::new(verdict(checked), answers::scene::counts(checked, about.threshold))];
    summary.extend(about.facts);
    summary.extend(doubts(checked));
    let page = Page {
        title: about.title,
        summary,
        notes: left_out(checked, answered.len()).into_iter().collect(),
        // The worst pair, if there is one.
        start: usize::from(!answered.is_empty()),
        views,
        bodies: cast.into_bodies(),
        is_one_scene: true,
        ..Page::default()
    };
    pages::write(output, page)
}

fn verdict(checked: &Checked) -> String {
    format!("All in all: {}", checked.verdict())
}

fn left_out(checked: &Checked, shown: usize) -> Option<String> {
    let answered = checked.pairs.iter().filter(|pair| pair.answer.is_ok()).count();
    (shown < answered).then(|| format!("Of {answered} pairs the {shown} worst are shown."))
}
