//! What speaks against believing that a pair is free, of a pair at a pose.

use cloudtouch_geom::Pose;

use crate::doubt::enclosed::is_enclosed;
use crate::doubt::of_pair::doubts;
use crate::doubt::taken::knows_taken;
use crate::doubt::undecided::Undecided;
use crate::doubt::unseen::Unseen;
use crate::doubt::unseen::{knows_unseen, unseen};
use crate::doubt::warning::{Warning, Which};
use crate::shape::Shape;

use super::terms::Terms;

/// Bodies farther apart than so many standard deviations are so, however large these are said to be.
pub(crate) const CLEAR_DEVIATIONS: f64 = 3.0;

/// Whether a warning counts where bodies are so clear of each other, or not known to be: noise that points do
/// not have only makes them seem nearer than they are.
fn counts(warning: &Warning, is_clear: bool) -> bool {
    !(is_clear && matches!(warning, Warning::NoiseOverstated { .. }))
}

/// What was found.
#[derive(Default)]
pub(super) struct Doubts {
    pub unseen: Option<Unseen>,
    /// All, those too that do not keep the pair from reading as free.
    pub warnings: Vec<Warning>,
    /// The gravest reason not to believe that it is free; `None` too where nobody would.
    pub gravest: Option<Undecided>,
}

impl Terms {
    /// Of a pair, `local` mapping local frames, that may read as free or may not; `is_clear` says that they
    /// are no fewer than [`CLEAR_DEVIATIONS`] apart.
    pub(super) fn doubts(
        &self,
        (a, b): (Shape<'_>, Shape<'_>),
        local: &Pose,
        is_clear: bool,
        may_be_free: bool,
    ) -> Doubts {
        let unseen = unseen(a, b, local, may_be_free, is_clear);
        let warnings =
            doubts((a, b), Some(local), unseen.as_ref(), self.are_alone, &self.safeguards);
        let gravest = || {
            let mut counting = warnings.iter().filter(|warning| counts(warning, is_clear));
            let enclosed = || is_enclosed(a, b, local).then_some(Undecided::Enclosed);
            counting.find_map(|warning| self.reason(warning)).or_else(enclosed)
        };
        let gravest = if may_be_free { gravest() } else { None };
        Doubts { unseen, warnings, gravest }
    }

    /// The gravest reason not to believe that a pair is free at a pose, if it should read so, and the
    /// warnings about it; `is_clear` says that they are no fewer than [`CLEAR_DEVIATIONS`] apart.
    pub(crate) fn doubt_at(
        &self,
        (a, b): (Shape<'_>, Shape<'_>),
        a_from_b: &Pose,
        is_clear: bool,
    ) -> (Option<Undecided>, Vec<Warning>) {
        let local = a.local_from(&b, a_from_b);
        let Doubts { warnings, gravest, .. } = self.doubts((a, b), &local, is_clear, true);
        (gravest, warnings)
    }

    /// Whether one of the two may be doubted wherever they lie, A beside a body no smaller than B or B beside one no
    /// larger than A: what it is like, how large it is beside the other, and what it did not see.
    pub(crate) fn may_doubt(&self, (a, b): (Shape<'_>, Shape<'_>), which: Which) -> bool {
        let is_of = |warning: &&Warning| warning.body() == Some(which);
        let warnings = doubts((a, b), None, None, self.are_alone, &self.safeguards);
        // Pairs that nobody looks at are clear of each other.
        let mut of_it = warnings.iter().filter(is_of).filter(|warning| counts(warning, true));
        let shape = if which == Which::A { a } else { b };
        knows_unseen(shape)
            || knows_taken(shape)
            || of_it.any(|warning| self.reason(warning).is_some())
    }

    /// Why a pair with this warning does not read as free; `None` where it may.
    fn reason(&self, warning: &Warning) -> Option<Undecided> {
        if matches!(warning, Warning::FarAway { .. }) && !self.are_alone {
            return None;
        }
        let counts =
            |reason: &Undecided| *reason != Undecided::Units || self.safeguards.doubt_units;
        warning.undecides().filter(counts)
    }
}
