//! Pairs of nodes that wait in a search among surfaces, and what they are tested by.

use std::collections::BinaryHeap;

use cloudtouch_geom::{Motion, Pose};

use crate::Tree;
use crate::queue::Queued;
use crate::surfaces::across_edges::edges_part_surfaces;
use crate::surfaces::apart::{Apart, Asked, by_faces};
use crate::surfaces::carried::Carried;
use crate::surfaces::placed::{MovedBox, Placed};
use crate::surfaces::settled::Settled;
use crate::surfaces::sought::{Sought, SurfaceOutcome};
use crate::tree::node::{NodeData, pose_rounding};

/// Room for as many pairs as a search has waiting at once, as a rule.
pub(crate) const USUAL_PAIRS: usize = 256;

/// A search moves so many boxes of B for each pair that waits at once, as a rule.
const BOXES_OF_PAIR: usize = 4;

/// So many nodes of B are remembered.
const RECENT: usize = 1024;

/// The pairs that wait, and what they are tested by.
pub(crate) struct Pairs<'a> {
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
    /// By the names of nodes of A and of B, which are settled; empty before one is.
    settled: [Vec<bool>; 2],
}

impl<'a> Pairs<'a> {
    pub(crate) fn new(
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
            moved: Vec::with_capacity(BOXES_OF_PAIR * capacity),
            recent: [(u32::MAX, 0); RECENT],
            carried: Vec::new(),
            settled: [Vec::new(), Vec::new()],
        }
    }

    /// Leaves out what is to come of a leaf of a pair.
    pub(crate) fn settle(&mut self, (a, b): (u32, u32), which: Settled) {
        let Self { a: of_a, b: of_b, settled: [in_a, in_b], .. } = self;
        let (tree, node, settled) = match which {
            Settled::A => (of_a, a, in_a),
            Settled::B => (of_b, b, in_b),
        };
        settled.resize(tree.nodes.len(), false);
        settled[node as usize] = true;
    }

    pub(crate) fn is_settled(&self, (a, b): (u32, u32)) -> bool {
        let is_in = |settled: &[bool], node: u32| settled.get(node as usize).is_some_and(|&is| is);
        let [in_a, in_b] = &self.settled;
        is_in(in_a, a) || is_in(in_b, b)
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
            let moved = MovedBox::new(&of_b.obb.unpacked(), &self.a_from_b);
            self.carried.extend(self.sought.drift.map(|drift| Carried::new(of_b, &moved, &drift)));
            self.moved.push(moved);
        }
        recent.1
    }

    /// Tests all that waits anew, by trees of the same nodes.
    pub(crate) fn go_on_by(
        &mut self,
        [a, b]: [&'a Tree; 2],
        a_from_b: &Pose,
        within: f64,
        outcome: &mut SurfaceOutcome,
    ) {
        let mut waiting = std::mem::take(&mut self.queue).into_vec();
        // Those of a node of B together, so that it is moved once.
        waiting.sort_unstable_by_key(|pair| (pair.nodes().1, pair.nodes().0));
        let nodes = [(a, a.root), (b, b.root)];
        let [Some(root_a), Some(root_b)] =
            nodes.map(|(tree, root)| Some(&tree.nodes[root? as usize]))
        else {
            return;
        };
        self.rounding = self.rounding.max(pose_rounding([root_a, root_b], a_from_b));
        (self.a, self.b) = (a, b);
        self.moved.clear();
        self.carried.clear();
        self.recent = [(u32::MAX, 0); RECENT];
        for pair in waiting {
            let (a, b) = pair.nodes();
            self.test(a, b, within, outcome);
        }
    }

    /// The pair that comes next.
    pub(crate) fn most_urgent(&self) -> Option<Queued<Waiting>> {
        self.queue.peek().copied()
    }

    pub(crate) fn drop_most_urgent(&mut self) {
        self.queue.pop();
    }

    /// Queues a pair, such as that of the roots, where it is wanted.
    pub(crate) fn test(&mut self, a: u32, b: u32, within: f64, outcome: &mut SurfaceOutcome) {
        let pair = Tested { nodes: (a, b), box_of_b: self.moved(b) };
        let [apart, _] = self.by_faces([pair; 2], within, outcome);
        let wanted = self.wanted(pair, apart, within, outcome);
        self.queue.extend(wanted);
    }

    /// Queues the two pairs that the most urgent one was split into in its place, where they are wanted.
    pub(crate) fn test_instead(
        &mut self,
        halves: [Tested; 2],
        within: f64,
        outcome: &mut SurfaceOutcome,
    ) {
        let [first, second] = self.by_faces(halves, within, outcome);
        let first = self.wanted(halves[0], first, within, outcome);
        let second = self.wanted(halves[1], second, within, outcome);
        match (first, second) {
            (None, None) => self.drop_most_urgent(),
            (Some(only), None) | (None, Some(only)) => self.replace_most_urgent(only),
            (Some(first), Some(second)) => {
                self.replace_most_urgent(first);
                self.queue.push(second);
            }
        }
    }

    // PERF: half of a pair is about as urgent, and stays near the top of the heap.
    fn replace_most_urgent(&mut self, pair: Queued<Waiting>) {
        if let Some(mut top) = self.queue.peek_mut() {
            *top = pair;
        }
    }

    #[inline(always)]
    fn by_faces(
        &self,
        [one, other]: [Tested; 2],
        within: f64,
        outcome: &SurfaceOutcome,
    ) -> [Apart; 2] {
        let boxes = [one.box_of_b as usize, other.box_of_b as usize];
        let (a, b) = (self.nodes(one.nodes), self.nodes(other.nodes));
        let carried = self.carried.get(boxes[0]).zip(self.carried.get(boxes[1]));
        let asked = Asked {
            margin: self.sought.margin,
            rounding: self.rounding,
            // A pair that is left out by some of its faces, and is farther apart by these than others that were
            // left out, changes nothing by the rest.
            enough: (within.max(outcome.deviations), outcome.apart.max(0.0)),
        };
        by_faces(
            [a.0, b.0],
            [Placed::moved(a.1, &self.moved[boxes[0]]), Placed::moved(b.1, &self.moved[boxes[1]])],
            carried.map(|(one, other)| [one, other]),
            asked,
        )
    }

    /// A pair as it waits; `None` where it is left out.
    #[inline(always)]
    fn wanted(
        &self,
        Tested { nodes, box_of_b }: Tested,
        Apart { deviations, points, surfaces }: Apart,
        within: f64,
        outcome: &mut SurfaceOutcome,
    ) -> Option<Queued<Waiting>> {
        outcome.nodes_visited += 1;
        let (of_a, of_b) = self.nodes(nodes);
        let may_cross = deviations >= within && self.overlap(nodes, box_of_b, surfaces);
        if deviations >= within && !may_cross {
            outcome.leave_out(deviations, surfaces);
            return None;
        }
        let beyond = points - self.sought.margin;
        let urgency = if beyond < 0.0 {
            let [size_of_a, size_of_b] = [of_a, of_b].map(|node| node.obb.squared_radius());
            // A box without size is overlapped as much as can be.
            (beyond / f64::from(size_of_a.min(size_of_b).sqrt())).max(f64::MIN)
        } else {
            deviations
        };
        let waiting = Waiting { box_of_b, may_cross, deviations, surfaces };
        Some(Queued::new(urgency, nodes, waiting))
    }

    /// The pairs one step down, by splitting the larger node; none of two leaves.
    #[inline(always)]
    pub(crate) fn narrower(&mut self, pair: &Queued<Waiting>) -> Option<[Tested; 2]> {
        let (a, b) = pair.nodes();
        let (of_a, of_b) = self.nodes((a, b));
        let a_is_larger = || of_a.obb.squared_radius() >= of_b.obb.squared_radius();
        match (of_a.children(), of_b.children()) {
            (Some(children), below_b) if below_b.is_none() || a_is_larger() => {
                let box_of_b = pair.item.box_of_b;
                Some(children.map(|child| Tested { nodes: (child, b), box_of_b }))
            }
            (_, below_b) => below_b.map(|children| {
                children.map(|child| Tested { nodes: (a, child), box_of_b: self.moved(child) })
            }),
        }
    }

    /// Whether the boxes of the surfaces overlap: what the normals of their faces leave open, the
    /// directions across two edges decide.
    #[inline(always)]
    pub(crate) fn may_cross(&self, pair: &Queued<Waiting>) -> bool {
        let Waiting { box_of_b, may_cross, surfaces, .. } = pair.item;
        may_cross || self.overlap(pair.nodes(), box_of_b, surfaces)
    }

    /// The same, given what the normals say.
    fn overlap(&self, nodes: (u32, u32), box_of_b: u32, surfaces: f64) -> bool {
        if !self.sought.crossings || surfaces >= 0.0 {
            return false;
        }
        let (a, b) = self.nodes(nodes);
        let b = Placed::moved(b, &self.moved[box_of_b as usize]);
        // What a drift does across two edges is not known: not to tell is the safe side.
        self.sought.drift.is_some() || !edges_part_surfaces(a, b, self.rounding)
    }
}

/// A pair to be tested, and where the box of B is kept.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tested {
    nodes: (u32, u32),
    box_of_b: u32,
}

/// What is known of a pair that waits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Waiting {
    box_of_b: u32,
    /// Else it was not asked yet.
    may_cross: bool,
    /// As in [`Apart`].
    pub(crate) deviations: f64,
    pub(crate) surfaces: f64,
}
