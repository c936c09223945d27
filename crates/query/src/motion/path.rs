//! The path of a body.

use cloudtouch_geom::Pose;

use crate::check::coordinates::bad_entry;
use crate::doubt::warning::Warning;
use crate::error::QueryError;

use super::leg::Leg;

/// How B moves against A: poses from the file frame of B into that of A, and what is between them.
///
/// Shares of a path, from 0 at its beginning to 1 at its end, give every segment the same part,
/// however long it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    legs: Vec<Leg>,
}

impl Path {
    /// From one pose to another: the origin of B along a straight line, its rotation by slerp, both at
    /// constant speed and by the shorter turn; of half a turn rounding decides which way round.
    ///
    /// # Errors
    /// When a pose is not finite or beyond 1e10 m, or both are the same.
    pub fn linear(from: &Pose, to: &Pose) -> Result<Self, QueryError> {
        Self::of(&[*from, *to], Leg::linear)
    }

    /// From one pose to another about one axis and along it, as a screw turns: what a joint does.
    ///
    /// # Errors
    /// As [`Self::linear`].
    pub fn screw(from: &Pose, to: &Pose) -> Result<Self, QueryError> {
        Self::of(&[*from, *to], Leg::screw)
    }

    /// Through poses, from each to the next as in [`Self::linear`]. One may come twice in turn: the
    /// body waits.
    ///
    /// # Errors
    /// With fewer than two poses, when one is not finite or beyond 1e10 m, or all are the same.
    pub fn through(poses: &[Pose]) -> Result<Self, QueryError> {
        Self::of(poses, Leg::linear)
    }

    /// Through poses, from each to the next as in [`Self::screw`].
    ///
    /// # Errors
    /// As [`Self::through`].
    pub fn through_by_screws(poses: &[Pose]) -> Result<Self, QueryError> {
        Self::of(poses, Leg::screw)
    }

    fn of(poses: &[Pose], leg: impl Fn(Pose, Pose) -> Leg) -> Result<Self, QueryError> {
        let count = poses.len();
        let bad = |(index, pose): (usize, &Pose)| bad_entry(pose).map(|value| (index, value));
        if let Some((index, value)) = poses.iter().enumerate().find_map(bad) {
            return Err(QueryError::PathPose { index, value });
        }
        if count < 2 {
            return Err(QueryError::TooFewPoses { count });
        }
        let legs: Vec<Leg> = poses.windows(2).map(|ends| leg(ends[0], ends[1])).collect();
        if legs.iter().all(Leg::is_still) {
            return Err(QueryError::NoMotion { count });
        }
        Ok(Self { legs })
    }

    /// How many segments it has, one fewer than poses.
    pub fn segments(&self) -> usize {
        self.legs.len()
    }

    /// A warning of the first segment of which rounding decides which way round it turns.
    pub(super) fn warning(&self) -> Option<Warning> {
        let pose = self.legs.iter().position(Leg::is_half_turn)?;
        Some(Warning::HalfTurn { pose })
    }

    /// The pose at a share of the path, from 0 to 1; at the ends beyond them. NaN gives a pose of NaN, which every
    /// query refuses.
    pub fn pose(&self, share: f64) -> Pose {
        let (segment, time) = self.place(share);
        self.legs[segment].at(time)
    }

    /// Segment and time in it, from 0 to 1, at a share of the path.
    pub(super) fn place(&self, share: f64) -> (usize, f64) {
        let along = share.clamp(0.0, 1.0) * self.legs.len() as f64;
        let segment = (along as usize).min(self.legs.len() - 1);
        (segment, along - segment as f64)
    }

    pub(super) fn leg(&self, segment: usize) -> &Leg {
        &self.legs[segment]
    }
}
