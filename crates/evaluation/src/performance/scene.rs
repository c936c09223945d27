//! The piano and the room: meshes, noisy clouds, and poses far from contact, near and deep.

use anyhow::{Context, Result};
use cloudtouch_geom::{PointCloud, Pose, TriangleMesh, seed::derive};
use cloudtouch_testkit::{
    exact::ExactMesh,
    noise::{NoiseKind, add_noise},
    poses::{LabelledPose, poses_near_contact},
    scene,
    surface::{positions, sample_surface},
};
use rayon::prelude::*;

/// Points of a cloud where nothing else is said.
pub(super) const POINTS: usize = 10_000;
/// Standard deviation of the noise where nothing else is said, m.
pub(super) const STD: f64 = 0.002;

/// The edges that leave so many triangles, m: the room at 10,000 and the piano.
const ROOM_EDGE: f64 = 0.42;
const PIANO_EDGE: f64 = 0.13;

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

/// A pose with its exact label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Posed {
    pub(super) class: Class,
    pub(super) collides: bool,
    /// Maps the frame of the piano into that of the room.
    pub(super) pose: Pose,
}

/// What is measured on.
pub(super) struct Scene {
    room: TriangleMesh,
    piano: TriangleMesh,
    /// The classes in turn, every second near one a collision.
    pub(super) poses: Vec<Posed>,
    /// Everything random comes from this.
    pub(super) seed: u64,
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
/// Poses drawn at once on all threads, so many by each; what does not fit a class is dropped.
const BATCH: [u64; 2] = [4, 4];
/// More draws than this mean that a class cannot be had.
const MOST_BATCHES: u64 = 2000;

impl Class {
    pub(super) const ALL: [Self; 3] = [Self::Far, Self::Near, Self::Deep];

    pub(super) fn name(self) -> &'static str {
        ["far", "near", "deep"][self as usize]
    }

    /// None for what lies between the classes.
    fn of(signed_distance: f64) -> Option<Self> {
        match signed_distance {
            d if d >= 0.1 => Some(Self::Far),
            d if d.abs() <= 0.02 => Some(Self::Near),
            d if d <= -0.05 => Some(Self::Deep),
            _ => None,
        }
    }
}

impl Scene {
    /// Draws so many poses.
    ///
    /// # Errors
    /// When a class of poses cannot be had.
    pub(super) fn draw(poses: usize, seed: u64) -> Result<Self> {
        let (room, piano) = (scene::room(), scene::piano());
        let exact = [&room, &piano].map(ExactMesh::new);
        let drawn = |batch| {
            let part = |part| {
                let from = derive(derive(seed, 1, batch), part, 0);
                poses_near_contact(&exact[0], &exact[1], BATCH[1] as usize, from)
            };
            (0..BATCH[0]).into_par_iter().flat_map_iter(part).collect()
        };
        let poses = pick(poses, drawn)?;
        Ok(Self { room, piano, poses, seed })
    }

    /// The room, with noise of this standard deviation (m).
    pub(super) fn room(&self, points: usize, std: f64) -> PointCloud {
        noisy(&self.room, points, std, derive(self.seed, 2, 0))
    }

    /// The piano, with noise of this standard deviation (m).
    pub(super) fn piano(&self, std: f64) -> PointCloud {
        noisy(&self.piano, POINTS, std, derive(self.seed, 2, 1))
    }

    /// The room's surface in about so many triangles, and the piano's in ten thousand.
    pub(super) fn meshes(&self, triangles: usize) -> [TriangleMesh; 2] {
        let edge = ROOM_EDGE * (POINTS as f64 / triangles as f64).sqrt();
        [(&self.room, edge), (&self.piano, PIANO_EDGE)]
            .map(|(mesh, edge)| scene::subdivide_to_max_edge(mesh, edge))
    }
}

fn noisy(mesh: &TriangleMesh, points: usize, std: f64, stream: u64) -> PointCloud {
    let exact = positions(&sample_surface(mesh, points, stream));
    let errors = derive(stream, 1, 0);
    PointCloud::from_points(add_noise(&exact, NoiseKind::Gaussian, std, errors))
}

/// So many poses in turn, each the first drawn of its kind that is not taken.
fn pick(count: usize, mut drawn: impl FnMut(u64) -> Vec<LabelledPose>) -> Result<Vec<Posed>> {
    let mut places: Vec<Option<Posed>> = vec![None; count];
    for batch in 0..MOST_BATCHES {
        if places.iter().all(Option::is_some) {
            break;
        }
        for LabelledPose { scene_from_object: pose, in_collision: collides, signed_distance } in
            drawn(batch)
        {
            let Some(class) = Class::of(signed_distance) else { continue };
            let kind = |i: usize| TURN[i % TURN.len()];
            let is_open = |i: &usize| places[*i].is_none() && kind(*i) == (class, collides);
            if let Some(place) = (0..count).find(is_open) {
                places[place] = Some(Posed { class, collides, pose });
            }
        }
    }
    let all: Option<Vec<Posed>> = places.into_iter().collect();
    all.with_context(|| format!("too few far, near or deep poses in {MOST_BATCHES} draws"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(signed_distance: f64) -> LabelledPose {
        let scene_from_object = Pose::identity();
        LabelledPose { scene_from_object, in_collision: signed_distance < 0.0, signed_distance }
    }

    #[test]
    fn classes_have_gaps_between_them() {
        assert_eq!([0.5, 0.1].map(Class::of), [Some(Class::Far); 2]);
        assert_eq!([0.02, 0.0, -0.02].map(Class::of), [Some(Class::Near); 3]);
        assert_eq!([-0.05, f64::NEG_INFINITY].map(Class::of), [Some(Class::Deep); 2]);
        assert_eq!([0.05, -0.03, f64::NAN].map(Class::of), [None; 3]);
    }

    #[test]
    fn every_third_pose_is_of_a_class_and_one_that_cannot_be_had_is_an_error() {
        let batch = |_| [0.3, 0.01, 0.01, 0.05, -0.01, -0.2].map(at).to_vec();
        for count in 0..8 {
            let posed = pick(count, batch).unwrap();
            assert_eq!(posed.len(), count);
            for (i, posed) in posed.iter().enumerate() {
                assert_eq!((posed.class, posed.collides), TURN[i % 6]);
            }
        }
        assert!(pick(3, |_| vec![at(0.3), at(0.0)]).is_err());
    }
}
