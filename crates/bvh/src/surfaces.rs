//! Which leaves of two trees have surfaces that may touch: pairs best first, and a bound on the rest.

use std::collections::BinaryHeap;

use cloudtouch_geom::{Drift, Motion, Pose};

use crate::apart::{Apart, Between, Carried, MovedBox};
use crate::node::{NodeData, pose_rounding};
use crate::queue::Queued;
use crate::{NodeId, Tree, TreeError};

/// Two leaves whose surfaces may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePair {
    /// Leaf of the first tree.
    pub a: NodeId,
    /// Leaf of the second tree.
    pub b: NodeId,
    /// The Mahalanobis distance between a point of the one and a point of the other is at least this,
    /// shifts and spreads as in [`Tree::set_leaf_bounds`]; 0 where boxes are not beyond the margin.
    pub deviations: f64,
    /// Whether surfaces are looked for that may cross, and these may: their boxes, grown by their reach
    /// too, overlap.
    pub may_cross: bool,
}

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

/// Whether to go on after a pair of leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceFlow {
    /// On to the next pair with fewer deviations than these, or whose surfaces may cross.
    Within(f64),
    /// No further pairs.
    Stop,
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

/// Visits the pairs of leaves, one of each tree, that may hold what is sought.
///
/// `a_from_b` maps the frame of `b` into that of `a`; it may change between calls, the trees need
/// not. Best first: overlapping pairs before disjoint ones, among the former the deepest overlap
/// relative to the smaller node (in metres the large nodes would all come before the first leaf),
/// among the latter the fewest deviations; ties by node name. Of a pair the larger node is descended.
///
/// Along a unit vector n across which two boxes are g apart and their points have standard deviations
/// up to σ and τ, no two of these have less than (g − m)/√(σ² + τ²) deviations between them, m the
/// margin: the bound is the largest over the normals of the faces. Gaps are reduced by the shifts of
/// both nodes, by the rounding of the pose, and by how far a drift takes the second box along n; its
/// turn raises the deviations and the reach of the second.
///
/// An empty tree has no pairs, and nothing was left out; it is for the caller to say what that means.
///
/// # Errors
/// When the pose or the margin is not finite, or the margin is negative.
pub fn visit_surfaces(
    (a, b): (&Tree, &Tree),
    a_from_b: &Pose,
    sought: Sought,
    mut visit: impl FnMut(SurfacePair) -> SurfaceFlow,
) -> Result<SurfaceOutcome, TreeError> {
    check(a_from_b, &sought)?;
    let mut within = sought.within;
    let mut outcome = SurfaceOutcome::NOTHING;
    let (Some(root_a), Some(root_b)) = (a.root, b.root) else { return Ok(outcome) };
    let mut pairs = Pairs::new((a, root_a), (b, root_b), a_from_b, sought, USUAL_PAIRS);
    pairs.test_roots(root_a, root_b, within, &mut outcome);
    while let Some(pair) = pairs.queue.pop() {
        let Waiting { deviations, surfaces, .. } = pair.item;
        if deviations >= within && !pairs.may_cross(&pair) {
            outcome.leave_out(deviations, surfaces);
            continue;
        }
        if pairs.test_narrower(&pair, within, &mut outcome) {
            continue;
        }
        outcome.leaf_pairs += 1;
        let may_cross = pairs.may_cross(&pair);
        let (a, b) = pair.nodes();
        match visit(SurfacePair { a: NodeId(a), b: NodeId(b), deviations, may_cross }) {
            SurfaceFlow::Within(limit) => within = within.min(limit),
            SurfaceFlow::Stop => {
                (outcome.deviations, outcome.apart) = (0.0, f64::NEG_INFINITY);
                outcome.stopped = true;
                break;
            }
        }
    }
    Ok(outcome)
}

