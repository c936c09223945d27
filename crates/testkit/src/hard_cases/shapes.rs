//! Shapes that no plane separates, or that touch in a point.

use cloudtouch_geom::{Point3, TriangleMesh, seed};

use super::case::{HardCase, crossing, patch};
use crate::{
    random::normal_vector,
    scene,
    surface::{positions, sample_surface},
};

pub(super) fn shapes() -> Vec<HardCase> {
    let cloud = |mesh: &TriangleMesh, count: usize, seed: u64| {
        positions(&sample_surface(mesh, count, seed))
    };
    let ring = scene::torus(0.3, 0.06, 48);
    let ring_points = cloud(&ring, 1500, 5);
    // Turned into the xz plane and through the middle of the tube's circle.
    let linked = cloud(&ring, 1500, 6).iter().map(|p| Point3::new(p.x + 0.3, p.z, p.y)).collect();
    let plate = scene::plate_with_hole(0.4, 0.04, 0.10);
    let tip = |sign: f64, seed: u64| {
        let wedge = cloud(&scene::wedge(0.2, 0.2, 0.0001), 399, seed);
        let mut points: Vec<_> = wedge.iter().map(|p| Point3::new(p.x, p.y, sign * p.z)).collect();
        points.push(Point3::origin());
        points
    };
    let blob = |seed: u64, x: f64| {
        let mut rng = seed::generator(seed);
        (0..200)
            .map(|_| Point3::new(x, 0.0, 0.0) + normal_vector(&mut rng) * 0.05)
            .collect::<Vec<_>>()
    };
    vec![
        HardCase::new("linked-tori", "separable by a curved surface only", ring_points, linked)
            .collides(false),
        HardCase::new(
            "peg-in-hole",
            "2 cm of clearance all around: no plane separates them",
            cloud(&plate, 1500, 7),
            cloud(&scene::peg(0.08, 0.3), 1500, 8),
        )
        .collides(false),
        crossing("crossing-sheets", "each leaf sees a cross, not two sides"),
        HardCase::new("touching-tips", "contact in a single point", tip(1.0, 9), tip(-1.0, 10))
            .collides(true),
        HardCase::new(
            "thin-slab",
            "two faces 2 cm apart must not be averaged; the other cloud lies 3 cm above the upper",
            cloud(&scene::thin_slab(0.2), 400, 11),
            patch(0.04, 200, 12),
        )
        .collides(false),
        HardCase::new(
            "blobs",
            "no surface at all, only volume; classes overlap",
            blob(13, 0.0),
            blob(14, 0.05),
        ),
    ]
}
