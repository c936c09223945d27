//! The fast exact answers agree with trying every pair, and with closed forms.

use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3, seed};
use cloudtouch_testkit::{
    exact::{ExactMesh, Touch, WayOut, brute},
    poses::poses_near_contact,
    scene,
};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use rand::RngExt;

fn small_meshes() -> Vec<TriangleMesh> {
    vec![
        scene::cuboid([0.2, 0.3, 0.1]),
        scene::wedge(0.2, 0.2, 0.3),
        scene::torus(0.2, 0.05, 16),
        scene::thin_slab(0.4),
        scene::crossing_sheets(0.4),
        scene::plate_with_hole(0.4, 0.05, 0.1),
    ]
}

fn random_pose(seed: u64, reach: f64) -> Pose {
    let mut rng = seed::generator(seed);
    let mut unit = || 2.0 * rng.random::<f64>() - 1.0;
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(unit(), unit(), unit(), unit()));
    let offset = Translation3::new(unit() * reach, unit() * reach, unit() * reach);
    Pose::from_isometry(Isometry3::from_parts(offset, rotation))
}

#[test]
fn parry_agrees_with_every_pair_on_random_poses() {
    let meshes = small_meshes();
    let exact: Vec<_> = meshes.iter().map(ExactMesh::new).collect();
    let (mut crossing, mut total, mut worst) = (0, 0, 0.0_f64);
    for i in 0..meshes.len() {
        for j in 0..meshes.len() {
            for k in 0..40 {
                let pose = random_pose(seed::derive(k, i as u64, j as u64), 0.3);
                let slow = brute::distance(&meshes[i], &meshes[j], &pose);
                assert_eq!(brute::intersects(&meshes[i], &meshes[j], &pose), slow == 0.0);
                assert_eq!(
                    exact[i].intersects(&exact[j], &pose),
                    slow == 0.0,
                    "meshes {i} and {j}, pose {k}: the distance is {slow:e}"
                );
                worst = worst.max((exact[i].distance(&exact[j], &pose) - slow).abs());
                crossing += usize::from(slow == 0.0);
                total += 1;
            }
        }
    }
    assert!(worst < 1e-9, "distances differ by {worst:e} m");
    // Otherwise the comparison says little.
    assert!(crossing > total / 5 && crossing < 4 * total / 5, "{crossing} of {total} cross");
}

#[test]
fn parry_agrees_with_every_pair_within_a_micrometre_of_contact() {
    let meshes = small_meshes();
    for (i, j) in [(0, 1), (1, 2), (2, 5), (0, 3), (5, 0)] {
        let (a, b) = (ExactMesh::new(&meshes[i]), ExactMesh::new(&meshes[j]));
        for k in 0..10 {
            let start = random_pose(seed::derive(100 + k, i as u64, j as u64), 0.1);
            let away = |t: f64| Pose::from_translation(Vector3::new(t, 0.0, 0.0)).after(&start);
            // From overlap near the middle to a metre off, to the micrometre.
            let (mut low, mut high) = (0.0, 1.5);
            while high - low > 2e-6 {
                let middle = 0.5 * (low + high);
                let touching = brute::intersects(&meshes[i], &meshes[j], &away(middle));
                if touching { low = middle } else { high = middle }
            }
            for (t, expected) in [(low, low > 0.0), (high, false)] {
                assert_eq!(a.intersects(&b, &away(t)), expected, "meshes {i}, {j}, pose {k}");
            }
            assert!(a.distance(&b, &away(high)) <= high - low + 1e-9 || low == 0.0);
        }
    }
}

#[test]
fn one_solid_inside_another_overlaps_without_a_common_surface_point() {
    let (large, small) =
        (ExactMesh::new(&scene::cuboid([1.0; 3])), ExactMesh::new(&scene::cuboid([0.1; 3])));
    let pose = Pose::from_translation(Vector3::new(0.2, 0.0, 0.0));
    assert!(!large.intersects(&small, &pose));
    assert!(large.solids_overlap(&small, &pose) && small.solids_overlap(&large, &pose.inverse()));
    let far = Pose::from_translation(Vector3::new(0.8, 0.0, 0.0));
    assert!(!large.solids_overlap(&small, &far));
}

