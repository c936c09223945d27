//! The edges of a leaf, by the samples that they end at: a sample is an end of several.

use std::collections::BTreeMap;

use cloudtouch_geom::Vector3;

use super::edge::{Edge, EdgeEnd};
use super::slab::Slab;

/// Pieces of a leaf by their places in it, those from the last bit on together.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pieces(u64);

/// The edges of a leaf.
#[derive(Debug)]
pub(crate) struct LeafEdges {
    /// The points of the leaf in their order, then those of other leaves that edges lead to.
    ends: Vec<EdgeEnd>,
    /// How many of the ends are of the leaf.
    own: usize,
    /// Which ends each edge has.
    joints: Vec<Joint>,
    /// Around them.
    pub slab: Slab,
}

/// An edge of a leaf by the places of its ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Joint([u32; 2]);

/// Edges of a leaf that are being found.
#[derive(Debug)]
pub(super) struct Growing {
    ends: Vec<EdgeEnd>,
    own: usize,
    /// The place of each end that is of another leaf, by its piece.
    others: BTreeMap<u32, u32>,
    joints: Vec<Joint>,
}

impl Growing {
    /// None yet, of a leaf with these points.
    pub(super) fn at(ends: Vec<EdgeEnd>) -> Self {
        Self { own: ends.len(), ends, others: BTreeMap::new(), joints: Vec::new() }
    }

    /// Adds an edge from a point of the leaf to another one.
    pub(super) fn join(&mut self, from: u32, to: u32) {
        self.joints.push(Joint([from, to]));
    }

    /// Adds an edge from a point of the leaf to one of another leaf.
    pub(super) fn join_other(&mut self, from: u32, to: EdgeEnd) {
        let place = *self.others.entry(to.piece).or_insert_with(|| {
            self.ends.push(to);
            self.ends.len() as u32 - 1
        });
        self.join(from, place);
    }

    /// All of them, of a leaf that is thin along a unit vector.
    pub(super) fn grown(self, thin: Vector3) -> LeafEdges {
        let Self { mut ends, own, mut joints, .. } = self;
        // What they grew by would be a good part of what a refined cloud holds.
        ends.shrink_to_fit();
        joints.shrink_to_fit();
        let mut edges = LeafEdges { ends, own, joints, slab: Slab::empty(thin) };
        edges.enclose(thin);
        edges
    }
}

impl LeafEdges {
    /// Encloses them along a unit vector.
    pub(super) fn enclose(&mut self, thin: Vector3) {
        let mut slab = Slab::empty(thin);
        for &Joint(ends) in &self.joints {
            ends.into_iter().for_each(|end| slab.include(&self.end(end).place, 0.0));
        }
        self.slab = slab;
    }

    pub(crate) fn joints(&self) -> &[Joint] {
        &self.joints
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = Edge> {
        self.joints.iter().map(|&joint| self.edge(joint))
    }

    pub(crate) fn edge(&self, Joint(ends): Joint) -> Edge {
        let own = |end: u32| Some(end as usize).filter(|&place| place < self.own);
        Edge::between(ends.map(|end| self.end(end)), ends.map(own))
    }

    /// The ends of an edge.
    pub(crate) fn ends_of(&self, Joint(ends): Joint) -> [&EdgeEnd; 2] {
        ends.map(|end| self.end(end))
    }

    /// The points of the leaf that an edge joins.
    pub(crate) fn pieces_of(&self, Joint(ends): Joint) -> Pieces {
        let mut pieces = Pieces::default();
        let own = ends.into_iter().map(|end| end as usize).filter(|&place| place < self.own);
        own.for_each(|place| pieces.insert(place));
        pieces
    }

    /// The samples that they end at, each with its place in the leaf if it is one of these.
    pub(crate) fn ends(&self) -> impl ExactSizeIterator<Item = (Option<usize>, &EdgeEnd)> {
        let own = |place: usize| Some(place).filter(|&place| place < self.own);
        self.ends.iter().enumerate().map(move |(place, end)| (own(place), end))
    }

    /// Gives the pieces other numbers.
    pub(in crate::cloud) fn renumber(&mut self, after: &[u32]) {
        self.ends.iter_mut().for_each(|end| end.piece = after[end.piece as usize]);
    }

    fn end(&self, end: u32) -> &EdgeEnd {
        &self.ends[end as usize]
    }
}

impl Joint {
    /// The places of its ends among all.
    pub(crate) fn places(self) -> [usize; 2] {
        self.0.map(|end| end as usize)
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

    pub(crate) fn has(self, place: usize) -> bool {
        self.0 >> place.min(u64::BITS as usize - 1) & 1 == 1
    }

    /// Whether one of them may be among others.
    pub(crate) fn meet(self, others: Self) -> bool {
        self.0 & others.0 != 0
    }

    pub(crate) fn is_none(self) -> bool {
        self.0 == 0
    }
}
