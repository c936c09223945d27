//! Where the surface goes on past the end of an edge.

use cloudtouch_geom::{Motion, Point3, Vector3};
use cloudtouch_noise::Scratch;

use super::edge::Edge;
use super::join::runs_along;
use crate::cloud::prepared::Prepared;

/// A neighbour counts in part from this cosine of its direction to that of the edge on, in full straight
/// ahead.
const AHEAD: f64 = 0.3;
/// What the end itself counts beside its neighbours, so that a place with hardly any ahead is near it.
const OF_END: f64 = 0.1;

/// A place one neighbour farther along the surface than the end of an edge.
///
/// Where noise is as large as the spacing, an end is never clearly on either side of what it passes; what
/// lies past it may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Onward {
    pub place: Point3,
    /// Variance across the surface there, m².
    pub across: f64,
}

impl Onward {
    /// The same in another frame.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        Self { place: motion.point(&self.place), ..*self }
    }
}

impl Prepared {
    /// Past the first end of an edge, or the second: the mean of the neighbours of the end that lie ahead, by
    /// how straight ahead they are, so that no choice among near-ties decides.
    pub(crate) fn onward(&self, edge: &Edge, end: usize) -> Onward {
        let mut scratch = Scratch::default();
        let (piece, behind) = (edge.points[end], edge.points[1 - end]);
        let at = *self.fit(piece, &mut scratch);
        let along = at.point.mean - self.fit(behind, &mut scratch).point.mean;
        let along = along.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let (mut sum, mut step) = (OF_END, Vector3::zeros());
        let mut across = OF_END * at.across;
        for neighbor in self.nearest(piece, &mut scratch) {
            let next = *self.fit(neighbor, &mut scratch);
            let way = next.point.mean - at.point.mean;
            let ahead = way.dot(&along) - AHEAD * way.norm();
            if ahead > 0.0 && runs_along(&at, &next) {
                let weight = (ahead / ((1.0 - AHEAD) * way.norm())).powi(2);
                sum += weight;
                step += way * weight;
                across += weight * next.across;
            }
        }
        Onward { place: at.point.mean + step / sum, across: across / sum }
    }
}
