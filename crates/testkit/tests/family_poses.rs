//! The poses of every family: labels are true, half are near contact, exactly half collide.

use std::sync::OnceLock;

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};
use cloudtouch_testkit::{
    exact::brute,
    family::{Family, FamilyScene},
    poses::{LabelledPose, NEAR},
};

const COUNT: usize = 16;

struct Variant {
    family: Family,
    seed: u64,
    scene: FamilyScene,
    poses: Vec<LabelledPose>,
}

/// Three variants of each family, made once for all tests.
fn variants() -> &'static [Variant] {
    static VARIANTS: OnceLock<Vec<Variant>> = OnceLock::new();
    VARIANTS.get_or_init(|| {
        let of = |family: Family, seed: u64| {
            let scene = family.scene(seed);
            let poses = scene.poses(COUNT, seed);
            Variant { family, seed, scene, poses }
        };
        Family::ALL.iter().flat_map(|&f| [1, 2, 3].map(|seed| of(f, seed))).collect()
    })
}

fn of_family(family: Family) -> impl Iterator<Item = &'static Variant> {
    variants().iter().filter(move |v| v.family == family)
}

fn near(poses: &[LabelledPose]) -> Vec<&LabelledPose> {
    poses.iter().filter(|p| p.signed_distance.abs() <= NEAR).collect()
}

#[test]
fn half_are_near_and_half_collide() {
    for Variant { family, seed, poses, .. } in variants() {
        let near = near(poses);
        assert!(near.len() >= COUNT / 2, "{family:?} {seed}: {} near", near.len());
        assert!(near.len() <= COUNT - 2, "{family:?} {seed}: hardly any is not near");
        let colliding = |poses: &[&LabelledPose]| poses.iter().filter(|p| p.in_collision).count();
        assert_eq!(colliding(&poses.iter().collect::<Vec<_>>()), COUNT / 2, "{family:?} {seed}");
        let share = colliding(&near) as f64 / near.len() as f64;
        assert!((0.25..=0.75).contains(&share), "{family:?} {seed}: {share} of the near collide");
    }
}

#[test]
fn fewer_poses_are_the_first_of_more_and_half_of_them_collide() {
    for family in [Family::WedgeAndPlane, Family::Desk, Family::BoxesInBin] {
        let v = of_family(family).next().unwrap();
        for count in [1, 6, 9, 15] {
            let fewer = v.scene.poses(count, v.seed);
            assert_eq!(fewer, v.poses[..count]);
            let colliding = fewer.iter().filter(|p| p.in_collision).count();
            assert!(colliding == count / 2 || colliding == count.div_ceil(2), "{colliding}");
        }
    }
}

#[test]
fn labels_are_true() {
    for Variant { family, seed, scene, poses } in variants() {
        for pose in poses {
            let place = &pose.scene_from_object;
            assert_eq!(pose.in_collision, scene.a.touches(&scene.b, place, scene.touch));
            assert_eq!(pose.in_collision, pose.signed_distance < 0.0, "{family:?} {seed}");
            assert!(pose.signed_distance > -1.0, "{family:?} {seed}: {}", pose.signed_distance);
            if !pose.in_collision {
                assert_eq!(pose.signed_distance, scene.a.distance(&scene.b, place));
            }
        }
    }
}

#[test]
fn labels_of_the_ordinary_are_those_of_trying_every_pair() {
    for family in [Family::LivingRoom, Family::Kitchen, Family::BoxesInBin, Family::Staircase] {
        let v = of_family(family).next().unwrap();
        let (a, b) = (v.scene.a.mesh(), v.scene.b.mesh());
        for pose in &v.poses[..4] {
            let slow = brute::distance(a, b, &pose.scene_from_object);
            if pose.in_collision {
                // Or one is inside the other.
                assert!(slow == 0.0 || !v.scene.a.intersects(&v.scene.b, &pose.scene_from_object));
            } else {
                assert!((slow - pose.signed_distance).abs() < 1e-9, "{family:?}: {slow}");
            }
        }
    }
}

#[test]
fn the_seed_decides() {
    for family in [Family::Tabletop, Family::PegInHole, Family::CrossingSheets, Family::Workbench] {
        let v = of_family(family).next().unwrap();
        let again = family.scene(v.seed);
        assert_eq!(v.poses, again.poses(COUNT, v.seed));
        assert_ne!(v.poses, again.poses(COUNT, v.seed + 1));
        assert_ne!(family.scene(v.seed + 1).a.mesh(), again.a.mesh());
    }
}

#[test]
fn most_near_pegs_are_in_the_hole() {
    for v in of_family(Family::PegInHole) {
        let near = near(&v.poses);
        let inside = near.iter().filter(|p| {
            let axis = p.scene_from_object.transform_vector(&Vector3::z());
            let middle = p.scene_from_object.transform_point(&Point3::origin());
            axis.z.abs() > 0.8 && middle.coords.xy().norm() < 0.25 && middle.z.abs() < 0.7
        });
        assert!(3 * inside.count() > near.len(), "variant {}", v.seed);
    }
}

#[test]
fn most_near_tori_are_linked() {
    for v in of_family(Family::InterlockedTori) {
        let near = near(&v.poses);
        // The radius between the inner and the outer rim.
        let major = |mesh: &TriangleMesh| {
            let radii = || mesh.vertices().iter().map(|p| p.coords.xy().norm());
            0.5 * (radii().fold(f64::INFINITY, f64::min) + radii().fold(0.0, f64::max))
        };
        let (fixed, moving) = (major(v.scene.a.mesh()), major(v.scene.b.mesh()));
        let linked = near.iter().filter(|p| {
            let at = |i: i32| {
                let (sin, cos) = f64::from(i).to_radians().sin_cos();
                p.scene_from_object.transform_point(&Point3::new(moving * cos, moving * sin, 0.0))
            };
            // How often the moving circle goes through the disc of the fixed one.
            let through = (0..360)
                .filter(|&i| at(i).z * at(i + 1).z < 0.0 && at(i).coords.xy().norm() < fixed);
            through.count() % 2 == 1
        });
        assert!(2 * linked.count() > near.len(), "variant {}", v.seed);
    }
}

#[test]
fn the_robot_drives_upright_just_above_the_floor() {
    for v in of_family(Family::Doorway) {
        for pose in &v.poses {
            let up = pose.scene_from_object.transform_vector(&Vector3::z());
            assert!((up - Vector3::z()).norm() < 1e-9);
            let clearance = pose.scene_from_object.translation().z;
            assert!((0.035..0.06).contains(&clearance), "{clearance}");
        }
    }
}

#[test]
fn the_gripper_comes_fingers_first_from_above_or_from_the_camera() {
    for v in of_family(Family::Tabletop) {
        // The table's legs are the longest edges straight down.
        let down = {
            let mesh = v.scene.a.mesh();
            let mut edges = (0..mesh.triangles().len()).flat_map(|t| {
                let [a, b, c] = mesh.corners(t);
                [b - a, c - b, a - c]
            });
            let leg = edges.find(|e| (e.norm() - 0.67).abs() < 1e-9).unwrap().normalize();
            // The camera looks down, at the table.
            if leg.z > 0.0 { leg } else { -leg }
        };
        for pose in &v.poses {
            let ahead = pose.scene_from_object.transform_vector(&Vector3::z());
            let seen_from_camera = pose.scene_from_object.translation().normalize();
            let turned = |axis: &Vector3| ahead.dot(axis).acos();
            assert!(turned(&down) < 0.6 + 1e-9 || turned(&seen_from_camera) < 0.5, "{pose:?}");
        }
    }
}
