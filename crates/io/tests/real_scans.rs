//! Real scans and meshes of other people, where they are at hand: what must be found in them.
//!
//! They are looked for in the folder `CLOUDTOUCH_DATA`, else in `shared/data` beside the workspace.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use cloudtouch_geom::{Point3, PointCloud};
use cloudtouch_io::{Geometry, LengthUnit, read_cloud, read_geometry, read_mesh};

/// The folder with the data, unless it is not there, which is then said.
fn data_folder() -> Option<PathBuf> {
    let folder = std::env::var_os("CLOUDTOUCH_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    if folder.join("clouds").is_dir() && folder.join("meshes").is_dir() {
        return Some(folder);
    }
    println!("skipped: no clouds and meshes in {} (set CLOUDTOUCH_DATA)", folder.display());
    None
}

/// The lowest and highest corner agree to half a unit of the last digit given.
fn assert_box(name: &str, found: Option<(Point3, Point3)>, expected: [[f64; 3]; 2], half: f64) {
    let (low, high) = found.unwrap();
    for (found, expected) in [(low, expected[0]), (high, expected[1])] {
        let difference = (found - Point3::from(expected)).amax();
        assert!(difference <= half * (1.0 + 1e-6), "{name}: {found} is not {expected:?}");
    }
}

fn finite_points(cloud: &PointCloud) -> impl Iterator<Item = &Point3> {
    cloud.points.iter().filter(|p| p.iter().all(|v| v.is_finite()))
}

/// Finite, missing and repeated points, box.
type CloudFacts = (&'static str, usize, usize, usize, [[f64; 3]; 2]);

#[rustfmt::skip]
const CLOUDS: [CloudFacts; 10] = [
    ("colored_cloud", 1_000, 0, 0, [[-0.887, -0.651, 0.882], [0.489, -0.375, 1.532]]),
    ("lamppost", 1_771, 0, 14, [[-11.172, -0.375, -5.448], [-9.766, 0.594, 0.467]]),
    ("min_cut_segmentation_tutorial", 9_311, 0, 10, [[64.799, -22.189, -0.100], [72.799, -14.929, 1.680]]),
    ("mosd_learn20", 194_137, 113_063, 0, [[-0.446, -0.417, 0.561], [0.488, 0.281, 1.396]]),
    ("mosd_learn40", 172_285, 134_915, 0, [[-0.599, -0.416, 0.629], [0.338, 0.293, 1.657]]),
    ("object_template_2", 1_301, 0, 0, [[-0.193, 0.032, 0.696], [-0.015, 0.214, 0.801]]),
    ("office1_keypoints", 1_318, 0, 39, [[-10.988, -8.770, -1.362], [10.131, 5.908, 2.178]]),
    ("room_scan1", 112_586, 0, 56_427, [[-13.800, -6.493, -1.352], [15.447, 7.980, 1.709]]),
    ("samp11-utm", 38_010, 0, 213, [[512_700.88, 5_403_547.50, 295.250], [512_834.75, 5_403_850.00, 404.080]]),
    ("table_scene_mug_stereo_textured", 209_280, 97_920, 0, [[-0.456, -0.511, 0.690], [0.715, 0.179, 2.593]]),
];

#[test]
fn clouds_hold_what_is_known_of_them() {
    let Some(folder) = data_folder() else { return };
    for (name, finite, missing, repeated, corners) in CLOUDS {
        let cloud = read_cloud(folder.join(format!("clouds/{name}.pcd"))).unwrap();
        assert_eq!(finite_points(&cloud).count(), finite, "{name}");
        assert_eq!(cloud.len() - finite, missing, "{name}");
        let distinct: BTreeSet<[u64; 3]> = finite_points(&cloud)
            .map(|p| [p.x + 0.0, p.y + 0.0, p.z + 0.0].map(f64::to_bits))
            .collect();
        assert_eq!(finite - distinct.len(), repeated, "{name}");
        let half = if name == "samp11-utm" { 0.005 } else { 0.0005 };
        assert_box(name, cloud.bounding_box(), corners, half);
        assert_eq!(cloud.image_size, (missing > 0).then_some((640, 480)), "{name}");
        assert_eq!(cloud.sensor_origin(), Point3::origin(), "{name}");
        assert!(cloud.covariances.is_none(), "{name}");
    }
}

/// Unit, triangles, edges that do not join two of them, box in that unit.
type MeshFacts = (&'static str, LengthUnit, usize, usize, [[f64; 3]; 2]);

const PIANO: [[f64; 3]; 2] = [[-0.5, -0.605, -0.425], [0.5, 0.605, 0.425]];
const ROOM: [[f64; 3]; 2] = [[-3.0045, -3.0045, -0.0145], [2.9875, 3.0045, 2.9875]];
const GRIPPER: [[f64; 3]; 2] = [[0.029, -0.065, -0.028], [0.196, 0.065, 0.028]];
const HAND: [[f64; 3]; 2] = [[-0.032, -0.104, -0.026], [0.032, 0.100, 0.112]];

const MESHES: [MeshFacts; 11] = [
    ("panda_hand.obj", LengthUnit::Metres, 324, 0, HAND),
    ("piano_closed_m.stl", LengthUnit::Metres, 278, 0, PIANO),
    // 96 edges of one triangle, and 27 at which four or eight meet.
    ("piano_m.stl", LengthUnit::Metres, 216, 123, PIANO),
    ("piano_mm.obj", LengthUnit::Millimetres, 216, 123, PIANO),
    ("pr2_gripper.obj", LengthUnit::Metres, 7_240, 0, GRIPPER),
    ("pr2_gripper.ply", LengthUnit::Metres, 7_240, 0, GRIPPER),
    ("pr2_gripper.stl", LengthUnit::Metres, 7_240, 0, GRIPPER),
    ("pr2_gripper_lowres.stl", LengthUnit::Metres, 1_330, 0, GRIPPER),
    ("room_hull_m.stl", LengthUnit::Metres, 36, 0, ROOM),
    ("room_m.stl", LengthUnit::Metres, 2_180, 1_856, ROOM),
    ("room_mm.obj", LengthUnit::Millimetres, 2_180, 1_856, ROOM),
];

#[test]
fn meshes_hold_what_is_known_of_them() {
    let Some(folder) = data_folder() else { return };
    for (name, unit, triangles, open_edges, corners) in MESHES {
        let path = folder.join("meshes").join(name);
        let mesh = read_mesh(&path, unit).unwrap();
        assert_eq!(mesh.triangles().len(), triangles, "{name}");
        assert_eq!(mesh.merged().open_edges(), open_edges, "{name}");
        assert_box(name, mesh.bounding_box(), corners, 0.0005);
        assert_eq!(read_geometry(&path, unit).unwrap(), Geometry::Mesh(mesh), "{name}");
    }
    for name in ["palm", "l_finger", "l_finger_tip", "r_finger", "r_finger_tip"] {
        let path = folder.join(format!("meshes/pr2_gripper_parts/{name}.stl"));
        let mesh = read_mesh(path, LengthUnit::Metres).unwrap();
        assert_eq!(mesh.merged().open_edges(), 0, "{name}");
    }
}
