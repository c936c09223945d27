//! Meshes with an inside: watertight ones have one, open ones do not, two meshes are exact.

use crate::common::{MODES, Scan, ask, at, measured, mesh, prepare, uniform};
use cloudtouch::geom::{Point3, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::{Mode, Report, Verdict};
use cloudtouch_testkit::exact::{ExactMesh, brute};
use cloudtouch_testkit::{scene, surface};

/// A ball of 3 cm as a cloud: fits into every solid below.
fn small_ball(mode: Mode) -> Scan {
    prepare(measured(&scene::sphere(0.03, 2), 0.008, 0.001, 1), 0.001, mode)
}

fn solids() -> Vec<(&'static str, TriangleMesh)> {
    vec![
        ("box", scene::cuboid([0.4; 3])),
        ("ball", scene::sphere(0.2, 3)),
        ("peg", scene::peg(0.15, 0.5)),
    ]
}

/// The same triangles, each turned round.
fn inside_out(mesh: &TriangleMesh) -> TriangleMesh {
    let turned = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    TriangleMesh::new(mesh.vertices().to_vec(), turned).expect("the same vertices")
}

/// A box without its last face (two triangles): open.
fn open_box(side: f64) -> TriangleMesh {
    let whole = scene::cuboid([side; 3]);
    let kept = whole.triangles()[..10].to_vec();
    TriangleMesh::new(whole.vertices().to_vec(), kept).expect("ten triangles")
}

#[test]
fn a_cloud_wholly_inside_a_watertight_mesh_collides() {
    for mode in MODES {
        let cloud = small_ball(mode);
        for (name, solid) in solids() {
            let solid = mesh(&solid);
            assert!(solid.is_watertight(), "{name}");
            // In the middle: no point of the cloud is within 10 cm of the surface.
            let report = ask(mode, &cloud, &solid, &Pose::identity());
            assert_eq!(report.verdict, Verdict::InCollision, "{name} {mode:?}: {report:?}");
            let clearance = report.clearance_m.expect("a signed distance was computed");
            assert!(clearance.mean < -0.1, "{name} {mode:?}: {clearance:?}");
            // 60 cm away: beyond every one of the solids.
            let report = ask(mode, &cloud, &solid, &at(0.6, 0.0, 0.0));
            assert_eq!(report.verdict, Verdict::Free, "{name} {mode:?}: {report:?}");
        }
    }
}

#[test]
fn the_mesh_may_be_a_or_b() {
    for mode in MODES {
        let cloud = small_ball(mode);
        for (name, solid) in solids() {
            let solid = mesh(&solid);
            // From the middle out through the surface: inside, touching, outside.
            for x in [0.0, 0.1, 0.15, 0.17, 0.2, 0.23, 0.235, 0.24, 0.3, 0.5] {
                let pose = at(-x, 0.01, 0.02);
                let as_b = ask(mode, &cloud, &solid, &pose);
                let as_a = ask(mode, &solid, &cloud, &pose.inverse());
                let (p, q) = (as_b.collision_probability, as_a.collision_probability);
                // The stated tolerance; the paper's mode draws its descents by node pair, which
                // names the pair differently when swapped, so only its verdicts are compared.
                if mode == Mode::Calibrated {
                    assert!((p - q).abs() < 1e-3, "{name} at {x}: {p} and {q}");
                }
                assert_eq!(as_b.verdict, as_a.verdict, "{name} at {x} {mode:?}: {p} and {q}");
            }
        }
    }
}

/// Documented: an open mesh is a surface without an inside, so only its surface collides.
#[test]
fn an_open_mesh_has_no_inside() {
    let solid = mesh(&open_box(0.4));
    assert!(!solid.is_watertight());
    assert!(solid.signed_distance(&Point3::origin()) > 0.0);
    for mode in MODES {
        let cloud = small_ball(mode);
        let report = ask(mode, &cloud, &solid, &Pose::identity());
        assert_eq!(report.verdict, Verdict::Free, "{mode:?}: {report:?}");
        let report = ask(mode, &cloud, &solid, &at(0.0, 0.0, 0.2));
        assert_eq!(report.verdict, Verdict::InCollision, "through a face, {mode:?}: {report:?}");
    }
}

#[test]
fn signed_distances_agree_with_every_triangle_and_the_winding_number() {
    let shapes = [
        scene::torus(0.3, 0.1, 24),
        scene::plate_with_hole(0.4, 0.05, 0.1),
        scene::sphere(0.2, 2),
        scene::wedge(0.3, 0.2, 0.4),
        inside_out(&scene::cuboid([0.3, 0.2, 0.1])),
    ];
    for (k, shape) in shapes.iter().enumerate() {
        let (prepared, exact) = (mesh(shape), ExactMesh::new(shape));
        let (mut inside, mut outside) = (0, 0);
        for i in 0..300 {
            let draw = |axis: u64| uniform(seed::derive(7, k as u64, axis), i) - 0.5;
            let point = Point3::new(0.9 * draw(0), 0.9 * draw(1), 0.5 * draw(2));
            let distance = brute::point_distance(shape, &point);
            let contained = exact.contains(&point);
            let expected = if contained { -distance } else { distance };
            let found = prepared.signed_distance(&point);
            // Rounding of coordinates below one metre, a thousand times over.
            assert!((found - expected).abs() < 1e-12, "shape {k} at {point}: {found}, {expected}");
            if contained { inside += 1 } else { outside += 1 }
        }
        assert!(inside > 3 && outside > 100, "shape {k}: {inside} inside, {outside} outside");
    }
}

#[test]
fn signed_distance_of_what_is_not_a_point_is_not_a_number() {
    let ball = mesh(&scene::sphere(0.2, 2));
    assert!(ball.signed_distance(&Point3::new(0.0, f64::NAN, 0.0)).is_nan());
    assert!(ball.signed_distance(&Point3::new(f64::INFINITY, 0.0, 0.0)).is_nan());
}

#[test]
fn a_mesh_turned_inside_out_is_repaired() {
    for (name, solid) in solids() {
        let turned = mesh(&inside_out(&solid));
        let plain = mesh(&solid);
        assert!(turned.is_watertight());
        assert!(turned.signed_distance(&Point3::origin()) < 0.0, "{name}");
        for mode in MODES {
            let cloud = small_ball(mode);
            for x in [0.0, 0.18, 0.5] {
                let one = ask(mode, &cloud, &turned, &at(x, 0.0, 0.0));
                let other = ask(mode, &cloud, &plain, &at(x, 0.0, 0.0));
                assert_eq!(one.verdict, other.verdict, "{name} at {x} {mode:?}");
            }
        }
    }
}

/// A slab with a ball over it, and a small box at random poses around them, with the truth: whether
/// the solids overlap.
fn random_mesh_pairs(mut check: impl FnMut(&Report, &[TriangleMesh; 2], &Pose, bool)) {
    let table = scene::assemble([
        scene::cuboid([0.3, 0.3, 0.02]),
        scene::moved(&scene::sphere(0.08, 2), &at(0.05, 0.0, 0.15)),
    ]);
    let shapes = [table, scene::cuboid([0.1, 0.06, 0.03])];
    let exact = shapes.each_ref().map(ExactMesh::new);
    let prepared = shapes.each_ref().map(mesh);
    for i in 0..200 {
        let draw = |axis: u64| uniform(seed::derive(8, 0, axis), i) - 0.5;
        let offset = Vector3::new(0.5 * draw(0), 0.5 * draw(1), 0.5 * draw(2));
        let rpy = [6.0 * draw(3), 3.0 * draw(4), 6.0 * draw(5)];
        let pose = Pose::from_translation_rpy(offset, rpy);
        let report = ask(Mode::Calibrated, &prepared[0], &prepared[1], &pose);
        check(&report, &shapes, &pose, exact[0].solids_overlap(&exact[1], &pose));
    }
}

#[test]
fn two_meshes_are_judged_exactly() {
    let (mut free, mut hit) = (0, 0);
    random_mesh_pairs(|report, _, pose, overlap| {
        if overlap {
            hit += 1;
            assert_eq!(report.verdict, Verdict::InCollision, "{pose:?}");
            assert_eq!(report.collision_probability, 1.0);
        } else {
            free += 1;
            assert_eq!(report.verdict, Verdict::Free, "{pose:?}");
            assert_eq!(report.bounds, [0.0, 0.0]);
        }
    });
    assert!(free > 30 && hit > 30, "{free} free, {hit} in collision: a one-sided test");
}

#[test]
fn the_clearance_of_two_meshes_is_their_distance() {
    random_mesh_pairs(|report, [table, object], pose, overlap| {
        if overlap {
            return;
        }
        let gap = report.clearance_m.expect("two meshes have a distance");
        let truth = brute::distance(table, object, pose);
        // The library's distance ends within about 1e-7 of the size.
        assert!((gap.mean - truth).abs() < 1e-6, "{} not {truth}", gap.mean);
        assert_eq!(gap.std, 0.0);
    });
}

#[test]
fn a_mesh_inside_a_mesh_collides_both_ways() {
    let (outer, inner) = (mesh(&scene::cuboid([0.4; 3])), mesh(&scene::sphere(0.05, 2)));
    for mode in MODES {
        let pose = at(0.05, 0.0, 0.0);
        assert_eq!(ask(mode, &outer, &inner, &pose).verdict, Verdict::InCollision);
        assert_eq!(ask(mode, &inner, &outer, &pose.inverse()).verdict, Verdict::InCollision);
        assert_eq!(ask(mode, &outer, &inner, &at(0.5, 0.0, 0.0)).verdict, Verdict::Free);
    }
    // A shell without a lid contains nothing, and the ball does not reach its walls.
    let open = mesh(&open_box(0.4));
    assert_eq!(ask(Mode::Calibrated, &open, &inner, &Pose::identity()).verdict, Verdict::Free);
}

#[test]
fn samples_of_the_mesh_itself_are_in_contact_with_it() {
    let ball = scene::sphere(0.2, 3);
    let points = surface::positions(&surface::sample_surface(&ball, 300, 9));
    let solid = mesh(&ball);
    for mode in MODES {
        let cloud = prepare(points.clone(), 0.002, mode);
        let report = ask(mode, &cloud, &solid, &Pose::identity());
        // Each point is on the surface, a coin toss to either side: never free.
        assert_ne!(report.verdict, Verdict::Free, "{mode:?}: {report:?}");
    }
}

/// Samples 7 mm apart reach as far along their sheet as they are deep inside: what parts them from the
/// surface above was counted against their being inside, and they read free.
#[test]
fn a_coarse_sheet_within_a_slab_is_not_free() {
    let slab = mesh(&scene::cuboid([0.6, 0.4, 0.03]));
    let sheet = (0..100).map(|i| {
        let [x, y] = [i % 10, i / 10].map(|k| 0.007 * (f64::from(k) - 4.5));
        Point3::new(x, y, 0.0)
    });
    for std in [0.0005, 0.002] {
        let cloud = prepare(sheet.clone().collect(), std, Mode::Calibrated);
        let mut last = 1.0;
        for depth in [0.015, 0.01, 0.005, 0.003] {
            let report = ask(Mode::Calibrated, &slab, &cloud, &at(0.0, 0.0, 0.015 - depth));
            let p = report.collision_probability;
            assert!(report.verdict != Verdict::Free && p <= last, "{std}, {depth}: {report:?}");
            assert!(p > if depth > 0.008 { 0.95 } else { 0.4 }, "{std}, {depth}: {p}");
            last = p;
        }
        let outside = ask(Mode::Calibrated, &slab, &cloud, &at(0.0, 0.0, 0.045));
        assert_eq!(outside.verdict, Verdict::Free);
    }
}
