//! Every solid is closed and outward, and refinement keeps the surface.

use cloudtouch_geom::{Pose, TriangleMesh, Vector3};
use cloudtouch_testkit::{
    exact::{ExactMesh, brute},
    scene,
    surface::{area, sample_surface, volume},
};

fn solids() -> Vec<(&'static str, TriangleMesh, f64)> {
    let pi = std::f64::consts::PI;
    let polygon = 16.0 * (pi / 16.0).sin();
    vec![
        ("sphere", scene::sphere(0.5, 4), pi / 6.0),
        ("box", scene::cuboid([0.1, 0.2, 0.3]), 0.006),
        ("slab", scene::thin_slab(1.0), 0.02),
        ("wedge", scene::wedge(0.2, 0.3, 0.5), 0.015),
        ("torus", scene::torus(0.3, 0.1, 128), 2.0 * pi * pi * 0.3 * 0.01),
        ("peg", scene::peg(0.1, 0.4), polygon * 0.01 * 0.4),
        ("plate", scene::plate_with_hole(0.4, 0.02, 0.1), (0.16 - polygon * 0.01) * 0.02),
    ]
}

#[test]
fn solids_are_closed_and_enclose_their_volume() {
    for (name, mesh, expected) in solids() {
        assert_eq!(mesh.open_edges(), 0, "{name}");
        let error = volume(&mesh) / expected - 1.0;
        // The curved ones are inscribed polyhedra: a little less.
        assert!((-0.01..1e-9).contains(&error), "{name}: volume off by {error:e}");
    }
}

#[test]
fn furniture_is_closed_and_outward() {
    for (name, mesh) in [("piano", scene::piano()), ("room", scene::room())] {
        assert_eq!(mesh.open_edges(), 0, "{name}");
        assert_eq!(mesh.merged().open_edges(), 0, "{name} merged");
        assert!(volume(&mesh) > 0.1, "{name}: {}", volume(&mesh));
        assert!(mesh.triangles().len() < 800, "{name}: {}", mesh.triangles().len());
    }
}

#[test]
fn components_of_a_scene_keep_apart() {
    for mesh in [scene::piano(), scene::room()] {
        // A triangle meets only triangles it shares a vertex with.
        for s in 0..mesh.triangles().len() {
            for t in 0..s {
                let neighbours =
                    mesh.triangles()[s].iter().any(|i| mesh.triangles()[t].contains(i));
                assert!(
                    neighbours || !brute::triangles_cross(&mesh.corners(s), &mesh.corners(t)),
                    "triangles {s} {:?} and {t} {:?} cross",
                    mesh.corners(s),
                    mesh.corners(t)
                );
            }
        }
    }
}

#[test]
fn refined_scenes_have_about_ten_thousand_triangles_and_the_same_surface() {
    for (name, coarse, max_edge) in [("piano", scene::piano(), 0.13), ("room", scene::room(), 0.42)]
    {
        let fine = scene::subdivide_to_max_edge(&coarse, max_edge);
        let count = fine.triangles().len();
        assert!((7_000..14_000).contains(&count), "{name}: {count}");
        assert_eq!(fine.open_edges(), 0, "{name}");
        assert!((area(&fine) / area(&coarse) - 1.0).abs() < 1e-12, "{name}");
        assert!((volume(&fine) / volume(&coarse) - 1.0).abs() < 1e-9, "{name}");
        let longest = (0..count)
            .flat_map(|t| {
                let [a, b, c] = fine.corners(t);
                [(a - b).norm(), (b - c).norm(), (c - a).norm()]
            })
            .fold(0.0, f64::max);
        assert!(longest <= max_edge, "{name}: {longest}");
    }
}

#[test]
fn the_piano_fits_in_the_room() {
    let (room, piano) = (ExactMesh::new(&scene::room()), ExactMesh::new(&scene::piano()));
    let standing = Pose::from_translation(Vector3::new(0.0, 0.0, 0.01));
    let gap = room.distance(&piano, &standing);
    assert!((gap - 0.01).abs() < 1e-9 && !room.solids_overlap(&piano, &standing), "{gap}");
}

#[test]
fn samples_lie_on_their_triangles_and_spread_by_area() {
    let mesh = scene::cuboid([1.0, 1.0, 0.1]);
    let samples = sample_surface(&mesh, 2400, 3);
    for s in &samples {
        let corners = mesh.corners(s.triangle);
        assert!(brute::point_triangle_distance(&s.position, &corners) < 1e-12);
        assert!((s.normal.norm() - 1.0).abs() < 1e-12);
        assert!((s.position - corners[0]).dot(&s.normal).abs() < 1e-12);
        assert!(s.position.coords.dot(&s.normal) > 0.0, "the normal points outward");
    }
    // Stratified: the top has its 1000 of 2400 points, give or take the piece at either end.
    let top = samples.iter().filter(|s| s.normal.z > 0.5).count();
    assert!((998..=1002).contains(&top), "{top}");
}
