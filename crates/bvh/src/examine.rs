//! The test of one pair of nodes: gap, bound, urgency, and whether to descend.

use cloudtouch_geom::{Pose, Vector3, seed};

use crate::leakage::{Side, gap_aware_probability, paper_probability, plane_bound};
use crate::node::NodeData;
use crate::{LeafPair, NodeId, Obb, Traversal, TraversalSettings, Tree, signed_gap};

/// What is known of a pair of nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Examined {
    /// Not necessarily of leaves.
    pub(crate) pair: LeafPair,
    /// Small is urgent: negative for an overlap, relative to the smaller node, else the gap, m.
    pub(crate) urgency: f64,
    pub(crate) descend: bool,
}

/// Tests single pairs: everything that stays the same during one traversal.
pub(crate) struct Examiner<'a> {
    a: &'a Tree,
    b: &'a Tree,
    a_from_b: Pose,
    b_from_a: Pose,
    settings: TraversalSettings,
    seed: u64,
    /// How far the pose can misplace a box by rounding, m.
    rounding: f64,
}

impl<'a> Examiner<'a> {
    pub(crate) fn new(
        a: &'a Tree,
        b: &'a Tree,
        root_a: u32,
        root_b: u32,
        a_from_b: Pose,
        settings: TraversalSettings,
        seed: u64,
    ) -> Self {
        let reach = |root: &NodeData| root.obb.centre.coords.norm() + 3.0 * root.obb.radius();
        let size = reach(&a.nodes[root_a as usize])
            + reach(&b.nodes[root_b as usize])
            + a_from_b.translation().norm();
        let rounding = 16.0 * f64::EPSILON * size;
        Self { a, b, a_from_b, b_from_a: a_from_b.inverse(), settings, seed, rounding }
    }

    /// The gap and bound of a pair, how urgent it is, and whether to descend it.
    pub(crate) fn examine(&self, (id_a, id_b): (u32, u32)) -> Examined {
        let (a, b) = (&self.a.nodes[id_a as usize], &self.b.nodes[id_b as usize]);
        let between = signed_gap(&self.shape(a), &self.shape(b).transformed(&self.a_from_b));
        let axis_in_b = self.b_from_a.transform_vector(&between.axis);
        let apart = between.signed - a.bounds.shift - b.bounds.shift - self.rounding;
        let may_cross = apart < 0.0;
        // Along the axis that parts the surfaces most the points are farther apart by their reach.
        let gap = apart + self.reach(a, &between.axis) + self.reach(b, &axis_in_b);
        let std_a = a.bounds.std_along(&a.obb.axes, &between.axis);
        let std_b = b.bounds.std_along(&b.obb.axes, &axis_in_b);
        let bound = if may_cross { 1.0 } else { plane_bound(gap, std_a.max(std_b)) };
        let (name_a, name_b) = (NodeId(id_a), NodeId(id_b));
        let pair = LeafPair { a: name_a, b: name_b, gap, axis: between.axis, bound, may_cross };

        let reach = |node: &NodeData| node.obb.radius() + node.bounds.shift;
        let size = reach(a).min(reach(b));
        let urgency = if gap < 0.0 && size > 0.0 { gap / size } else { gap };
        // Coverages take a pass over all points, so only the rules that need them ask.
        let sides = || {
            let outside_a = self.a.fraction_outside(id_a);
            let outside_b = self.b.fraction_outside(id_b);
            [Side { outside: outside_a, std: std_a }, Side { outside: outside_b, std: std_b }]
        };
        let descend = gap <= 0.0
            || match self.settings.kind {
                Traversal::Certified => bound > self.settings.cull_probability,
                Traversal::Paper => self.draw(paper_probability(sides()), id_a, id_b),
                Traversal::GapAware => self.draw(gap_aware_probability(gap, sides()), id_a, id_b),
            };
        Examined { pair, urgency, descend }
    }

    /// The box of what may not overlap: of the surfaces where crossings are told apart, else of the
    /// points.
    fn shape(&self, node: &NodeData) -> Obb {
        if self.settings.crossings { node.surface_box() } else { node.obb }
    }

    /// How much farther than the box of the points that box reaches along a unit vector, m.
    fn reach(&self, node: &NodeData, direction: &Vector3) -> f64 {
        if self.settings.crossings { node.reach_along(direction) } else { 0.0 }
    }

    /// Whether an event of this probability happens to this pair of nodes under this seed.
    fn draw(&self, probability: f64, id_a: u32, id_b: u32) -> bool {
        // The extremes need no generator.
        if probability <= 0.0 || probability >= 1.0 {
            return probability >= 1.0;
        }
        seed::unit(seed::derive(self.seed, id_a.into(), id_b.into())) < probability
    }

    /// The pairs one step down, by splitting the larger node; `None` for two leaves.
    pub(crate) fn narrower_pairs(&self, pair: &LeafPair) -> Option<[(u32, u32); 2]> {
        let (NodeId(id_a), NodeId(id_b)) = (pair.a, pair.b);
        let (a, b) = (&self.a.nodes[id_a as usize], &self.b.nodes[id_b as usize]);
        let a_is_larger = a.obb.radius() >= b.obb.radius();
        let below = |node: &NodeData| {
            node.children.filter(|_| node.count as usize > self.settings.leaf_points)
        };
        match (below(a), below(b)) {
            (Some(children), None) => Some(children.map(|child| (child, id_b))),
            (None, Some(children)) => Some(children.map(|child| (id_a, child))),
            (Some(children), Some(_)) if a_is_larger => Some(children.map(|child| (child, id_b))),
            (Some(_), Some(children)) => Some(children.map(|child| (id_a, child))),
            (None, None) => None,
        }
    }
}
