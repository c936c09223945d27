//! Points of the two surfaces between which paths lead.

use cloudtouch_geom::{TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::pair::Pair;
use crate::{
    poses::Approach,
    surface::{SurfaceSample, sample_surface},
};

/// Points of what is seen of the scene and of the moving body.
pub(super) struct Ends {
    targets: Vec<SurfaceSample>,
    grips: Vec<SurfaceSample>,
}

impl Ends {
    /// A thousand points of each surface that sensors see.
    pub(super) fn of(scene: &TriangleMesh, object: &TriangleMesh, seed: u64) -> Self {
        let points = |mesh, stream| sample_surface(mesh, 1000, seed::derive(seed, 100, stream));
        Self { targets: points(scene, 0), grips: points(object, 1) }
    }

    /// From anywhere in or around the scene's box, turned at random.
    pub(super) fn approach(&self, pair: Pair, rng: &mut ChaCha8Rng) -> Approach {
        Approach::draw(pair.a, pair.b, pair.touch, &self.targets, &self.grips, rng)
    }

    /// A point of the scene, and one of the moving body in its own frame.
    pub(super) fn draw(&self, rng: &mut ChaCha8Rng) -> [Vector3; 2] {
        [&self.targets, &self.grips]
            .map(|points| points[rng.random_range(0..points.len())].position.coords)
    }
}