/// By one test of two boxes, whether [`visit_surfaces`] would look into two trees: `None` where it would
/// leave out all of them, else how urgent that is, the less the sooner. Negative for boxes that overlap,
/// relative to the smaller one; else the deviations between them.
///
/// # Errors
/// As [`visit_surfaces`].
pub fn urgency_of_roots(
    (a, b): (&Tree, &Tree),
    a_from_b: &Pose,
    sought: Sought,
) -> Result<Option<f64>, TreeError> {
    check(a_from_b, &sought)?;
    let (Some(root_a), Some(root_b)) = (a.root, b.root) else { return Ok(None) };
    let mut pairs = Pairs::new((a, root_a), (b, root_b), a_from_b, sought, 1);
    let mut outcome = SurfaceOutcome::NOTHING;
    pairs.test_roots(root_a, root_b, sought.within, &mut outcome);
    Ok(pairs.queue.pop().map(|roots| roots.urgency()))
}

fn check(a_from_b: &Pose, sought: &Sought) -> Result<(), TreeError> {
    if let Some(value) = a_from_b.non_finite_entry() {
        return Err(TreeError::Pose { value });
    }
    if (0.0..f64::INFINITY).contains(&sought.margin) {
        return Ok(());
    }
    let expected = "a length in metres, at least 0";
    Err(TreeError::Setting { name: "margin", value: sought.margin, expected })
}

impl SurfaceOutcome {
    /// Nothing was looked at, and nothing left out.
    const NOTHING: Self = Self {
        nodes_visited: 0,
        leaf_pairs: 0,
        deviations: f64::INFINITY,
        apart: f64::INFINITY,
        stopped: false,
    };

    fn leave_out(&mut self, deviations: f64, surfaces: f64) {
        self.deviations = self.deviations.min(deviations);
        self.apart = self.apart.min(surfaces);
    }
}

/// Room for as many pairs as a search has waiting at once, as a rule.
const USUAL_PAIRS: usize = 256;

/// So many nodes of B are remembered.
const RECENT: usize = 256;

/// The pairs that wait, and what they are tested by.
struct Pairs<'a> {
    a: &'a Tree,
    b: &'a Tree,
    a_from_b: Motion,
    sought: Sought,
    /// How far the pose can misplace a box by rounding, m.
    rounding: f64,
    queue: BinaryHeap<Queued<Waiting>>,
    /// Boxes of B in the frame of A: pairs that share a node share its box.
    moved: Vec<MovedBox>,
    /// Of nodes that were moved lately, each at its name modulo [`RECENT`]: which they are and where their
    /// box is kept. Most nodes are met again, beside other nodes of A.
    recent: [(u32, u32); RECENT],
    /// What a drift does to each of them; empty where B keeps still.
    carried: Vec<Carried>,
}

