//! What a query is asked to do, checked once.

use std::time::Duration;

use cloudtouch_svm::Kernel;

use crate::check::settings::{fraction, positive, thresholds};
use crate::classifier::ClassifierSettings;
use crate::doubt::safeguards::Safeguards;
use crate::error::SettingsError;
use crate::judge::Judge;

/// How much of an answer is wanted: the less, the sooner it comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Detail {
    /// Whether the pair is free, and no more: as [`Self::Verdict`], but a search ends when the probability is surely
    /// not below `reject`, and nothing else is asked about the pair then: it has no warnings. The verdict is
    /// [`Free`](crate::Verdict::Free) where that of a whole report is; any other may be another one there too. For
    /// planners: [`Query::is_free`](crate::Query::is_free).
    Free,
    /// The verdict: a search ends when the probability is surely above `accept`, looks for no more than the nearest
    /// places where it is surely below `reject`, and asks no classifier that cannot change it. The probability is
    /// one of those that lead to that verdict, and its bounds are as wide as that leaves them. Without contacts,
    /// clearance and points. A [sweep](crate::Query::sweep) ends at the first pose that is not free. Calls that
    /// tell another number too, such as [`within`](crate::Query::within), take it for [`Self::Probability`].
    Verdict,
    /// The probability with its bounds, the same bits as in a full report. Without contacts, clearance
    /// and points.
    Probability,
    /// The whole report.
    #[default]
    Full,
}

/// All settings of a query on the default path; [`Query::new`](crate::Query::new) checks them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuerySettings {
    /// A: a pair with a higher probability is in collision; at least ½.
    pub accept: f64,
    /// B: a pair with a lower probability is free; at most ½.
    pub reject: f64,
    /// From evidence to log odds, and where the classifier is asked.
    pub judge: Judge,
    /// Which share of the poses asked about collides, before anything is known of them: between 0
    /// and 1. The fit is for one half; a planner whose poses mostly collide, or hardly ever, knows
    /// better.
    pub prior: f64,
    /// γ of the Gaussian kernel exp(−γ‖x − y‖²) that a contact patch, scaled to the unit box, is separated with:
    /// the larger, the narrower it is.
    pub gamma: f64,
    /// C: what a misclassified point costs, before balancing by class size.
    pub penalty: f64,
    /// How many times as much a misclassified mesh point costs: a mesh is trusted.
    pub mesh_penalty_factor: f64,
    /// r: radius of the uncertainty ellipsoids, in standard deviations (eq. 11, 12).
    pub ellipsoid_radius: f64,
    /// Relative gap at which a kernel problem counts as solved; between 0 and 1, where more than .03 counts as
    /// that.
    pub relative_gap: f64,
    /// The search, and the look inside closed meshes, end when a collision is this certain; 1 never ends
    /// them early. Contacts are those found until then: all of a patch, and its area, need a 1 here and as large a
    /// `max_contacts` as there are places in it.
    pub stop_above: f64,
    /// How much of the answer is wanted.
    pub detail: Detail,
    /// How long a query may search, and a call that asks several
    /// ([`Query::penetration`](crate::Query::penetration)) altogether. What was not looked at by then raises
    /// the upper bound, to 1 as a rule, and is no guess. With a limit, answers depend on the speed of the
    /// machine.
    ///
    /// The clock is looked at before each leaf pair and each classifier, and while one is trained, so that the
    /// limit is exceeded by some milliseconds. Exception: the first query of a cloud that has more noise than
    /// spacing and is not [`refined`](crate::Cloud::refined) exceeds it once, by about 60 ms for each 40,000
    /// points. One patch can exceed it by seconds where it falls to Clarabel, which cannot be interrupted.
    pub deadline: Option<Duration>,
    /// What keeps a pair from reading as free beside the evidence.
    pub safeguards: Safeguards,
    /// How many contacts are reported at most.
    pub max_contacts: usize,
    /// How many triangles, before and after splitting, may be looked at for the samples of a mesh that
    /// the classifier is given at a place: those nearest to it, so that few are.
    pub max_mesh_parts: usize,
}

impl Default for QuerySettings {
    fn default() -> Self {
        Self {
            accept: 0.9,
            reject: 0.1,
            judge: Judge::default(),
            prior: 0.5,
            gamma: 3.0,
            penalty: 10.0,
            mesh_penalty_factor: 10.0,
            // κ = 0.84: an ellipsoid of one standard deviation.
            ellipsoid_radius: 1.0,
            relative_gap: 1e-3,
            stop_above: 0.999,
            detail: Detail::Full,
            deadline: None,
            safeguards: Safeguards::default(),
            max_contacts: 16,
            max_mesh_parts: 20_000,
        }
    }
}

impl QuerySettings {
    /// The probability beyond which no more is wanted, where the verdict alone is, or a part of it.
    pub(crate) fn decided_above(&self) -> Option<f64> {
        match self.detail {
            Detail::Free => Some(self.reject),
            Detail::Verdict => Some(self.accept),
            Detail::Probability | Detail::Full => None,
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.judge.validate()?;
        fraction("prior", self.prior)?;
        thresholds(self.accept, self.reject)?;
        self.safeguards.validate()?;
        self.classifier().validate()?;
        positive("ellipsoid_radius", self.ellipsoid_radius)?;
        positive("stop_above", self.stop_above)?;
        Ok(())
    }

    pub(crate) fn classifier(&self) -> ClassifierSettings {
        ClassifierSettings {
            kernel: Kernel::Gaussian { gamma: self.gamma },
            penalty: self.penalty,
            is_balanced: true,
            mesh_penalty_factor: self.mesh_penalty_factor,
            ellipsoid_radius: self.ellipsoid_radius,
            relative_gap: self.relative_gap,
            scale: None,
            distrusts_noise: true,
        }
    }
}
