//! The trees that two bodies are searched by: fitted to their surface where much of it is looked at.
//!
//! What a tree knows of leaves whose surface nobody has seen is loose. Where the noise is not small
//! beside a body, such leaves all reach one another, and a search comes by nearly every pair of them.

use cloudtouch_bvh::{SurfaceFlow, Tree};

use crate::body::BodyRef;
use crate::stats::Stats;

/// So many pairs for each leaf that a search came by say that it rules out too little, ...
const PAIRS_OF_LEAF: usize = 8;
/// ... and where these are a fourth of all leaves, the surface of the rest is worth its price.
const LEAVES_TO_SEEN: usize = 4;

/// The trees of two bodies, and how far a search by them came.
#[derive(Debug)]
pub(in crate::search) struct Trees<'a> {
    bodies: [BodyRef<'a>; 2],
    trees: [&'a Tree; 2],
    /// Whether either may yet be fitted to a surface.
    may_be_loose: [bool; 2],
    pairs: usize,
    leaves: [usize; 2],
}

impl<'a> Trees<'a> {
    pub(in crate::search) fn of(a: BodyRef<'a>, b: BodyRef<'a>) -> Self {
        let bodies = [a, b];
        let may_be_loose = bodies.map(|body| match body {
            BodyRef::Cloud(cloud) => !cloud.prepared().is_refined(),
            BodyRef::Mesh(_) => false,
        });
        let trees = bodies.map(|body| body.shape().tree());
        Self { bodies, trees, may_be_loose, pairs: 0, leaves: [0; 2] }
    }

    /// Whether what a search knows of leaves whose surface it has not seen may be loose, of A and of B.
    pub(in crate::search) fn may_be_loose(&self) -> [bool; 2] {
        self.may_be_loose
    }

    pub(in crate::search) fn both(&self) -> (&'a Tree, &'a Tree) {
        (self.trees[0], self.trees[1])
    }

    /// Counts a pair, after which so many leaves of either were seen.
    pub(in crate::search) fn count_pair(&mut self, leaves: [usize; 2]) {
        self.pairs += 1;
        self.leaves = leaves;
    }

    /// How a search goes on within so many deviations: by trees that are fitted, where it comes by too much; not
    /// where the time is over before they are.
    pub(in crate::search) fn flow(
        &mut self,
        within: f64,
        stats: &mut Stats,
        is_over: impl Fn() -> bool,
    ) -> SurfaceFlow<'a> {
        if !self.are_loose() {
            return SurfaceFlow::Within(within);
        }
        match self.fit(stats, is_over) {
            Some(fitted) => SurfaceFlow::WithinBy(within, fitted),
            None => SurfaceFlow::Stop,
        }
    }

    /// Whether the search had better go on by trees that are fitted. This hangs on bodies and pose alone, not
    /// on what was asked before.
    fn are_loose(&self) -> bool {
        let [of_a, of_b] = self.leaves;
        self.pairs > PAIRS_OF_LEAF * (of_a + of_b) && (self.is_loose(0) || self.is_loose(1))
    }

    /// The trees from now on; `None` where the time is over before they are fitted.
    fn fit(&mut self, stats: &mut Stats, is_over: impl Fn() -> bool) -> Option<[&'a Tree; 2]> {
        for side in [0, 1] {
            if !self.is_loose(side) {
                continue;
            }
            self.may_be_loose[side] = false;
            let BodyRef::Cloud(cloud) = self.bodies[side] else { continue };
            match cloud.prepared().tree_fitted(stats, &is_over) {
                Some(fitted) => self.trees[side] = fitted,
                None if is_over() => return None,
                None => {}
            }
        }
        Some(self.trees)
    }

    /// Whether a tree that can be fitted has been seen in large part; of its nodes half are leaves.
    fn is_loose(&self, side: usize) -> bool {
        let leaves = self.trees[side].node_slots() / 2;
        self.may_be_loose[side] && LEAVES_TO_SEEN * self.leaves[side] > leaves
    }
}
