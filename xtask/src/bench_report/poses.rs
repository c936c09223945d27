//! Poses of the piano in the room: far from it, near contact, deep in it.

use anyhow::{Result, ensure};
use cloudtouch_geom::seed::derive;
use cloudtouch_testkit::{
    exact::ExactMesh,
    poses::{LabelledPose, poses_near_contact},
};
use rayon::prelude::*;

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

impl Class {
    pub(super) const ALL: [Self; 3] = [Self::Far, Self::Near, Self::Deep];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Far => "far",
            Self::Near => "near",
            Self::Deep => "deep",
        }
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

/// A pose with its exact label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Posed {
    pub(super) class: Class,
    pub(super) pose: LabelledPose,
}

/// Poses drawn at once on all threads, so many by each; what does not fit a class is dropped.
const BATCH: [usize; 2] = [4, 4];
/// More draws than this mean that a class cannot be had.
const MOST_BATCHES: u64 = 2000;

/// So many poses, the classes in turn, far first; every second near one collides.
///
/// # Errors
/// When there is no pose of some class in very many draws.
pub(super) fn draw(
    scene: &ExactMesh,
    object: &ExactMesh,
    count: usize,
    from: u64,
) -> Result<Vec<Posed>> {
    let drawn = |batch, part| {
        poses_near_contact(scene, object, BATCH[1], derive(derive(from, 1, batch), part as u64, 0))
    };
    pick(count, |batch| {
        (0..BATCH[0]).into_par_iter().flat_map_iter(|part| drawn(batch, part)).collect()
    })
}

fn pick(count: usize, mut drawn: impl FnMut(u64) -> Vec<LabelledPose>) -> Result<Vec<Posed>> {
    let mut found = [const { Vec::new() }; KINDS.len()];
    let mut wanted = [0; KINDS.len()];
    (0..count).for_each(|i| wanted[kind_of(i)] += 1);
    for batch in 0.. {
        if (0..KINDS.len()).all(|kind| found[kind].len() >= wanted[kind]) {
            break;
        }
        ensure!(batch < MOST_BATCHES, "too few far, near or deep poses in {batch} draws");
        for pose in drawn(batch) {
            let collides = |kind: &(Class, Option<bool>)| {
                kind.1.is_none_or(|collides| collides == pose.in_collision)
            };
            let class = Class::of(pose.signed_distance);
            let kind = KINDS.iter().position(|k| Some(k.0) == class && collides(k));
            if let Some(kind) = kind {
                found[kind].push(pose);
            }
        }
    }
    let mut found = found.map(Vec::into_iter);
    let in_turn = (0..count).filter_map(|i| {
        let kind = kind_of(i);
        Some(Posed { class: KINDS[kind].0, pose: found[kind].next()? })
    });
    Ok(in_turn.collect())
}

/// What is wanted, and whether it collides where the class alone does not say.
const KINDS: [(Class, Option<bool>); 4] = [
    (Class::Far, None),
    (Class::Near, Some(false)),
    (Class::Near, Some(true)),
    (Class::Deep, None),
];

/// The kind of the pose with this number.
fn kind_of(number: usize) -> usize {
    [0, 1, 3, 0, 2, 3][number % 6]
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;

    use super::*;

    fn at(signed_distance: f64) -> LabelledPose {
        let scene_from_object = Pose::identity();
        LabelledPose { scene_from_object, in_collision: signed_distance < 0.0, signed_distance }
    }

    #[test]
    fn classes_have_gaps_between_them() {
        let of = |d| Class::of(d).map(Class::name);
        assert_eq!([0.5, 0.1].map(of), [Some("far"); 2]);
        assert_eq!([0.02, 0.0, -0.02].map(of), [Some("near"); 3]);
        assert_eq!([-0.05, -1.0, f64::NEG_INFINITY].map(of), [Some("deep"); 3]);
        assert_eq!([0.05, -0.03, f64::NAN].map(of), [None; 3]);
    }

    #[test]
    fn every_third_pose_is_of_a_class() {
        let batch = |_| [0.3, 0.01, 0.01, 0.05, -0.01, -0.2].map(at).to_vec();
        for count in 0..8 {
            let posed = pick(count, batch).unwrap();
            assert_eq!(posed.len(), count);
            for (i, posed) in posed.iter().enumerate() {
                assert_eq!(posed.class, Class::ALL[i % 3]);
                if posed.class == Class::Near {
                    assert_eq!(posed.pose.in_collision, i % 6 == 4);
                }
                assert_eq!(Class::of(posed.pose.signed_distance), Some(posed.class));
            }
        }
    }

    #[test]
    fn a_class_that_cannot_be_had_is_an_error() {
        assert!(pick(3, |_| vec![at(0.3), at(0.0)]).is_err());
    }
}
