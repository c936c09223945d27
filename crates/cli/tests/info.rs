//! `cloudtouch info`: clouds and meshes.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support;
use crate::support::Inputs;
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};

#[test]
fn counts_what_a_cloud_holds() {
    let inputs = Inputs::new();
    let mut cloud = support::floor();
    cloud.points.push(cloud.points[0]);
    cloud.points.push(Point3::new(f64::NAN, 0.0, 0.0));
    cloudtouch_io::write_cloud_pcd(inputs.path("cloud.pcd"), &cloud).unwrap();
    let text = inputs.run(&["info", "cloud.pcd"]).quiet(0).stdout();
    for expected in ["rows        443", "missing     1 ", "duplicates  1\n", "sensor "] {
        assert!(text.contains(expected), "`{expected}` is not in\n{text}");
    }
    let spacing = text.lines().find_map(|line| line.strip_prefix("spacing")).unwrap();
    let millimetres: f64 = spacing.split_whitespace().next().unwrap().parse().unwrap();
    assert!((45.0..55.0).contains(&millimetres), "{spacing}, where points are 50 mm apart");
}

/// Rows of the largest float made its box 3.4e38 m large, and a laser of the sensor.
#[test]
fn placeholders_of_missing_returns_are_not_in_the_box() {
    let inputs = Inputs::new();
    let mut cloud = support::floor();
    cloud.points.extend([Point3::new(1.0, 1.0, 1.0) * f64::from(f32::MAX); 3]);
    cloudtouch_io::write_cloud_pcd(inputs.path("cloud.pcd"), &cloud).unwrap();
    let text = inputs.run(&["info", "cloud.pcd"]).quiet(0).stdout();
    let expected = ["missing     3 ", "(-0.500, -0.500, 0.000) to (0.500, 0.500, 0.000) m", "iso:"];
    assert!(expected.iter().all(|part| text.contains(part)), "{text}");
}

#[test]
fn a_cloud_without_any_return_is_no_error() {
    let inputs = Inputs::new();
    let cloud = PointCloud::from_points(vec![Point3::new(f64::NAN, 0.0, 0.0); 3]);
    cloudtouch_io::write_cloud_pcd(inputs.path("nan.pcd"), &cloud).unwrap();
    let text = inputs.run(&["info", "nan.pcd"]).quiet(0).stdout();
    assert!(text.contains("missing     3 "), "{text}");
    // Nothing was said of it.
    assert!(text.contains("box         none: no row is a point"), "{text}");
}

/// A box of 100000000000000000000 m was told, and a sensor that suits it.
#[test]
fn coordinates_that_every_query_refuses_were_passed_over() {
    let inputs = Inputs::new();
    inputs.write("far.xyz", "0 0 1\nnan 0 0\n1 0 1\n1e20 2 3\n-1e11 0 0\n");
    let text = inputs.run(&["info", "far.xyz"]).quiet(0).stdout();
    assert!(text.contains("too far     2 of 5 rows beyond 1e10 m"), "{text}");
    assert!(text.contains("the first of them row 4:") && !text.contains("sensor"), "{text}");
    inputs.write("far.obj", "v 0 0 0\nv 1e20 0 0\nv 0 1 0\nf 1 2 3\n");
    let text = inputs.run(&["info", "far.obj"]).quiet(0).stdout();
    assert!(text.contains("surface     refused: ") && text.contains("beyond 1e10 m"), "{text}");
}

#[test]
fn says_whether_a_mesh_is_closed_and_which_unit_it_may_have() {
    let inputs = Inputs::new();
    let text = inputs.run(&["info", "box.obj"]).quiet(0).stdout();
    assert!(text.contains("watertight") && !text.contains("--unit"), "{text}");
    cloudtouch_io::write_mesh_obj(inputs.path("mm.obj"), &support::cube(100.0)).unwrap();
    let text = inputs.run(&["info", "mm.obj"]).quiet(0).stdout();
    assert!(text.contains("--unit mm"), "{text}");
    let text = inputs.run(&["info", "mm.obj", "--unit", "mm"]).quiet(0).stdout();
    assert!(text.contains("(-0.100, -0.100, -0.100)") && !text.contains("--unit"), "{text}");
    inputs.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let text = inputs.run(&["info", "open.obj"]).quiet(0).stdout();
    assert!(text.contains("open: 3 edges"), "{text}");
}

