//! Room for the surface of a cloud, which is computed piece by piece and kept.

use std::sync::OnceLock;

use cloudtouch_bvh::{Node, Tree};
use cloudtouch_geom::Covariance;

use super::edges::LeafEdges;
use super::leaf::LeafSurface;
use super::room::Room;
use super::surfel::{End, Surfel};

/// Neighbours of a point that may be joined to it.
pub(super) const NEIGHBORS: usize = 8;
/// Neighbours of a piece that tell where it ends.
pub(super) const BESIDE: usize = 16;
/// Points that a spacing is told from, at most.
const REGION_POINTS: usize = 40;
/// A point may be given so many steps of a grid of as many points, half more than its spacing where these are 40, ...
const GRID_STEPS: f64 = 1.26;
/// ... or of a line.
const LINE_STEPS: f64 = 4.5;
/// Points of a region that are counted at least.
const LEAST_COUNTED: f64 = 12.0;

/// The surface at a piece as it is fitted, and what it rests on.
#[derive(Debug, Clone)]
pub(in crate::cloud) struct Fitted {
    pub surfel: Surfel,
    pub basis: Basis,
}

/// What the surface at a piece rests on.
#[derive(Debug, Clone)]
pub(in crate::cloud) struct Basis {
    /// Points farther away had no part in it, m.
    pub reach: f64,
    /// The pieces nearest to it, where the fit told.
    pub nearest: Option<[u32; NEIGHBORS]>,
    /// The same and more, where some of them are off its plane: there it may end at the face that they are of.
    pub beside: Option<Box<Beside>>,
}

/// The pieces about one.
#[derive(Debug, Clone)]
pub(in crate::cloud) struct Beside {
    /// With fewer of them the piece itself fills the rest.
    pub pieces: [u32; BESIDE],
    /// What is left of it where it ends, m²; none inside where it ends nowhere.
    pub left: OnceLock<Option<Box<Covariance>>>,
}

impl Beside {
    pub(in crate::cloud) fn new(pieces: [u32; BESIDE]) -> Box<Self> {
        Box::new(Self { pieces, left: OnceLock::new() })
    }
}

impl Basis {
    /// Of a piece that nothing is known of.
    pub(in crate::cloud) const UNKNOWN: Self =
        Self { reach: f64::INFINITY, nearest: None, beside: None };

    /// Whether the piece may end.
    pub(in crate::cloud) fn end(&self) -> End {
        if self.beside.is_some() { End::Open } else { End::Nowhere }
    }

    /// The same but for what is left of the piece where it ends, of which its leaf has a copy.
    pub(super) fn without_left(mut self) -> Self {
        if let Some(beside) = &mut self.beside {
            beside.left.take();
        }
        self
    }

    /// The same where pieces have other numbers, and those about this one may have other fits.
    pub(in crate::cloud) fn renumbered(&self, after: &[u32]) -> Self {
        let now = |index: &u32| after[*index as usize];
        Self {
            reach: self.reach,
            nearest: self.nearest.map(|nearest| nearest.map(|index| now(&index))),
            beside: self.beside.as_ref().map(|all| Beside::new(all.pieces.each_ref().map(now))),
        }
    }
}

/// One slot per piece, and per tree node, of which only those of leaves are ever filled. Each is a
/// pure function of the cloud, so it does not matter which thread fills it.
#[derive(Debug)]
pub(in crate::cloud) struct LazySurface {
    /// None once all leaves hold what is told of theirs.
    pub fits: Room<Box<Fitted>>,
    /// Of each what it rests on, once all leaves hold theirs.
    pub bases: Vec<Basis>,
    pub leaves: Room<Box<LeafSurface>>,
    /// Of leaves with what they share, for those who ask for that.
    pub shared: OnceLock<Room<Vec<Surfel>>>,
    pub edges: Room<Box<LeafEdges>>,
    /// What the spacing of each piece is limited to, m.
    pub spacing_caps: Vec<f32>,
    /// The tree fitted to all of it, made when a query first comes by most of it; `None` where it cannot
    /// be.
    pub fitted: OnceLock<Option<Box<Tree>>>,
}

impl LazySurface {
    /// For a tree with pieces of these limits.
    pub(in crate::cloud) fn new(tree: &Tree, spacing_caps: Vec<f32>) -> Self {
        Self {
            fits: Room::new(spacing_caps.len()),
            bases: Vec::new(),
            leaves: Room::new(tree.node_slots()),
            shared: OnceLock::new(),
            edges: Room::new(tree.node_slots()),
            spacing_caps,
            fitted: OnceLock::new(),
        }
    }

    /// Of no pieces.
    pub(in crate::cloud) fn empty() -> Self {
        Self {
            fits: Room::default(),
            bases: Vec::new(),
            leaves: Room::default(),
            shared: OnceLock::new(),
            edges: Room::default(),
            spacing_caps: Vec::new(),
            fitted: OnceLock::new(),
        }
    }

    /// What the surface at a piece rests on, where it was computed.
    pub(in crate::cloud) fn basis(&self, piece: u32) -> Option<&Basis> {
        match self.fits.is_empty() {
            false => self.fits.get(piece as usize).map(|fitted| &fitted.basis),
            true => self.bases.get(piece as usize),
        }
    }

    /// What the spacing of each point of a leaf is limited to, m.
    pub(in crate::cloud) fn spacing_cap(&self, leaf: Node<'_>) -> f64 {
        leaf.primitive_indices().first().map_or(0.0, |&piece| self.cap(piece))
    }

    /// What the spacing of a piece is limited to, m.
    pub(in crate::cloud) fn cap(&self, piece: u32) -> f64 {
        self.spacing_caps[piece as usize].into()
    }

    /// How many pieces there are.
    pub(in crate::cloud) fn piece_count(&self) -> usize {
        self.spacing_caps.len()
    }
}

/// The spacing a point of a leaf may be given at most, on which the tree's bounds rest: somewhat more than that of as
/// many points on a grid from end to end of the two longest sides of the region's box, or on a line. No more than an
/// estimate, it is kept in single precision.
pub(in crate::cloud) fn spacing_cap(tree: &Tree, leaf: Node<'_>) -> f32 {
    let around = region(tree, leaf);
    let mut sides: [f64; 3] = (2.0 * around.obb().half_extents).into();
    sides.sort_by(f64::total_cmp);
    let [_, middle, longest] = sides;
    let count = around.primitive_indices().len().max(1) as f64;
    // From end to end there is a step less than points. Of fewer, chance tells more than how many there are.
    let steps = count.max(LEAST_COUNTED).sqrt() - 1.0;
    // On a line the sixth neighbour, which the spacing is measured by, is three steps away.
    (GRID_STEPS * (longest * middle).sqrt() / steps).max(LINE_STEPS * longest / count) as f32
}

/// The largest node around a leaf with few enough points to tell their spacing there.
fn region<'a>(tree: &'a Tree, leaf: Node<'a>) -> Node<'a> {
    let parent = |node: &Node<'a>| node.parent().and_then(|id| tree.node(id));
    let is_small = |node: &Node<'a>| node.primitive_indices().len() <= REGION_POINTS;
    let around = std::iter::successors(Some(leaf), parent).take_while(is_small).last();
    around.unwrap_or(leaf)
}
