//! One variant of a family: two bodies, what is seen of them, and how they meet.

use cloudtouch_geom::{Point3, TriangleMesh, seed};

use super::{
    ends::Ends,
    motion::Motion,
    observation::{Observation, Side},
    pair::Pair,
    seeing::Seen,
    seen::{all_around, seen_from},
};
use crate::{
    exact::{ExactMesh, Touch},
    noise::NoiseKind,
};

/// Two bodies with exact truth.
pub struct FamilyScene {
    /// The body that stays; its frame is the scene's. Truth is taken from the whole of it, also
    /// where no sensor sees it.
    pub a: ExactMesh,
    /// The body that moves, in its own frame.
    ///
    /// The same pose can be asked in two ways: with B as a cloud, see [`Self::observe`], or with
    /// B known exactly, as a user knows a robot's own parts: give the query `b.mesh()`. That mesh is
    /// then known in whole, also where no sensor sees B, without noise and in its own frame, while
    /// of A there is the same cloud as before. Every pose shows its answer either way: what is seen
    /// of A and of B decides which poses there are, and the whole mesh has what is seen of it. It is
    /// closed, and no part of it lies in another, unless [`Self::touch`] is [`Touch::Surfaces`].
    pub b: ExactMesh,
    /// What counts as a collision of the two.
    pub touch: Touch,
    /// How A and B are observed.
    pub(super) seen: [Seen; 2],
    pub(super) motion: Motion,
}

impl FamilyScene {
    /// Two meshes of any origin, m: the whole of both surfaces is seen, and B comes from anywhere,
    /// turned at random, up to 20 cm into contact. `seed` decides between which points paths lead.
    ///
    /// Both must be closed for [`Touch::Solids`], and may be open for [`Touch::Surfaces`].
    ///
    /// # Panics
    /// When a mesh has no area.
    pub fn of_meshes(a: &TriangleMesh, b: &TriangleMesh, touch: Touch, seed: u64) -> Self {
        Self::from_anywhere(a, b, touch, 0.2, seed)
    }

    /// A fresh cloud of one body: new places on its surface and new errors for each seed, the two
    /// drawn independently, so that clouds of one seed and different noise show the same places.
    ///
    /// To average over what a sensor could have seen at a pose, observe with many seeds. `std` is
    /// the standard deviation along each axis, m; with 0 every point is on the surface. Of a depth
    /// image it is that of the depth at 1 m, growing with the square of the depth, `points` is about
    /// the number of returns, and there are points of veils at depth edges even without noise.
    pub fn observe(
        &self,
        side: Side,
        points: usize,
        noise: NoiseKind,
        std: f64,
        seed: u64,
    ) -> Observation {
        let seeds = [0, 1].map(|use_of_it| seed::derive(seed, side as u64, use_of_it));
        self.seen[side as usize].observe(self.body(side), points, noise, std, seeds)
    }

    /// About how far apart neighbouring points of such a cloud are, m: the root of the area each
    /// has to itself; of a depth image the distance of neighbouring rays in the middle of the scene.
    pub fn spacing(&self, side: Side, points: usize) -> f64 {
        self.seen[side as usize].spacing(points)
    }

    fn body(&self, side: Side) -> &ExactMesh {
        match side {
            Side::A => &self.a,
            Side::B => &self.b,
        }
    }

    pub(super) fn pair(&self) -> Pair<'_> {
        Pair { a: &self.a, b: &self.b, touch: self.touch }
    }

    /// Solids, the first seen from `places`, the second from all around, judged by triangles with
    /// edges up to `edges` metres.
    pub(super) fn surveyed(
        [a, b]: [&TriangleMesh; 2],
        places: &[Point3],
        edges: [f64; 2],
        seed: u64,
        motion: impl FnOnce(Ends) -> Motion,
    ) -> Self {
        let (a, b) = (ExactMesh::new(a), ExactMesh::new(b));
        let seen_a = seen_from(&a, places, edges[0]);
        let seen_b = seen_from(&b, &all_around(b.mesh()), edges[1]);
        let motion = motion(Ends::of(&seen_a, &seen_b, seed));
        let seen = [seen_a, seen_b].map(|mesh| Seen::Surface(Box::new(ExactMesh::new(&mesh))));
        Self { a, b, touch: Touch::Solids, seen, motion }
    }

    /// Two bodies whose whole surfaces are seen.
    pub(super) fn wholly_seen(
        a: &TriangleMesh,
        b: &TriangleMesh,
        touch: Touch,
        motion: Motion,
    ) -> Self {
        let seen = [a, b].map(|mesh| Seen::Surface(Box::new(ExactMesh::new(mesh))));
        Self { a: ExactMesh::new(a), b: ExactMesh::new(b), touch, seen, motion }
    }

    /// The same, the second turned at random and from anywhere.
    pub(super) fn from_anywhere(
        a: &TriangleMesh,
        b: &TriangleMesh,
        touch: Touch,
        deepest: f64,
        seed: u64,
    ) -> Self {
        Self::wholly_seen(a, b, touch, Motion::Open { ends: Ends::of(a, b, seed), deepest })
    }
}
