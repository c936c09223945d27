//! The piano and the room: meshes, noisy clouds, and poses far from contact, near and deep.

use anyhow::{Context, Result};
use cloudtouch_geom::TriangleMesh;
use cloudtouch_geom::seed::derive;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::family::Observation;
use cloudtouch_testkit::poses::{LabelledPose, poses_near_contact};
use cloudtouch_testkit::scene;
use rayon::prelude::*;

use crate::SEED;
use crate::methods::sampled;

/// Points of a cloud where nothing else is said.
pub(super) const POINTS: usize = 10_000;
/// Standard deviation of the noise where nothing else is said, m.
pub(super) const STD: f64 = 0.002;
/// The edges that leave so many triangles, m: the room at 10,000 and the piano.
const EDGES: [f64; 2] = [0.42, 0.13];
/// Poses drawn at once; what does not fit a class is dropped.
const BATCH: usize = 4;

/// How close the exact surfaces are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    /// At least 10 cm apart.
    Far,
    /// At most 2 cm apart, or that deep in overlap.
    Near,
    /// At least 5 cm of overlap.
    Deep,
}

/// What is measured on.
pub(super) struct Scene {
    room: TriangleMesh,
    pub(super) piano: TriangleMesh,
    /// The kinds of [`TURN`] in turn.
    pub(super) poses: Vec<LabelledPose>,
}

/// What the poses are, in turn: their class, and whether they collide.
const TURN: [(Class, bool); 6] = [
    (Class::Far, false),
    (Class::Near, false),
    (Class::Deep, true),
    (Class::Far, false),
    (Class::Near, true),
    (Class::Deep, true),
];

impl Class {
    /// None for what lies between the classes.
    pub(super) fn of(pose: &LabelledPose) -> Option<Self> {
        match pose.signed_distance {
            d if d >= 0.1 => Some(Self::Far),
            d if d.abs() <= 0.02 => Some(Self::Near),
            d if d <= -0.05 => Some(Self::Deep),
            _ => None,
        }
    }
}

impl Scene {
    /// Draws so many poses; fails when a class of them cannot be had.
    pub(super) fn draw(count: usize) -> Result<Self> {
        let (room, piano) = (scene::room(), scene::piano());
        let exact = [&room, &piano].map(ExactMesh::new);
        let batch = |number: u64| {
            let drawn =
                |part| poses_near_contact(&exact[0], &exact[1], BATCH, derive(SEED, 1, part));
            (4 * number..4 * number + 4).into_par_iter().flat_map_iter(drawn).collect::<Vec<_>>()
        };
        let mut drawn = (0..2000).flat_map(batch).filter(|pose| Class::of(pose).is_some());
        // What was drawn before its turn.
        let mut spare: Vec<LabelledPose> = Vec::new();
        let mut next = |turn: (Class, bool)| {
            let is_wanted =
                |p: &LabelledPose| Class::of(p) == Some(turn.0) && p.in_collision == turn.1;
            loop {
                if let Some(at) = spare.iter().position(is_wanted) {
                    return Some(spare.remove(at));
                }
                spare.push(drawn.next()?);
            }
        };
        let poses: Option<Vec<_>> = (0..count).map(|i| next(TURN[i % TURN.len()])).collect();
        let poses = poses.context("too few far, near or deep poses")?;
        Ok(Self { room, piano, poses })
    }

    /// The room in so many points, with noise of this standard deviation (m).
    pub(super) fn room(&self, points: usize, std: f64) -> Observation {
        sampled(&self.room, points, std, seeds(derive(SEED, 2, 0)))
    }

    /// The piano in [`POINTS`] points.
    pub(super) fn piano(&self, std: f64) -> Observation {
        sampled(&self.piano, POINTS, std, seeds(derive(SEED, 2, 1)))
    }

    /// The room's surface in about so many triangles, and the piano's in ten thousand.
    pub(super) fn meshes(&self, triangles: usize) -> [TriangleMesh; 2] {
        let edge = EDGES[0] * (POINTS as f64 / triangles as f64).sqrt();
        [(&self.room, edge), (&self.piano, EDGES[1])]
            .map(|(mesh, edge)| scene::subdivide_to_max_edge(mesh, edge))
    }
}

/// Those of places and of errors.
pub(super) fn seeds(stream: u64) -> [u64; 2] {
    [stream, derive(stream, 1, 0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_what_they_are_drawn_for() {
        let scene = Scene::draw(7).unwrap();
        let exact = [&scene.room, &scene.piano].map(ExactMesh::new);
        for (pose, (class, collides)) in scene.poses.iter().zip(TURN.into_iter().cycle()) {
            assert_eq!((Class::of(pose), pose.in_collision), (Some(class), collides));
            assert_eq!(exact[0].solids_overlap(&exact[1], &pose.scene_from_object), collides);
        }
    }
}
