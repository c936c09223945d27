//! The report page of a batch.

use std::path::Path;

use anyhow::Result;
use cloudtouch::geom::Pose;
use cloudtouch::{Placement, Report};
use cloudtouch_io::ReadLimits;
use cloudtouch_page::{Body as Drawn, Fact, Page, Shortlist, View};

use crate::body::PreparedCloud;
use crate::inside::with_points_inside;
use crate::load::Loaded;
use crate::margin::Nearness;
use crate::{answers, pages};

/// A report with where the object was and what the files were taken for.
pub(crate) struct Answered<'a, C> {
    pub report: Report,
    pub placement: Placement,
    pub pose: &'a Pose,
    /// Scene and object, each with its file.
    pub bodies: [(&'a Path, &'a Loaded<C>); 2],
    pub nearness: Option<Nearness>,
}

impl<C: PreparedCloud> Answered<'_, C> {
    /// The report with what a picture shows beside points that may touch.
    fn colored(&self) -> Report {
        let [scene, object] = self.bodies.map(|(_, loaded)| &loaded.body);
        with_points_inside(self.report.clone(), (scene, object), self.pose)
    }
}

/// What a page shows of a batch, gathered case by case.
pub(crate) struct Shown<'a, C> {
    answers: Shortlist<(&'a str, Answered<'a, C>)>,
    /// Cases without an answer, by name and reason.
    errors: Vec<(&'a str, String)>,
}

/// Cases without an answer that are named one by one.
const ERRORS_NAMED: usize = 20;

impl<'a, C: PreparedCloud> Shown<'a, C> {
    pub(crate) fn new() -> Self {
        Self { answers: Shortlist::default(), errors: Vec::new() }
    }

    pub(crate) fn push(&mut self, id: &'a str, answer: Result<Answered<'a, C>, String>) {
        match answer {
            Ok(answered) => self.answers.push(answered.report.bounds[1], (id, answered)),
            Err(error) => self.errors.push((id, error)),
        }
    }

    /// Writes the page of a case file.
    pub(crate) fn write(self, path: &Path, cases: &str, limits: &ReadLimits) -> Result<()> {
        let summary = unanswered(&self.errors);
        let (answers, note) = self.answers.finish();
        let mut known: Vec<&Loaded<C>> = Vec::new();
        let mut bodies = Vec::new();
        let mut views = Vec::new();
        let colored: Vec<Report> = answers.iter().map(|(_, answered)| answered.colored()).collect();
        for ((id, answered), colored) in answers.iter().zip(&colored) {
            let mut places = [0; 2];
            for (place, (file, loaded)) in places.iter_mut().zip(answered.bodies) {
                let found = known.iter().position(|body| std::ptr::eq(*body, loaded));
                *place = found.unwrap_or(known.len());
                if found.is_none() {
                    known.push(loaded);
                    bodies.push(pages::body(loaded, Some(file), limits)?);
                }
            }
            let [(_, scene), _] = answered.bodies;
            let not_seen = answers::text::not_seen(colored, !scene.is_mesh());
            let nearness = answered.nearness.as_ref().map(answers::text::nearness);
            let view = View::of_pair(*id, places, *answered.pose, colored);
            let view = view.with_placement(&answered.placement);
            views.push(view.with_more(not_seen.into_iter().chain(nearness).collect()));
        }
        tell_apart(&mut bodies, &known);
        let title = format!("{} poses of {cases}", views.len());
        let notes = note.into_iter().collect();
        pages::write(path, Page { title, summary, notes, bodies, views, ..Page::default() })
    }
}

/// Names files of one name with their folders.
fn tell_apart<C>(bodies: &mut [Drawn], loaded: &[&Loaded<C>]) {
    let names: Vec<String> = bodies.iter().map(|body| body.name.clone()).collect();
    for (body, loaded) in bodies.iter_mut().zip(loaded) {
        if names.iter().filter(|name| **name == body.name).count() > 1 {
            body.name.clone_from(&loaded.input.file);
        }
    }
}

fn unanswered(errors: &[(&str, String)]) -> Vec<Fact> {
    let named = errors.iter().take(ERRORS_NAMED);
    let mut facts: Vec<Fact> =
        named.map(|(id, error)| Fact::new(format!("No answer: {id}"), error)).collect();
    if errors.len() > ERRORS_NAMED {
        let more = errors.len() - ERRORS_NAMED;
        facts.push(Fact::new("No answer", format!("{more} more cases: see the table or the JSON")));
    }
    facts
}
