//! What a caller sees of a solve while it runs, and how it stops one.

use std::ops::ControlFlow;

use crate::certificate::Certificate;
use crate::status::Rung;

/// One entry of the iteration log. Where the interior point method works on some of the points, the values
/// are those of a problem of these alone.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Which rung is at work.
    pub rung: Rung,
    /// Its steps or iterations so far.
    pub iteration: usize,
    /// Value of eq. 10 at the present w and the best b for it.
    pub primal: f64,
    /// Value of eq. 13 at the present multipliers.
    pub dual: f64,
    /// (primal − dual) / primal; infinite while it cannot be told.
    pub relative_gap: f64,
    /// By how much the optimality conditions are missed, in margins: how far apart the values are
    /// that b must not exceed and must not fall below.
    pub violation: f64,
}

/// What a caller looks on with.
pub(crate) type Look<'w> = dyn FnMut(&Progress) -> ControlFlow<()> + 'w;

/// The caller's closure, and whether it has said to stop.
pub(crate) struct Watch<'w> {
    look: Option<&'w mut Look<'w>>,
    cancelled: bool,
}

impl<'w> Watch<'w> {
    /// A solve that nobody watches.
    pub(crate) fn nobody() -> Self {
        Self { look: None, cancelled: false }
    }

    pub(crate) fn new(look: &'w mut Look<'w>) -> Self {
        Self { look: Some(look), cancelled: false }
    }

    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancelled
    }

    /// Shows where a rung is; true when the solve is to stop.
    pub(crate) fn shows_stop(
        &mut self,
        rung: Rung,
        iteration: usize,
        certificate: &Certificate,
        violation: impl FnOnce() -> f64,
    ) -> bool {
        let relative_gap = certificate.relative_gap();
        tracing::trace!(?rung, iteration, certificate.primal, certificate.dual, relative_gap);
        if let Some(look) = self.look.as_mut().filter(|_| !self.cancelled) {
            let progress = Progress {
                rung,
                iteration,
                primal: certificate.primal,
                dual: certificate.dual,
                relative_gap,
                violation: violation(),
            };
            self.cancelled = look(&progress).is_break();
        }
        self.cancelled
    }
}