/// Two boxes that share an edge were called open, and only their surface to collide, where what is inside
/// collides too.
#[test]
fn closed_parts_that_touch_are_not_called_open() {
    let inputs = Inputs::new();
    let cube = support::cube(0.1);
    let corner = |by: f64| move |p: &Point3| p + Vector3::new(by, by, 0.0);
    let vertices = [0.0, 0.2].iter().flat_map(|&by| cube.vertices().iter().map(corner(by)));
    let count = cube.vertices().len() as u32;
    let second = cube.triangles().iter().map(|t| t.map(|i| i + count));
    let triangles = cube.triangles().iter().copied().chain(second);
    let steps = TriangleMesh::new(vertices.collect(), triangles.collect()).unwrap();
    cloudtouch_io::write_mesh_obj(inputs.path("steps.obj"), &steps).unwrap();
    let text = inputs.run(&["info", "steps.obj"]).stdout();
    assert!(
        text.contains("closed: inside and outside are defined; its parts touch along"),
        "{text}"
    );
    let text = inputs.run(&["query", "steps.obj", "box.obj"]).stdout();
    assert!(text.contains("scene: closed mesh of 24 triangles"), "{text}");
    assert!(text.contains("verdict                in collision"), "{text}");
}

/// Only meshes were told that they may be in millimetres.
#[test]
fn a_cloud_in_millimetres_was_laser_scanned_from_afar() {
    let inputs = Inputs::new();
    let mut cloud = support::floor();
    cloud.points.iter_mut().for_each(|point| point.coords *= 1000.0);
    cloudtouch_io::write_cloud_pcd(inputs.path("mm.pcd"), &cloud).unwrap();
    let text = inputs.run(&["info", "mm.pcd"]).quiet(0).stdout();
    assert!(text.contains("\nunit        1414 m across and 51.2 m from point to point"), "{text}");
    assert!(
        text.contains("--cloud-unit mm, or cm?") && text.contains("spacing     51.17 m"),
        "{text}"
    );
    for (file, options) in [("mm.pcd", &["--cloud-unit", "mm"][..]), ("floor.pcd", &[])] {
        let text = inputs.run(&[&["info", file], options].concat()).quiet(0).stdout();
        assert!(!text.contains("unit  "), "{text}");
    }
    // An airborne scan, in the coordinates of its map.
    cloud.points.iter_mut().for_each(|point| point.coords.x += 4e5);
    cloudtouch_io::write_cloud_pcd(inputs.path("map.pcd"), &cloud).unwrap();
    assert!(!inputs.run(&["info", "map.pcd"]).quiet(0).stdout().contains("unit  "));
}

#[test]
fn a_mesh_of_one_collapsed_face_was_watertight() {
    let inputs = Inputs::new();
    inputs.write("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
    let text = inputs.run(&["info", "point.obj"]).quiet(0).stdout();
    assert!(text.contains("no triangle has an area") && !text.contains("watertight"), "{text}");
}

/// It was an error (1), where a query calls it a wrong use (2).
#[test]
fn a_unit_of_the_other_kind_of_file_is_refused() {
    let inputs = Inputs::new();
    for (file, option, other) in
        [("floor.pcd", "--unit", "--cloud-unit"), ("box.obj", "--cloud-unit", "--unit")]
    {
        let run = inputs.run(&["info", file, option, "mm"]);
        assert_eq!(run.code(), 2);
        assert!(run.stderr().contains(other), "{}", run.stderr());
    }
}

/// Whoever followed it left out surface: a plate about the origin, of which no sensor was known, read free.
#[test]
fn points_at_the_origin_of_any_cloud_were_called_no_returns() {
    let inputs = Inputs::new();
    let points =
        (0..400).map(|i| Point3::new(0.01 * f64::from(i % 20), 0.01 * f64::from(i / 20), 0.0));
    let mut cloud = PointCloud::from_points(points.collect());
    let told = |cloud: &PointCloud| {
        cloudtouch_io::write_cloud_pcd(inputs.path("plate.pcd"), cloud).unwrap();
        inputs.run(&["info", "plate.pcd"]).quiet(0).stdout()
    };
    let text = told(&cloud);
    assert!(text.contains("at origin   ") && text.contains("surface, unless"), "{text}");
    assert!(!text.contains("no returns"), "{text}");
    cloud.sensor_pose = Some(Pose::from_translation(Vector3::new(0.0, 0.0, 0.05)));
    let text = told(&cloud);
    assert!(text.contains("near sensor ") && text.contains("surface, unless"), "{text}");
    assert!(text.contains("--min-range 0.1") && !text.contains("no returns"), "{text}");
    // Only rows and columns show that the sensor was there.
    cloud.image_size = Some((20, 20));
    let text = told(&cloud);
    assert!(text.contains("too near    ") && text.contains("no returns"), "{text}");
}
