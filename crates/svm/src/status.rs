//! How a solve, or one rung of it, ended.

use std::fmt;

/// How a solve, or one rung of it, ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Status {
    /// The recomputed relative gap is within the tolerance.
    Converged,
    /// The gap is small beside the objective, but w = 0 cannot be excluded (|w|² ≤ gap): the
    /// ellipsoids leave no surface between the clouds, and probabilities read off f would be noise.
    /// Said of a gap within the tolerance or, where that was out of reach, of at most 3e-2.
    Collapsed,
    /// The steps that SMO may take ran out.
    StepLimit,
    /// SMO left early: at the rate its gap shrank its steps would not have sufficed.
    SlowProgress,
    /// Rounding stopped the progress short of the tolerance.
    Stalled,
    /// The iterations of a second-order method ran out.
    IterationLimit,
    /// The problem has too many variables for a second-order method.
    TooLarge,
    /// Clarabel did not take the problem.
    Refused,
    /// Clarabel is not built in: the feature `clarabel` is off.
    NotBuilt,
    /// The caller's watch said to stop.
    Cancelled,
    /// Numbers left the range of `f64`; nothing in the solution can be used.
    NotFinite,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Converged => "converged",
            Self::Collapsed => "collapsed: no surface separates the classes",
            Self::StepLimit => "ran out of steps",
            Self::SlowProgress => "left early, its gap shrank too slowly",
            Self::Stalled => "stalled by rounding",
            Self::IterationLimit => "ran out of iterations",
            Self::TooLarge => "too large for a second-order method",
            Self::Refused => "refused by Clarabel",
            Self::NotBuilt => "Clarabel is not built in",
            Self::Cancelled => "cancelled",
            Self::NotFinite => "left the range of f64",
        })
    }
}

/// The rungs of the ladder of solvers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Rung {
    /// Sequential minimal optimisation with ball steps.
    Smo,
    /// The dense interior point method of this crate.
    InteriorPoint,
    /// Clarabel's interior point method on the same dual.
    Clarabel,
}

impl fmt::Display for Rung {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Smo => "SMO",
            Self::InteriorPoint => "interior point method",
            Self::Clarabel => "Clarabel",
        })
    }
}

/// How each rung ended the last time it was tried; `None` for one that was not.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ends {
    /// SMO from the start handed in.
    pub smo: Option<Status>,
    /// The interior point method, with the steps of SMO that polish its answer.
    pub interior_point: Option<Status>,
    /// Clarabel, with the steps of SMO that polish its answer.
    pub clarabel: Option<Status>,
}

impl Ends {
    pub(crate) fn note(&mut self, rung: Rung, status: Status) {
        *match rung {
            Rung::Smo => &mut self.smo,
            Rung::InteriorPoint => &mut self.interior_point,
            Rung::Clarabel => &mut self.clarabel,
        } = Some(status);
    }

    /// These, and of the others those of rungs that these did not try.
    pub(crate) fn or(self, others: Self) -> Self {
        Self {
            smo: self.smo.or(others.smo),
            interior_point: self.interior_point.or(others.interior_point),
            clarabel: self.clarabel.or(others.clarabel),
        }
    }

    /// What kept the ladder from the tolerance: how the last rung ended that did any work, or that
    /// the problem is too large for all after SMO.
    pub(crate) fn why_not(&self) -> Status {
        let [smo, interior, clarabel] = [self.smo, self.interior_point, self.clarabel];
        let worked = |status: &Status| {
            !matches!(status, Status::TooLarge | Status::Refused | Status::NotBuilt)
        };
        let last = [clarabel, interior].into_iter().flatten().find(worked);
        let too_large = [clarabel, interior].contains(&Some(Status::TooLarge));
        let too_large = too_large.then_some(Status::TooLarge);
        last.or(too_large).or(smo).or(clarabel).unwrap_or(Status::StepLimit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_rung_that_worked_says_why() {
        let mut ends = Ends::default();
        ends.note(Rung::Smo, Status::SlowProgress);
        assert_eq!(ends.why_not(), Status::SlowProgress);
        ends.note(Rung::Clarabel, Status::NotBuilt);
        assert_eq!(ends.why_not(), Status::SlowProgress);
        ends.note(Rung::InteriorPoint, Status::TooLarge);
        assert_eq!(ends.why_not(), Status::TooLarge);
        ends.note(Rung::InteriorPoint, Status::Stalled);
        assert_eq!(ends.why_not(), Status::Stalled);
        ends.note(Rung::Clarabel, Status::IterationLimit);
        assert_eq!(ends.why_not(), Status::IterationLimit);
        let alone = Ends { clarabel: Some(Status::Refused), ..Ends::default() };
        assert_eq!(alone.why_not(), Status::Refused);
    }
}
