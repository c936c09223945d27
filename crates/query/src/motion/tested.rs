//! What the poses of a path say that were asked about, and of which stretches more is to be known then.

use crate::query::QuerySettings;
use crate::report::{Report, Verdict};

use super::interval::Interval;
use super::misgivings::Misgivings;
use super::swept::AlongPath;

/// The largest probability is known well enough to within this.
const PROBABILITY_TOLERANCE: f64 = 0.05;

/// What the poses that were asked about say.
#[derive(Debug)]
pub(super) struct Tested {
    /// The most probable.
    pub most_probable: AlongPath,
    /// The earliest above the accept threshold.
    pub first: Option<AlongPath>,
    /// The largest lower and upper bound of any.
    pub bounds: [f64; 2],
    /// The first that is not free, in segments: probable, or something speaks against believing it.
    pub not_free_from: f64,
    pub misgivings: Misgivings,
    settings: QuerySettings,
    /// In segments.
    tolerance: f64,
}

impl Tested {
    pub(super) fn of(begin: &AlongPath, settings: &QuerySettings, tolerance: f64) -> Self {
        let mut tested = Self {
            most_probable: begin.clone(),
            first: None,
            bounds: [0.0; 2],
            not_free_from: f64::INFINITY,
            misgivings: Misgivings::default(),
            settings: *settings,
            tolerance,
        };
        tested.add(begin.clone());
        tested
    }

    pub(super) fn add(&mut self, asked: AlongPath) {
        let Report { collision_probability: probability, bounds: [low, high], .. } = asked.report;
        self.bounds = [self.bounds[0].max(low), self.bounds[1].max(high)];
        let at = position(&asked);
        if asked.report.verdict != Verdict::Free {
            self.not_free_from = self.not_free_from.min(at);
        }
        self.misgivings.add(at, asked.report.undecided_by, &asked.report.warnings);
        let is_first = self.first.as_ref().is_none_or(|first| at < position(first));
        if probability > self.settings.accept && is_first {
            self.first = Some(asked.clone());
        }
        if probability > self.most_probable.report.collision_probability {
            self.most_probable = asked;
        }
    }

    /// In segments.
    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Nothing matters from here on, in segments: the threshold was reached.
    pub(super) fn end(&self) -> f64 {
        self.first.as_ref().map_or(f64::INFINITY, position)
    }

    /// Whether it is known to be open by the accept threshold, as far as its bound tells.
    pub(super) fn is_known_open(&self, interval: &Interval) -> bool {
        let accept = self.settings.accept;
        interval.upper > accept && interval.cut >= accept && interval.end() < self.end()
    }

    /// Whether that is to be looked at closer.
    pub(super) fn is_to_halve(&self, interval: &Interval) -> bool {
        interval.length() > self.tolerance && self.is_known_open(interval)
    }

    /// Whether two stretches are to be bounded as one.
    pub(super) fn may_join(&self, first: &Interval, second: &Interval) -> bool {
        self.is_unknown(first)
            && self.is_unknown(second)
            && first.end() == second.start()
            && first.segment == second.segment
    }

    /// Whether it lies before a pose above the threshold, and was not bounded by that threshold yet.
    pub(super) fn is_unknown(&self, interval: &Interval) -> bool {
        self.first.is_some()
            && interval.upper == 1.0
            && interval.cut < self.settings.accept
            && interval.end() < self.end()
    }

    /// Whether nothing but that is to be known of it.
    pub(super) fn is_left(&self, interval: &Interval) -> bool {
        self.is_unknown(interval) && !self.may_be_free(interval)
    }

    /// Whether a closer look could change the answer by more than the tolerances.
    pub(super) fn is_wanted(&self, interval: &Interval) -> bool {
        let may_become_free = !self.is_free(interval) && self.may_be_free(interval);
        interval.length() > self.tolerance
            && interval.start() < self.end()
            && (interval.upper > self.cut(interval) || may_become_free)
    }

    pub(super) fn is_free(&self, interval: &Interval) -> bool {
        interval.upper < self.settings.reject && !interval.is_doubtful
    }

    /// A pose before the first that is known not to be free may be free.
    pub(super) fn may_be_free(&self, interval: &Interval) -> bool {
        interval.start() < self.not_free_from
    }

    /// Bounds of a stretch up to this need no closer look.
    pub(super) fn cut(&self, interval: &Interval) -> f64 {
        let settings = &self.settings;
        if self.first.is_some() {
            // Beside the threshold it only matters where the path ceases to be free.
            return if self.may_be_free(interval) { settings.reject } else { settings.accept };
        }
        if interval.length() <= self.tolerance {
            // These are not halved: of them all that can be told counts.
            return 1.0;
        }
        if self.may_be_free(interval) {
            return settings.reject;
        }
        let known = self.most_probable.report.collision_probability;
        (known + PROBABILITY_TOLERANCE).max(settings.reject).min(settings.accept)
    }
}

/// In segments from the beginning.
fn position(at: &AlongPath) -> f64 {
    at.segment as f64 + at.t
}