#[test]
fn inside_is_told_from_outside() {
    let torus = ExactMesh::new(&scene::torus(0.3, 0.1, 64));
    assert!(torus.contains(&Point3::new(0.3, 0.0, 0.0)));
    assert!(!torus.contains(&Point3::origin()), "the hole is outside");
    assert!(!torus.contains(&Point3::new(f64::NAN, 0.0, 0.0)));
    let ball = ExactMesh::new(&scene::sphere(0.5, 3));
    let mut rng = seed::generator(9);
    let mut inside = 0;
    for _ in 0..500 {
        let p = Point3::from(Vector3::from_fn(|_, _| 1.2 * rng.random::<f64>() - 0.6));
        let radius = p.coords.norm();
        // Between the faces and the sphere around them either answer is right.
        if !(0.49..0.5).contains(&radius) {
            assert_eq!(ball.contains(&p), radius < 0.495, "at {p}");
            let winding = ball.winding_number(&p);
            assert!((winding - winding.round()).abs() < 1e-9);
        }
        inside += usize::from(radius < 0.49);
    }
    assert!((100..400).contains(&inside));
}

#[test]
fn penetration_depth_is_near_the_truth_and_never_below() {
    let a = ExactMesh::new(&scene::cuboid([1.0, 1.0, 1.0]));
    let b = ExactMesh::new(&scene::sphere(0.2, 3));
    for depth in [0.001, 0.01, 0.1, 0.3] {
        let pose = Pose::from_translation(Vector3::new(0.0, 0.1, 0.7 - depth));
        let bound = a.penetration_depth(&b, &pose);
        // The ball's topmost vertex is on the axis only up to its facets.
        assert!((0.98 * depth - 1e-3..1.03 * depth + 2e-6).contains(&bound), "{bound} for {depth}");
    }
    let free = Pose::from_translation(Vector3::new(0.0, 0.0, 0.71));
    assert_eq!(a.penetration_depth(&b, &free), 0.0);
}

#[test]
fn the_shortest_way_out_ends_the_contact_and_is_near_the_depth() {
    let a = ExactMesh::new(&scene::cuboid([1.0; 3]));
    let b = ExactMesh::new(&scene::sphere(0.2, 3));
    for depth in [0.01, 0.1, 0.3] {
        let pose = Pose::from_translation(Vector3::new(0.0, 0.1, 0.7 - depth));
        let known = WayOut { direction: Vector3::x(), length: 0.8 };
        let found = a.shortest_way_out(&b, &pose, Touch::Solids, known);
        assert!((0.97 * depth..1.01 * depth).contains(&found.length), "{found:?} for {depth}");
        let out = Pose::from_translation(found.direction * found.length).after(&pose);
        assert!(!a.touches(&b, &out, Touch::Solids));
    }
    // Open sheets that cross have no inside: the shorter side is the way out.
    let sheet = ExactMesh::new(&scene::rectangle(1.0, 2.0));
    let upright = Pose::from_translation_rpy(
        Vector3::new(0.3, 0.0, 0.0),
        [0.0, 0.5 * std::f64::consts::PI, 0.0],
    );
    let known = WayOut { direction: Vector3::x(), length: 0.9 };
    let found = sheet.shortest_way_out(&sheet, &upright, Touch::Surfaces, known);
    assert!((found.length - 0.2).abs() < 1e-3, "{found:?}");
}

#[test]
fn poses_are_labelled_truly_and_half_are_near() {
    let (floor, object) = (scene::plate_with_hole(0.6, 0.3, 0.1), scene::wedge(0.2, 0.2, 0.3));
    let (scene, object_mesh) = (ExactMesh::new(&floor), ExactMesh::new(&object));
    let poses = poses_near_contact(&scene, &object_mesh, 40, 11);
    for p in &poses {
        let apart = brute::distance(&floor, &object, &p.scene_from_object);
        if p.in_collision {
            assert!(p.signed_distance < 0.0);
            assert!(scene.solids_overlap(&object_mesh, &p.scene_from_object));
        } else {
            assert!((p.signed_distance - apart).abs() < 1e-9 && apart > 0.0);
        }
    }
    let count =
        |test: &dyn Fn(f64) -> bool| poses.iter().filter(|p| test(p.signed_distance)).count();
    assert!(count(&|d| d.abs() <= 0.03) >= 20);
    assert!(count(&|d| d < 0.0) >= 10 && count(&|d| d > 0.0) >= 10);
    assert!(count(&|d| d > 0.03) >= 3 && count(&|d| d < -0.03) >= 3);
    assert_eq!(poses, poses_near_contact(&scene, &object_mesh, 40, 11));
}
