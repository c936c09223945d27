//! What speaks against believing poses along a path, each thing once.

use std::mem::discriminant;

use crate::doubt::undecided::Undecided;
use crate::doubt::warning::Warning;

/// The warnings and doubts about some poses of a path.
#[derive(Debug, Default)]
pub(super) struct Misgivings {
    /// With where they were met, in segments.
    doubts: Vec<(f64, Undecided)>,
    warnings: Vec<(f64, Warning)>,
}

impl Misgivings {
    pub(super) fn add(&mut self, at: f64, doubt: Option<Undecided>, warnings: &[Warning]) {
        self.doubts.extend(doubt.map(|doubt| (at, doubt)));
        for &warning in warnings {
            let known = |(_, other): &&mut (f64, Warning)| {
                discriminant(other) == discriminant(&warning) && other.body() == warning.body()
            };
            match self.warnings.iter_mut().find(known) {
                Some(earlier) if at < earlier.0 => *earlier = (at, warning),
                Some(_) => {}
                None => self.warnings.push((at, warning)),
            }
        }
    }

    /// The doubt about the earliest pose that there is one about.
    pub(super) fn earliest(&self) -> Option<Undecided> {
        self.doubts.iter().min_by(|(p, _), (q, _)| p.total_cmp(q)).map(|&(_, doubt)| doubt)
    }

    /// Each kind of warning about a body once, as of the earliest pose, in their order along the path.
    pub(super) fn into_warnings(mut self) -> Vec<Warning> {
        self.warnings.sort_by(|(p, _), (q, _)| p.total_cmp(q));
        self.warnings.into_iter().map(|(_, warning)| warning).collect()
    }
}
