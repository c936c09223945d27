//! The depth camera sees what is there, with noise as stated and veils at edges only.

use cloudtouch_geom::{Pose, Vector3};
use cloudtouch_testkit::{
    camera::DepthCamera,
    exact::{ExactMesh, brute},
    scene,
};

/// A box of 0.4 m, 1.8 m ahead of the camera, before a wall at 3 m that fills part of the view.
fn view() -> (ExactMesh, ExactMesh) {
    let ahead = |z: f64| Pose::from_translation(Vector3::new(0.0, 0.0, z));
    (
        ExactMesh::new(&scene::moved(&scene::cuboid([0.4; 3]), &ahead(2.0))),
        ExactMesh::new(&scene::moved(&scene::plane_patch(2.0), &ahead(3.0))),
    )
}

#[test]
fn without_noise_every_return_lies_on_a_surface_and_the_rest_is_nan() {
    let (block, wall) = view();
    let camera = DepthCamera {
        depth_std: 0.0,
        depth_std_growth: 0.0,
        veil_probability: 0.0,
        ..DepthCamera::default()
    };
    let cloud = camera.scan(&[&block, &wall], &Pose::identity(), 1);
    assert_eq!(cloud.image_size, Some((160, 120)));
    assert_eq!(cloud.len(), 160 * 120);
    let returns: Vec<_> = cloud.points.iter().filter(|p| p.z.is_finite()).collect();
    assert!(returns.len() > 5_000 && returns.len() < cloud.len());
    for p in &returns {
        let off = brute::point_distance(block.mesh(), p).min(brute::point_distance(wall.mesh(), p));
        assert!(off < 1e-9, "{off:e} m off");
    }
    assert!((cloud.points[60 * 160 + 80].z - 1.8).abs() < 1e-9, "the front of the box");
    assert!(cloud.points[0].iter().all(|v| v.is_nan()), "past the wall's rim");
}

#[test]
fn noise_grows_with_depth_as_stated() {
    let camera = DepthCamera { veil_probability: 0.0, ..DepthCamera::default() };
    let wall = ExactMesh::new(&scene::plane_patch(20.0));
    for z in [1.0, 3.0] {
        let back = Pose::from_translation(Vector3::new(0.0, 0.0, -z));
        let cloud = camera.scan(&[&wall], &back, 2);
        let n = cloud.len() as f64;
        let std = (cloud.points.iter().map(|p| (p.z - z).powi(2)).sum::<f64>() / n).sqrt();
        // Five standard errors of a standard deviation from n values.
        let tolerance = 5.0 / (2.0 * n).sqrt();
        assert!((std / camera.std_at(z) - 1.0).abs() < tolerance, "{std} at {z} m");
    }
}

#[test]
fn veils_hang_between_the_two_sides_of_an_edge() {
    let (block, wall) = view();
    let camera = DepthCamera { depth_std: 0.0, depth_std_growth: 0.0, ..DepthCamera::default() };
    let cloud = camera.scan(&[&block, &wall], &Pose::identity(), 3);
    let between = cloud.points.iter().filter(|p| p.z > 1.81 && p.z < 2.99).count();
    // About 31 pixels a side, edges seen from right and below: 4 × 31 pixels, 3 in 10 veiled.
    assert!((15..80).contains(&between), "{between} veil points");
    assert_eq!(cloud.points.iter().filter(|p| p.z < 1.79 || p.z > 3.01).count(), 0);
}
