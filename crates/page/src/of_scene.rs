//! The page of a scene.

use cloudtouch::{Checked, PairAnswer, Scene, SceneError};

use crate::MOST_VIEWS;
use crate::body::Body;
use crate::cast::Cast;
use crate::fact::Fact;
use crate::page::Page;

impl Page<'static> {
    /// What was found of a scene: first all bodies, with what each was taken for, then the pairs that may touch, the
    /// worst first, at which it opens. Its summary has the verdict and the pairs without an answer; what is to be
    /// said of bodies by themselves ([`Checked::warnings`], [`Checked::outside`]) is for the caller to add.
    ///
    /// # Errors
    /// When the scene lacks a body of the cast.
    pub fn of_scene(cast: Cast, scene: &Scene, checked: &Checked) -> Result<Self, SceneError> {
        let about = |body: &Body| Fact::new(&body.name, &body.about);
        let told = cast.bodies().iter().filter(|body| !body.about.is_empty()).map(about);
        let mut views = vec![cast.overview(scene, "All bodies")?.with_more(told.collect())];
        let answered = checked.pairs.iter().filter(|pair| pair.answer.is_ok());
        let count = answered.clone().count();
        for pair in answered.take(MOST_VIEWS - 1) {
            views.extend(cast.view(scene, names(pair), pair)?);
        }
        let shown = views.len() - 1;
        let notes =
            (shown < count).then(|| format!("Of {count} pairs the {shown} worst are shown."));
        Ok(Self {
            summary: summary(checked),
            notes: notes.into_iter().collect(),
            bodies: cast.into_bodies(),
            start: usize::from(shown > 0),
            views,
            is_one_scene: true,
            ..Self::default()
        })
    }
}

fn summary(checked: &Checked) -> Vec<Fact> {
    let Checked { count, allowed, ruled_out, asked, .. } = *checked;
    let pairs = if checked.is_unchecked() {
        format!("none was asked about: all may touch by what was said, {allowed} left out")
    } else {
        format!(
            "{} of {count} pairs do not read as free; {asked} asked, {ruled_out} ruled out by their boxes, \
             {allowed} left out",
            checked.pairs.len()
        )
    };
    let without = checked.pairs.iter().filter_map(|pair| {
        let error = pair.answer.as_ref().err()?;
        Some(Fact::new(format!("No answer: {}", names(pair)), error.to_string()))
    });
    let verdict = Fact::new(format!("All in all: {}", checked.verdict()), pairs);
    std::iter::once(verdict).chain(without).collect()
}

fn names(pair: &PairAnswer) -> String {
    format!("{} / {}", pair.a, pair.b)
}
