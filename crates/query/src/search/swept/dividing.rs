//! Directions along which leaves were told apart: beside one surface the same do it for most pairs.

use cloudtouch_geom::Vector3;

use super::course::Course;
use super::leaf::{SweptEdges, SweptMesh};
use super::track::{Direction, SweptFacet};
use crate::cloud::Surfel;

/// So many are tried again.
const MOST_KNOWN: usize = 2;

/// The unit vectors that told leaves apart last, in the frame of A, the latest first.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Dividing([Option<Vector3>; MOST_KNOWN]);

impl Dividing {
    pub(super) fn known(self) -> impl Iterator<Item = Vector3> {
        self.0.into_iter().flatten()
    }

    /// The discs of a leaf that some of these edges, which drift so, may get to, as far as `thin` and
    /// what is known tell.
    pub(super) fn discs_met<'d>(
        &mut self,
        discs: &'d [Surfel],
        edges: &SweptEdges,
        thin: [Vector3; 2],
        drift: &Course,
    ) -> Vec<&'d Surfel> {
        let Some(hull) = &edges.hull else { return Vec::new() };
        let mut met: Vec<&Surfel> = discs.iter().collect();
        // The box about all edges tells of most, and takes little.
        let by_box = |n: &Vector3| hull.heights_on_the_way(n);
        let by_each = |n: &Vector3| edges.heights_on_the_way(&Direction::new(*n, drift));
        let is_met = |disc: &&Surfel, n: &Vector3, [low, high]: [f64; 2]| {
            let height = n.dot(&disc.point.mean.coords);
            let holds = |reach: f64| low - reach <= height && height <= high + reach;
            disc.disc_reach(n).is_some_and(holds)
        };
        self.keep(&mut met, &thin, by_box, is_met);
        self.keep(&mut met, &thin, by_each, is_met);
        met
    }

    /// The facets of a leaf, which drift so, that may get to some of these edges, as far as `thin` and
    /// what is known tell.
    pub(super) fn facets_met<'f>(
        &mut self,
        facets: &'f SweptMesh,
        edges: &SweptEdges,
        thin: Vector3,
        drift: &Course,
    ) -> Vec<SweptFacet<'f>> {
        let Some(hull) = &edges.hull else { return Vec::new() };
        let mut met: Vec<SweptFacet<'_>> = facets.facets().collect();
        let is_met = |facet: &SweptFacet<'_>, n: &Vector3, heights: [f64; 2]| {
            facet.gets_between(heights, &Direction::new(*n, drift))
        };
        self.keep(&mut met, &[thin], |n| hull.heights(n), is_met);
        let of_one = met.first().and_then(|one| one.facet.normal);
        met.retain(|facet| hull.meets_plane_of(facet));
        if let (true, Some(normal)) = (met.is_empty(), of_one) {
            self.remember(normal);
        }
        self.keep(&mut met, &[thin], |n| edges.heights(n), is_met);
        met
    }

    /// Keeps what is met along every direction, given the heights between which edges are along it.
    fn keep<T>(
        &mut self,
        met: &mut Vec<T>,
        thin: &[Vector3],
        heights: impl Fn(&Vector3) -> [f64; 2],
        is_met: impl Fn(&T, &Vector3, [f64; 2]) -> bool,
    ) {
        for n in self.known().chain(thin.iter().copied()) {
            if met.is_empty() {
                return;
            }
            let heights = heights(&n);
            met.retain(|one| is_met(one, &n, heights));
            if met.is_empty() {
                self.remember(n);
            }
        }
    }

    fn remember(&mut self, n: Vector3) {
        let mut latest = std::iter::once(n).chain(self.known().filter(|known| *known != n));
        self.0 = std::array::from_fn(|_| latest.next());
    }
}
