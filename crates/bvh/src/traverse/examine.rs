//! The test of one pair of nodes: gap, bound, urgency, and whether to descend.

use cloudtouch_geom::{Motion, Pose, Vector3, seed};

use crate::gap::signed_gap_up_to;
use crate::traverse::leakage::{
    Side, gap_aware_probability, gap_of, paper_probability, plane_deviations,
};
use crate::tree::node::pose_rounding;
use crate::{Traversal, TraversalSettings, Tree};

/// What is known of a pair of nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Examined {
    pub(crate) a: u32,
    pub(crate) b: u32,
    /// See [`crate::LeafPair`].
    pub(crate) gap: f64,
    pub(crate) axis: Vector3,
    /// How many standard deviations from a point of either to the middle of the gap, at least; minus
    /// infinity where the boxes overlap.
    pub(crate) deviations: f64,
    /// Small is urgent: negative for an overlap, relative to the smaller node, else the gap, m.
    pub(crate) urgency: f64,
    pub(crate) descend: bool,
}

/// Tests single pairs: everything that stays the same during one traversal.
pub(crate) struct Examiner<'a> {
    a: &'a Tree,
    b: &'a Tree,
    a_from_b: Motion,
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
        let roots = [&a.nodes[root_a as usize], &b.nodes[root_b as usize]];
        let rounding = pose_rounding(roots, &a_from_b);
        Self { a, b, a_from_b: Motion::from(&a_from_b), settings, seed, rounding }
    }

    /// The gap and bound of a pair, how urgent it is, and whether to descend it: a pair with `within`
    /// or more deviations is not wanted.
    pub(crate) fn examine(&self, (id_a, id_b): (u32, u32), within: f64) -> Examined {
        let (a, b) = (&self.a.nodes[id_a as usize], &self.b.nodes[id_b as usize]);
        let [box_a, box_b] = [a, b].map(|node| node.obb.unpacked());
        let [spread_a, spread_b] = [a, b].map(|node| node.bounds.unpacked());
        let slack = spread_a.shift + spread_b.shift + self.rounding;
        let enough = match self.settings.kind {
            Traversal::Certified => {
                let deviations = within.min(self.settings.cull_deviations);
                gap_of(deviations, spread_a.max_std.max(spread_b.max_std)) + slack
            }
            // What is drawn depends on the gap.
            Traversal::Paper | Traversal::GapAware => f64::INFINITY,
        };
        let between = signed_gap_up_to(&box_a, &box_b.moved(&self.a_from_b), enough);
        let gap = between.signed - slack;
        let axis = between.axis;
        let axis_in_b = self.a_from_b.vector_back(&axis);
        let std_a = spread_a.std_along(&box_a.axes, &axis);
        let std_b = spread_b.std_along(&box_b.axes, &axis_in_b);
        let deviations =
            if gap < 0.0 { f64::NEG_INFINITY } else { plane_deviations(gap, std_a.max(std_b)) };
        let size = (box_a.radius() + spread_a.shift).min(box_b.radius() + spread_b.shift);
        let urgency = if gap < 0.0 && size > 0.0 { (gap / size).max(f64::MIN) } else { gap };
        // Coverages take a pass over all points, so only the rules that need them ask.
        let sides = || {
            let outside_a = self.a.fraction_outside(id_a);
            let outside_b = self.b.fraction_outside(id_b);
            [Side { outside: outside_a, std: std_a }, Side { outside: outside_b, std: std_b }]
        };
        let descend = deviations < within
            && (gap <= 0.0
                || match self.settings.kind {
                    Traversal::Certified => deviations < self.settings.cull_deviations,
                    Traversal::Paper => self.draw(paper_probability(sides()), id_a, id_b),
                    Traversal::GapAware => {
                        self.draw(gap_aware_probability(gap, sides()), id_a, id_b)
                    }
                });
        Examined { a: id_a, b: id_b, gap, axis, deviations, urgency, descend }
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
    pub(crate) fn narrower_pairs(&self, pair: &Examined) -> Option<[(u32, u32); 2]> {
        let (id_a, id_b) = (pair.a, pair.b);
        let (a, b) = (&self.a.nodes[id_a as usize], &self.b.nodes[id_b as usize]);
        let a_is_larger = a.obb.squared_radius() >= b.obb.squared_radius();
        match (a.children(), b.children()) {
            (Some(children), None) => Some(children.map(|child| (child, id_b))),
            (None, Some(children)) => Some(children.map(|child| (id_a, child))),
            (Some(children), Some(_)) if a_is_larger => Some(children.map(|child| (child, id_b))),
            (Some(_), Some(children)) => Some(children.map(|child| (id_a, child))),
            (None, None) => None,
        }
    }
}
