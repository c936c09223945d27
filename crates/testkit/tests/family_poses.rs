//! The poses of every family: labels are true, half are near contact, half collide.

use cloudtouch_testkit::{
    exact::{ExactMesh, Touch, brute},
    family::{Family, FamilyScene},
    poses::{LabelledPose, NEAR},
    scene,
};
use cloudtouch_geom::{Pose, Vector3};

const COUNT: usize = 16;

/// Scenes of two or three seeds, few poses each.
fn each_variant(mut check: impl FnMut(Family, u64, &FamilyScene, &[LabelledPose])) {
    for &family in Family::ALL {
        for seed in [1, 2, 3] {
            let scene = family.scene(seed);
            let begin = std::time::Instant::now();
            let poses = scene.poses(COUNT, seed);
            println!("{} {seed} {:?} tris {} {}", family.name(), begin.elapsed(), scene.a.mesh().triangles().len(), scene.b.mesh().triangles().len());
            check(family, seed, &scene, &poses);
        }
    }
}

#[test]
fn half_are_near_and_half_collide() {
    each_variant(|family, seed, _, poses| {
        let name = family.name();
        let near: Vec<_> = poses.iter().filter(|p| p.signed_distance.abs() <= NEAR).collect();
        assert!(near.len() >= COUNT / 2, "{name} {seed}: {} near", near.len());
        for (which, count, total) in [
            ("all", poses.iter().filter(|p| p.in_collision).count(), COUNT),
            ("near", near.iter().filter(|p| p.in_collision).count(), near.len()),
        ] {
            let share = count as f64 / total as f64;
            println!("{name} {seed} {which}: {count} of {total}");
            assert!((0.25..=0.75).contains(&share), "{name} {seed} {which}: {count} of {total}");
        }
    });
}

#[test]
fn labels_are_true() {
    each_variant(|family, seed, scene, poses| {
        for pose in poses {
            let name = family.name();
            let place = &pose.scene_from_object;
            assert_eq!(pose.in_collision, scene.a.touches(&scene.b, place, scene.touch));
            assert_eq!(pose.in_collision, pose.signed_distance < 0.0);
            assert!(pose.signed_distance.is_finite(), "{name} {seed}");
            if !pose.in_collision {
                assert_eq!(pose.signed_distance, scene.a.distance(&scene.b, place));
            }
        }
        assert_eq!(poses, scene.poses(COUNT, seed));
    });
}
