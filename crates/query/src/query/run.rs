//! One query on the default path, from two prepared bodies and a pose to a report.

use std::time::Instant;

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::error::{QueryError, SettingsError};
use crate::mode::Mode;
use crate::record::{Closeness, Terms};
use crate::report::Report;

use super::blur::blur;
use super::estimate::estimate;
use super::settings::{Detail, QuerySettings};
use super::task::Task;

/// A checked set of settings that answers queries; cheap to copy, shared by threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Query {
    settings: QuerySettings,
    /// When what is asked on behalf of one call began, where that is more than one query: all share its time.
    begun: Option<Instant>,
    /// Whether the two bodies of a pair are all there is.
    are_alone: bool,
}

impl Query {
    /// Checks the settings.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn new(settings: QuerySettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, begun: None, are_alone: true })
    }

    /// The settings, as checked.
    pub fn settings(&self) -> &QuerySettings {
        &self.settings
    }

    /// The same with more or less said.
    pub(crate) fn with_detail(&self, detail: Detail) -> Self {
        Self { settings: QuerySettings { detail, ..self.settings }, ..*self }
    }

    /// The same, but a probability where no more than the verdict is asked for, whose probability is one of many.
    pub(super) fn with_probability(&self) -> Self {
        match self.settings.detail {
            Detail::Free | Detail::Verdict => self.with_detail(Detail::Probability),
            Detail::Probability | Detail::Full => *self,
        }
    }

    /// The same query with both thresholds at this probability, and no more than its verdict.
    pub(super) fn deciding(&self, probability: f64) -> Self {
        let (accept, reject, detail) = (probability, probability, Detail::Verdict);
        Self { settings: QuerySettings { accept, reject, detail, ..self.settings }, ..*self }
    }

    /// The same to the end: it does not stop where a collision is likely enough, and tells all.
    pub(super) fn unstopped(&self) -> Self {
        let (stop_above, detail) = (f64::INFINITY, Detail::Full);
        Self { settings: QuerySettings { stop_above, detail, ..self.settings }, ..*self }
    }

    /// The same, whose deadline counts from now on for all that is asked of it together: for calls that ask many
    /// pairs or poses. A time that has begun goes on.
    #[must_use]
    pub fn begun_now(&self) -> Self {
        Self { begun: self.begun.or_else(|| Some(Instant::now())), ..*self }
    }

    /// The same for pairs out of many bodies, such as the links of a robot. Most of these are far from most: that two
    /// are, or are of unlike sizes, is less of a reason to doubt them
    /// ([`Undecided::Units`](crate::Undecided::Units)) than of an object and its scene.
    /// [`Scene::check`](crate::Scene::check) asks so, the larger body first.
    #[must_use]
    pub fn among_many(&self) -> Self {
        Self { are_alone: false, ..*self }
    }

    pub(crate) fn clock(&self, start: Instant) -> Clock {
        Clock::new(self.begun.unwrap_or(start), self.settings.deadline)
    }

    pub(crate) fn terms(&self) -> Terms {
        Terms {
            mode: Mode::Calibrated,
            seed: 0,
            accept: self.settings.accept,
            reject: self.settings.reject,
            safeguards: self.settings.safeguards,
            // What is not free whatever it says is done with.
            doubted_below: match self.settings.detail {
                Detail::Free => self.settings.reject,
                _ => f64::INFINITY,
            },
            are_alone: self.are_alone,
            max_contacts: self.settings.max_contacts,
            closeness: Closeness::default(),
        }
    }

    pub(super) fn task(&self, start: Instant, bodies: (BodyRef<'_>, BodyRef<'_>)) -> Task<'_> {
        let (settings, classifier) = (&self.settings, self.settings.classifier());
        let blur = blur(bodies);
        let judge = settings.judge.for_blur(blur);
        Task { settings, judge, blur, classifier, clock: self.clock(start) }
    }

    /// How likely it is that the surfaces behind two bodies collide.
    ///
    /// `a_from_b` maps the file frame of `b` into that of `a`; nothing is rebuilt for it. Contacts
    /// are in the frame of `a`, with normals from `a` to `b`. The answer rests on the points
    /// sampled: surface that no point stands for cannot be found in collision.
    ///
    /// # Errors
    /// When the pose is not finite or beyond 1e10 m, two meshes cannot be tested exactly, or a mesh
    /// takes more parts than allowed to be sampled as densely as the cloud. A pair that could not be
    /// decided is not an error but a verdict, and never reads as free.
    pub fn run<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
    ) -> Result<Report, QueryError> {
        self.ask(&self.terms(), (a.into(), b.into()), a_from_b)
    }

    /// [`Self::run`] for a pair among many bodies; one that is astray is doubted for its distance too.
    pub(crate) fn run_in_scene(
        &self,
        bodies: (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
        is_astray: bool,
    ) -> Result<Report, QueryError> {
        self.ask(&Terms { are_alone: is_astray, ..self.terms() }, bodies, a_from_b)
    }

    fn ask(
        &self,
        terms: &Terms,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
    ) -> Result<Report, QueryError> {
        terms.ask((a.shape(), b.shape()), a_from_b, |start, local, evidence| {
            estimate((a, b), local, &self.task(start, (a, b)), evidence)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn what_one_call_asks_has_its_time_together() {
        let settings = QuerySettings { deadline: Some(Duration::ZERO), ..QuerySettings::default() };
        let query = Query::new(settings).unwrap();
        let later = Instant::now() + Duration::from_secs(3600);
        assert!(!query.clock(later).is_over());
        assert!(query.begun_now().deciding(0.1).clock(later).is_over());
    }
}