impl<'a> Pairs<'a> {
    fn new(
        (a, root_a): (&'a Tree, u32),
        (b, root_b): (&'a Tree, u32),
        a_from_b: &Pose,
        sought: Sought,
        capacity: usize,
    ) -> Self {
        let roots = [&a.nodes[root_a as usize], &b.nodes[root_b as usize]];
        Self {
            a,
            b,
            a_from_b: Motion::from(a_from_b),
            sought,
            rounding: pose_rounding(roots, a_from_b),
            queue: BinaryHeap::with_capacity(capacity),
            moved: Vec::with_capacity(capacity),
            recent: [(u32::MAX, 0); RECENT],
            carried: Vec::new(),
        }
    }

    fn nodes(&self, (a, b): (u32, u32)) -> (&'a NodeData, &'a NodeData) {
        (&self.a.nodes[a as usize], &self.b.nodes[b as usize])
    }

    /// Moves the box of a node of B, and says where it is kept.
    fn moved(&mut self, b: u32) -> u32 {
        let recent = &mut self.recent[b as usize % RECENT];
        if recent.0 != b {
            *recent = (b, self.moved.len() as u32);
            let of_b = &self.b.nodes[b as usize];
            let moved = MovedBox::new(&of_b.obb, &self.a_from_b);
            self.carried.extend(self.sought.drift.map(|drift| Carried::new(of_b, &moved, &drift)));
            self.moved.push(moved);
        }
        recent.1
    }

    fn test_roots(&mut self, a: u32, b: u32, within: f64, outcome: &mut SurfaceOutcome) {
        let box_of_b = self.moved(b);
        self.test((a, b), box_of_b, within, outcome);
    }

    /// Tests a pair, and queues it where it is wanted.
    fn test(
        &mut self,
        (a, b): (u32, u32),
        box_of_b: u32,
        within: f64,
        outcome: &mut SurfaceOutcome,
    ) {
        outcome.nodes_visited += 1;
        let (of_a, of_b) = self.nodes((a, b));
        let moved = &self.moved[box_of_b as usize];
        let between = Between::new(of_a, (of_b, moved), self.rounding);
        let carried = self.carried.get(box_of_b as usize);
        // A pair that is left out by some of its faces, and is farther apart by these than others that were
        // left out, changes nothing by the rest.
        let enough = (within.max(outcome.deviations), outcome.apart.max(0.0));
        let Apart { deviations, points, surfaces } =
            between.by_faces(self.sought.margin, carried, enough);
        let may_cross = deviations >= within && self.overlap(&between, surfaces);
        if deviations >= within && !may_cross {
            return outcome.leave_out(deviations, surfaces);
        }
        let beyond = points - self.sought.margin;
        let urgency = if beyond < 0.0 {
            let [size_of_a, size_of_b] =
                [of_a, of_b].map(|node| node.obb.half_extents.norm_squared());
            // A box without size is overlapped as much as can be.
            (beyond / size_of_a.min(size_of_b).sqrt()).max(f64::MIN)
        } else {
            deviations
        };
        let waiting = Waiting { box_of_b, may_cross, deviations, surfaces };
        self.queue.push(Queued::new(urgency, (a, b), waiting));
    }

    /// Tests the pairs one step down, by splitting the larger node; whether there were any: not of two
    /// leaves.
    fn test_narrower(
        &mut self,
        pair: &Queued<Waiting>,
        within: f64,
        outcome: &mut SurfaceOutcome,
    ) -> bool {
        let (a, b) = pair.nodes();
        let (of_a, of_b) = self.nodes((a, b));
        let a_is_larger =
            || of_a.obb.half_extents.norm_squared() >= of_b.obb.half_extents.norm_squared();
        match (of_a.children, of_b.children) {
            (None, None) => return false,
            (Some(children), below_b) if below_b.is_none() || a_is_larger() => {
                for child in children {
                    self.test((child, b), pair.item.box_of_b, within, outcome);
                }
            }
            (_, below_b) => {
                for child in below_b.into_iter().flatten() {
                    let box_of_child = self.moved(child);
                    self.test((a, child), box_of_child, within, outcome);
                }
            }
        }
        true
    }

    /// Whether the boxes of the surfaces overlap: what the normals of their faces leave open, the
    /// directions across two edges decide.
    fn may_cross(&self, pair: &Queued<Waiting>) -> bool {
        let Waiting { box_of_b, may_cross, surfaces, .. } = pair.item;
        may_cross || {
            let (a, b) = self.nodes(pair.nodes());
            let moved = &self.moved[box_of_b as usize];
            surfaces < 0.0 && self.overlap(&Between::new(a, (b, moved), self.rounding), surfaces)
        }
    }

    /// The same, given what the normals say.
    fn overlap(&self, between: &Between<'_>, surfaces: f64) -> bool {
        // What a drift does across two edges is not known: not to tell is the safe side.
        let may_part = self.sought.drift.is_none();
        self.sought.crossings && surfaces < 0.0 && !(may_part && between.edges_part_surfaces())
    }
}

/// What is known of a pair that waits.
#[derive(Debug, Clone, Copy)]
struct Waiting {
    box_of_b: u32,
    /// Else it was not asked yet.
    may_cross: bool,
    /// As in [`Apart`].
    deviations: f64,
    surfaces: f64,
}
