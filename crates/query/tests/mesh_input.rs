//! What meshes as files have them may hold: vertices that no face uses, and faces of any size.

use crate::common::{AnyQuery, ask, at, measured, mesh, prepare};
use cloudtouch::geom::{Point3, TriangleMesh};
use cloudtouch::{Mode, Safeguards, Verdict};
use cloudtouch_testkit::scene;

/// The mesh with one more vertex, which no face uses.
fn with_unused(mesh: &TriangleMesh, vertex: Point3) -> TriangleMesh {
    let vertices = mesh.vertices().iter().copied().chain([vertex]).collect();
    TriangleMesh::new(vertices, mesh.triangles().to_vec()).expect("the same triangles")
}

#[test]
fn meshes_four_metres_apart_collided_by_a_vertex_that_no_face_uses() {
    let cube = scene::cuboid([1.0; 3]);
    let astray = mesh(&with_unused(&cube, Point3::new(4.0, 0.0, 0.0)));
    let plain = mesh(&cube);
    for (a, b, x) in [(&plain, &astray, -4.0), (&astray, &plain, 4.0), (&plain, &plain, 4.0)] {
        let report = ask(Mode::Calibrated, a, b, &at(x, 0.0, 0.0));
        assert_eq!(report.verdict, Verdict::Free, "{report:?}");
        let gap = report.clearance_m.expect("two meshes have a distance").mean;
        assert!((gap - 3.0).abs() < 1e-6, "{gap}");
    }
    assert!((astray.size() - plain.size()).abs() < 1e-12, "{} m", astray.size());
}

#[test]
fn a_vertex_that_is_not_a_number_and_that_no_face_uses_refused_the_mesh() {
    let cube = scene::cuboid([1.0; 3]);
    for value in [f64::NAN, f64::INFINITY, 1e300] {
        let cube = mesh(&with_unused(&cube, Point3::new(0.0, value, 0.0)));
        assert!((cube.signed_distance(&Point3::origin()) + 0.5).abs() < 1e-12, "{value}");
    }
}

/// Some 400 points with 2 mm of noise on a ground of two triangles: in contact, whatever the size of
/// the ground, or as likely as not: a sheet on itself crosses it nowhere. Its parts ended at a billionth of its edges, metres long, with no corner near.
#[test]
fn a_ground_that_reaches_a_million_kilometres_was_not_there() {
    for size in [1e9, 8e9] {
        let corners = [(-size, -size), (size, -size), (size, size), (-size, size)];
        let vertices = corners.map(|(x, y)| Point3::new(x, y, 0.0)).to_vec();
        let ground = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]);
        let ground = mesh(&ground.expect("two triangles"));
        let clouds = [7, 8, 9, 10].map(|seed| {
            let patch = measured(&scene::plane_patch(0.2), 0.01, 0.002, seed);
            assert!((300..500).contains(&patch.len()), "{} points", patch.len());
            prepare(patch, 0.002, Mode::Calibrated)
        });
        let on_it = at(37.3, -11.9, 0.0);
        let asked = |cloud| ask(Mode::Calibrated, &ground, cloud, &on_it).collision_probability;
        let probabilities = clouds.each_ref().map(asked);
        let mean = probabilities.iter().sum::<f64>() / 4.0;
        assert!(mean > 0.3, "{size} m: {probabilities:?}");
        // Such a ground is doubted unless it is meant.
        let trusting = Safeguards { doubt_units: false, ..Safeguards::default() };
        let query = AnyQuery::with(Mode::Calibrated, |by| by.safeguards = trusting, |_| {});
        let above = query.run(&ground, &clouds[0], &at(37.3, -11.9, 0.05)).expect("a good pose");
        assert_eq!(above.verdict, Verdict::Free, "over {size} m: {above:?}");
    }
}
