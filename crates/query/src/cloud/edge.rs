//! Edges between neighbouring samples: they stand for the surface between them.

use std::collections::BTreeMap;

use cloudtouch_geom::{Motion, Point3};
use cloudtouch_noise::Scratch;

use super::{Cloud, Surfel};

/// Neighbours of a point that may be joined to it.
const NEIGHBORS: usize = 8;
/// Edges join samples up to this many of the smaller of their spacings apart.
pub(crate) const EDGE_SPACINGS: f64 = 2.2;
/// The disc about a sample stands for the surface up to so many spacings from it; no edge reaches
/// farther from its own end to its middle.
pub(crate) const DISC_SPACINGS: f64 = 1.1;
/// Edges run along the surface: the sine of their angle to it is at most this.
pub(crate) const SLOPE: f64 = 0.5;

/// A straight piece of surface between two neighbours of one cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Edge {
    /// Where it starts and ends.
    pub ends: [Point3; 2],
    /// Half its length, m.
    pub half_length: f64,
    /// Variances of the ends across the surface, m².
    pub across: [f64; 2],
    /// Which points of the leaf it joins, by their place in it; `None` for a point of another leaf.
    pub own: [Option<usize>; 2],
}

impl Edge {
    /// The same edge in another frame.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        Self { ends: self.ends.map(|end| motion.point(&end)), ..*self }
    }
}

/// The edges at the points of a leaf: to each other once, and to points of other leaves, each of
/// which has the same edge.
///
/// Only points that are among each other's nearest are joined, so that both leaves agree.
pub(crate) fn edges_of(cloud: &Cloud, indices: &[u32]) -> Vec<Edge> {
    let places: BTreeMap<u32, usize> = indices.iter().copied().zip(0..).collect();
    let mut scratch = Scratch::default();
    let mut nearest = Nearest { cloud, known: BTreeMap::new() };
    let mut edges = Vec::new();
    for (&p, &place) in &places {
        for q in nearest.of(p) {
            let other = places.get(&q).copied();
            let is_second = other.is_some() && q < p;
            if q == p || is_second || !nearest.of(q).contains(&p) {
                continue;
            }
            let from = *cloud.surfel(p, &mut scratch);
            let to = *cloud.surfel(q, &mut scratch);
            if runs_along(&from, &to) {
                edges.push(Edge {
                    ends: [from.point.mean, to.point.mean],
                    half_length: 0.5 * (to.point.mean - from.point.mean).norm(),
                    across: [from.variance_across(), to.variance_across()],
                    own: [Some(place), other],
                });
            }
        }
    }
    edges
}

/// The points nearest to points of a leaf; most are asked for several times.
struct Nearest<'a> {
    cloud: &'a Cloud,
    known: BTreeMap<u32, [u32; NEIGHBORS]>,
}

impl Nearest<'_> {
    /// With fewer neighbours the point itself fills the rest, to which no edge leads.
    fn of(&mut self, index: u32) -> [u32; NEIGHBORS] {
        *self.known.entry(index).or_insert_with(|| {
            let mut nearest = [index; NEIGHBORS];
            let found = self.cloud.neighborhoods.nearest(index as usize, NEIGHBORS);
            for (slot, neighbor) in nearest.iter_mut().zip(found) {
                *slot = neighbor.index as u32;
            }
            nearest
        })
    }
}

fn runs_along(p: &Surfel, q: &Surfel) -> bool {
    let step = q.point.mean - p.point.mean;
    let length = step.norm();
    let along = |s: &Surfel| s.normal.is_some_and(|n| step.dot(&n).abs() <= SLOPE * length);
    length <= EDGE_SPACINGS * p.spacing.min(q.spacing) && along(p) && along(q)
}
