//! How either of two bodies drifts as the other sees it.

use cloudtouch_geom::Drift;

use super::course::Course;

/// B drifts and A keeps still; what is told in the frame of B, of a plane of B say, is told of an A that
/// drifts the inverse way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drifts {
    /// Of A, as B sees it.
    pub of_a: Course,
    /// Of B, as A sees it.
    pub of_b: Course,
}

impl Drifts {
    pub(super) fn new(of_b: &Drift) -> Self {
        Self { of_a: Course::Along(of_b.inverse()), of_b: Course::Along(*of_b) }
    }

    /// Of one body, as the other sees it.
    pub(super) fn of(&self, is_a: bool) -> &Course {
        if is_a { &self.of_a } else { &self.of_b }
    }
}
