//! The surface at the points of a leaf, and what encloses it: told once for all poses.

use cloudtouch_geom::Vector3;

use super::ball::Ball;
use super::edge::Edge;
use super::slab::Slab;
use super::surfel::Surfel;

/// The pieces of surface of a leaf, in the order of its points.
#[derive(Debug)]
pub(crate) struct LeafSurface {
    pub surfels: Vec<Surfel>,
    /// Around them.
    pub ball: Ball,
    /// Around their discs.
    pub slab: Slab,
}

/// Pieces of a leaf by their places in it, those from the last bit on together.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pieces(u64);

/// The edges of a leaf.
#[derive(Debug)]
pub(crate) struct LeafEdges {
    pub edges: Vec<Edge>,
    /// Which pieces of the leaf each of them joins.
    pub joined: Vec<Pieces>,
    /// Around them.
    pub slab: Slab,
}

impl LeafSurface {
    /// Of a leaf that is thin along a unit vector.
    pub(in crate::cloud) fn new(surfels: Vec<Surfel>, thin: Vector3) -> Self {
        let (ball, slab) = (Ball::around(&surfels), Slab::around_discs(&surfels, thin));
        Self { surfels, ball, slab }
    }
}

impl LeafEdges {
    /// Of a leaf that is thin along a unit vector.
    pub(super) fn new(mut edges: Vec<Edge>, thin: Vector3) -> Self {
        // What they grew by would be a seventh of what a refined cloud holds.
        edges.shrink_to_fit();
        let slab = Slab::around_edges(&edges, thin);
        let joined = edges.iter().map(|edge| edge.own_places().collect()).collect();
        Self { edges, joined, slab }
    }
}

impl FromIterator<usize> for Pieces {
    fn from_iter<I: IntoIterator<Item = usize>>(places: I) -> Self {
        let mut pieces = Self::default();
        places.into_iter().for_each(|place| pieces.insert(place));
        pieces
    }
}

impl Pieces {
    pub(crate) fn insert(&mut self, place: usize) {
        self.0 |= 1 << place.min(u64::BITS as usize - 1);
    }

    /// Whether one of them may be among others.
    pub(crate) fn meet(self, others: Self) -> bool {
        self.0 & others.0 != 0
    }

    pub(crate) fn is_none(self) -> bool {
        self.0 == 0
    }
}
