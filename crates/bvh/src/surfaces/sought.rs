//! What is looked for among surfaces, and what was found of the rest.

use cloudtouch_geom::Drift;

/// What is looked for between two trees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sought {
    /// Points with fewer deviations between them than these.
    pub within: f64,
    /// How far apart points may be and still count as at one place, m: deviations are of what is
    /// beyond it.
    pub margin: f64,
    /// Whether surfaces that may cross are looked for too.
    pub crossings: bool,
    /// How the second tree moves about its pose, in the frame of the first: what is sought is sought
    /// anywhere on the way. `None` where it keeps still.
    pub drift: Option<Drift>,
}

/// What a search among surfaces did, and what the part it left out could hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceOutcome {
    /// Node pairs whose boxes were tested.
    pub nodes_visited: usize,
    /// Pairs of leaves handed to the caller.
    pub leaf_pairs: usize,
    /// The points of pairs that were left out have at least so many deviations between them: infinite
    /// when none was left out, 0 when the caller stopped.
    pub deviations: f64,
    /// Their surfaces are at least so far apart, m: infinite when none was left out, minus infinity
    /// when the caller stopped.
    pub apart: f64,
    /// Whether the caller stopped it.
    pub stopped: bool,
}

impl SurfaceOutcome {
    /// Nothing was looked at, and nothing left out.
    pub(crate) const NOTHING: Self = Self {
        nodes_visited: 0,
        leaf_pairs: 0,
        deviations: f64::INFINITY,
        apart: f64::INFINITY,
        stopped: false,
    };

    pub(crate) fn leave_out(&mut self, deviations: f64, surfaces: f64) {
        self.deviations = self.deviations.min(deviations);
        self.apart = self.apart.min(surfaces);
    }
}
