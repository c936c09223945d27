//! Poses by how close contact is: far from it, near and in deep overlap, as times of queries are told apart.

use cloudtouch_geom::seed::derive;

use crate::exact::ExactMesh;
use crate::poses::{LabelledPose, poses_near_contact};

/// How close the exact surfaces are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// At least 10 cm apart.
    Far,
    /// At most 2 cm apart, or that deep in overlap.
    Near,
    /// At least 5 cm of overlap.
    Deep,
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
/// Poses drawn at once; what does not fit a class is dropped.
const BATCH: usize = 4;
/// How often so many are drawn at most.
const DRAWS: u64 = 8000;

impl Class {
    /// `None` for what lies between the classes.
    pub fn of(pose: &LabelledPose) -> Option<Self> {
        match pose.signed_distance {
            d if d >= 0.1 => Some(Self::Far),
            d if d.abs() <= 0.02 => Some(Self::Near),
            d if d <= -0.05 => Some(Self::Deep),
            _ => None,
        }
    }
}

/// So many poses of the classes in turn, of those near contact every other one in collision; `None` where one
/// of them cannot be had.
pub fn poses_by_class(
    scene: &ExactMesh,
    object: &ExactMesh,
    count: usize,
    seed: u64,
) -> Option<Vec<LabelledPose>> {
    let draw = |part| poses_near_contact(scene, object, BATCH, derive(seed, 1, part));
    let mut drawn = (0..DRAWS).flat_map(draw).filter(|pose| Class::of(pose).is_some());
    // What was drawn before its turn.
    let mut spare: Vec<LabelledPose> = Vec::new();
    let mut next = |turn: (Class, bool)| {
        let is_wanted = |p: &LabelledPose| Class::of(p) == Some(turn.0) && p.in_collision == turn.1;
        loop {
            if let Some(at) = spare.iter().position(is_wanted) {
                return Some(spare.remove(at));
            }
            spare.push(drawn.next()?);
        }
    };
    (0..count).map(|i| next(TURN[i % TURN.len()])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    #[test]
    fn poses_are_what_they_are_drawn_for() {
        let exact = [scene::room(), scene::piano()].map(|mesh| ExactMesh::new(&mesh));
        let poses = poses_by_class(&exact[0], &exact[1], 7, 2011).unwrap();
        assert_eq!(poses.len(), 7);
        for (pose, (class, collides)) in poses.iter().zip(TURN.into_iter().cycle()) {
            assert_eq!((Class::of(pose), pose.in_collision), (Some(class), collides));
            assert_eq!(exact[0].solids_overlap(&exact[1], &pose.scene_from_object), collides);
        }
    }
}
