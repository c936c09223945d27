//! Grows what is below a node: large halves each on a thread of their own, with the same result.

use cloudtouch_geom::{Matrix3, Point3};

use crate::build::by_area::cut_by_area;
use crate::build::fit::overlapping;
use crate::build::parts::{Memory, Part, fitted_halves, fitted_parts, halve, set_far_apart};
use crate::tree::node::{Link, NodeData};
use crate::{Moments, Obb, Primitives, Split, TreeSettings};

/// Halves of a node of fewer are not worth a thread of their own, ...
pub(crate) const LEAST_SHARED: usize = 2048;
/// ... and none is where the caller has to grow alone: whoever waits for others may be given work meanwhile
/// that waits for the caller.
pub(crate) const ALONE: usize = usize::MAX;
/// What is far is set apart so often at most. Each time one level is added, and where distances from the middle grow
/// a little faster than their squared ranks, each time sets apart a few of thousands.
const MOST_ROUNDS: u32 = 32;

/// What nodes are grown over, and how.
pub(crate) struct Growth<'a> {
    primitives: &'a Primitives,
    settings: &'a TreeSettings,
    /// Halves of fewer are grown by who grew the node.
    least_shared: usize,
    /// Whether all are points, which their centroids tell all of.
    are_points: bool,
}

/// A node with all that grew below it.
pub(crate) enum Grown {
    /// The node first, then the others in the order in which they were split; their names are their places.
    All(Vec<NodeData>),
    Halves(Box<(NodeData, [Grown; 2])>),
}

impl Grown {
    /// The node itself.
    pub(crate) fn top(&self) -> &NodeData {
        match self {
            Self::All(nodes) => &nodes[0],
            Self::Halves(halves) => &halves.0,
        }
    }
}

/// A node that is fitted, and the moments of what it holds.
type Fitted = (NodeData, Moments);

/// Where a node is parted.
struct Cut {
    middle: usize,
    /// How often what is far may be set apart from the first part: where that was done now the first part is as good
    /// as all.
    rounds: u32,
}

impl<'a> Growth<'a> {
    pub(crate) fn new(
        primitives: &'a Primitives,
        settings: &'a TreeSettings,
        indices: &[u32],
        least_shared: usize,
    ) -> Self {
        let are_points = indices.iter().all(|&index| primitives.is_point(index));
        let least_shared = if rayon::current_num_threads() == 1 { ALONE } else { least_shared };
        Self { primitives, settings, least_shared, are_points }
    }

    /// Splits a fitted node, and its halves, as often as the settings ask for, and brings its parts in the
    /// order of the leaves.
    pub(crate) fn grow(&self, top: Fitted, parts: &mut [Part], memory: &mut Memory) -> Grown {
        // Only all of them are asked for what is far, and what is left then: of a part its ends would be.
        let rounds = if top.0.parent == Link::NONE { MOST_ROUNDS } else { 0 };
        self.grow_any(top, parts, rounds, memory)
    }

    fn grow_any(
        &self,
        (top, moments): Fitted,
        parts: &mut [Part],
        rounds: u32,
        memory: &mut Memory,
    ) -> Grown {
        if parts.len() < self.least_shared {
            return self.grow_small((top, moments), parts, rounds, memory);
        }
        let cut = self.cut((&top, &moments), parts, rounds, memory);
        let Some(Cut { middle, rounds }) = cut else {
            return Grown::All(vec![top]);
        };
        let (low, high) = parts.split_at_mut(middle);
        let (of_low, of_high) = rayon::join(|| self.fitted(low), || self.fitted(high));
        let [first, second] = self.halves(&top, middle, [of_low, of_high]);
        let (first, second) = rayon::join(
            || self.grow_any(first, low, rounds, memory),
            || self.grow_any(second, high, 0, &mut Memory::default()),
        );
        Grown::Halves(Box::new((top, [first, second])))
    }

    /// The same on this thread.
    fn grow_small(
        &self,
        (top, moments): Fitted,
        parts: &mut [Part],
        rounds: u32,
        memory: &mut Memory,
    ) -> Grown {
        let start = top.start;
        // PERF: room for all, which to move would take longer than to fill.
        let mut nodes = Vec::with_capacity(self.settings.most_nodes(parts.len()));
        nodes.push(top.under(Link::NONE));
        let mut stack = vec![(0, moments, rounds)];
        while let Some((id, moments, rounds)) = stack.pop() {
            let node = &nodes[id];
            let begin = (node.start - start) as usize;
            let own = &mut parts[begin..begin + node.count as usize];
            let Some(Cut { middle, rounds }) = self.cut((node, &moments), own, rounds, memory)
            else {
                continue;
            };
            let (low, high) = own.split_at(middle);
            let fitted = fitted_halves([low, high], self.primitives, self.are_points);
            let [(low, of_low), (high, of_high)] = self.halves(node, middle, fitted);
            let first = nodes.len();
            nodes[id].set_children(Some([first as u32, first as u32 + 1]));
            nodes.extend([low, high].map(|half| half.under((id as u32).into())));
            stack.extend([(first, of_low, rounds), (first + 1, of_high, 0)]);
        }
        Grown::All(nodes)
    }

    /// Parts a node where the settings ask for that.
    fn cut(
        &self,
        (node, moments): (&NodeData, &Moments),
        parts: &mut [Part],
        rounds: u32,
        memory: &mut Memory,
    ) -> Option<Cut> {
        let axes = &node.obb.axes;
        if !self.settings.asks_to_split(parts.len(), moments.variation_by(axes)) {
            return None;
        }
        let (axis, mean) = (axes.column(0).into_owned(), &moments.mean);
        let far = if rounds > 0 { set_far_apart(parts, mean, memory) } else { None };
        let middle = far
            .or_else(|| self.cut_by_area(parts, axes, mean, memory))
            .unwrap_or_else(|| halve(parts, &axis, mean, memory));
        Some(Cut { middle, rounds: if far.is_some() { rounds - 1 } else { 0 } })
    }

    /// Where the settings ask for that and halves would be split again.
    fn cut_by_area(
        &self,
        parts: &mut [Part],
        axes: &Matrix3,
        mean: &Point3,
        memory: &mut Memory,
    ) -> Option<usize> {
        let TreeSettings { split, max_leaf_points, min_leaf_points, .. } = *self.settings;
        (split == Split::SurfaceArea && parts.len() > max_leaf_points.saturating_mul(2))
            .then(|| cut_by_area(parts, axes, mean, min_leaf_points, memory))
            .flatten()
    }

    fn fitted(&self, parts: &[Part]) -> (Moments, Obb) {
        fitted_parts(parts, self.primitives, self.are_points)
    }

    /// Leaves over both parts of a node.
    fn halves(&self, node: &NodeData, middle: usize, fitted: [(Moments, Obb); 2]) -> [Fitted; 2] {
        let [first, second] =
            overlapping(&node.obb.unpacked(), fitted, self.settings.sibling_overlap);
        let count = middle as u32;
        let leaf = |start, count, (moments, obb)| (NodeData::leaf(start, count, &obb), moments);
        [leaf(node.start, count, first), leaf(node.start + count, node.count - count, second)]
    }
}
