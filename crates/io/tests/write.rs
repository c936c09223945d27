//! Written files: the same bits come back, the same bytes go out, nothing is left half written.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::{fs, io};

use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch_io::{
    LengthUnit, WriteError, read_cloud, read_mesh, write_atomically, write_cloud_pcd,
    write_cloud_ply, write_colored_ply, write_mesh_obj,
};
use proptest::prelude::*;
use tempfile::TempDir;

/// Any bits a coordinate can have, a plain number more often than not.
fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1e7..1e7_f64, 1 => any::<u64>().prop_map(f64::from_bits), 1 => Just(f64::NAN)]
}

fn any_covariance() -> impl Strategy<Value = Covariance> {
    prop::array::uniform9(-1.0..1.0_f64).prop_map(|entries| {
        let root = Matrix3::from_row_slice(&entries);
        Covariance::from_symmetric(&(root * root.transpose() + Matrix3::identity() * 1e-3))
    })
}

fn any_cloud() -> impl Strategy<Value = PointCloud> {
    let size =
        prop_oneof![Just((0, 1)), (1..40_usize).prop_map(|w| (w, 1)), (2..7_usize, 2..7_usize)];
    let origin = prop::array::uniform3(-1e6..1e6_f64);
    let turn = prop::array::uniform3(-3.0..3.0_f64);
    let is_turned = prop::bool::weighted(0.8);
    (size, any::<bool>(), origin, turn, is_turned).prop_flat_map(
        |((width, height), with_covariances, origin, turn, is_turned)| {
            let rows = prop::collection::vec(
                (prop::array::uniform3(any_value()), any_covariance()),
                width * height,
            );
            rows.prop_map(move |rows| PointCloud {
                points: rows.iter().map(|(p, _)| Point3::from(*p)).collect(),
                covariances: with_covariances.then(|| rows.iter().map(|(_, c)| *c).collect()),
                normals: None,
                sensor_pose: Some(if is_turned {
                    Pose::from_translation_rpy(origin.into(), turn)
                } else {
                    Pose::identity()
                }),
                image_size: (height > 1).then_some((width, height)),
            })
        },
    )
}

fn bits(points: &[Point3]) -> Vec<[u64; 3]> {
    points.iter().map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()]).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn clouds_come_back_bit_for_bit(cloud in any_cloud()) {
        let folder = TempDir::new().unwrap();
        let [pcd, ply] = ["a.pcd", "a.ply"].map(|name| folder.path().join(name));
        write_cloud_pcd(&pcd, &cloud).unwrap();
        write_cloud_ply(&ply, &cloud).unwrap();
        let from_pcd = read_cloud(&pcd).unwrap();
        let from_ply = read_cloud(&ply).unwrap();
        for back in [&from_pcd, &from_ply] {
            prop_assert_eq!(bits(&back.points), bits(&cloud.points));
            prop_assert_eq!(&back.covariances, &cloud.covariances);
        }
        // The identity says nothing.
        let said = cloud.sensor_pose.filter(|pose| *pose != Pose::identity());
        prop_assert_eq!(from_pcd.sensor_pose, said);
        prop_assert_eq!(from_pcd.image_size, cloud.image_size);
        let first = fs::read(&pcd).unwrap();
        write_cloud_pcd(&pcd, &from_pcd).unwrap();
        prop_assert_eq!(fs::read(&pcd).unwrap(), first);
    }

    #[test]
    fn meshes_come_back_bit_for_bit(
        corners in prop::collection::vec(prop::array::uniform3(-1e7..1e7_f64), 3..20),
        picks in prop::collection::vec(prop::array::uniform3(any::<prop::sample::Index>()), 1..20),
    ) {
        let vertices: Vec<Point3> = corners.iter().map(|c| Point3::from(*c)).collect();
        let triangles = picks.iter().map(|t| t.map(|i| i.index(vertices.len()) as u32)).collect();
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("a.obj");
        write_mesh_obj(&path, &mesh).unwrap();
        prop_assert_eq!(read_mesh(&path, LengthUnit::Metres).unwrap(), mesh);
    }
}

#[test]
fn coloured_points_have_the_layout_viewers_expect() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ply");
    let points = [Point3::new(512_700.883, 5_403_547.501, 295.25)];
    write_colored_ply(&path, &points, &[[1, 2, 3]], Some(&[0.75]), &[]).unwrap();
    let bytes = fs::read(&path).unwrap();
    let header = b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\n\
        property double y\nproperty double z\nproperty uchar red\nproperty uchar green\n\
        property uchar blue\nproperty double probability\nend_header\n";
    let body = bytes.strip_prefix(header).unwrap();
    assert_eq!(body[24..27], [1, 2, 3]);
    assert_eq!(body[27..], 0.75_f64.to_le_bytes());
    assert_eq!(read_cloud(&path).unwrap().points, points);
}

#[test]
fn lists_of_different_length_are_refused_and_write_nothing() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ply");
    let points = [Point3::origin(); 2];
    let length = |result: Result<(), WriteError>| match result {
        Err(WriteError::Length { what, found, points: 2, .. }) => (what, found),
        other => panic!("{other:?}"),
    };
    assert_eq!(length(write_colored_ply(&path, &points, &[[0; 3]], None, &[])), ("colours", 1));
    let colors = [[0; 3]; 2];
    assert_eq!(
        length(write_colored_ply(&path, &points, &colors, Some(&[0.0; 3]), &[])),
        ("probabilities", 3)
    );
    let mut cloud = PointCloud::from_points(points.to_vec());
    cloud.covariances = Some(vec![Covariance::zero()]);
    assert_eq!(length(write_cloud_ply(&path, &cloud)), ("covariances", 1));
    cloud.covariances = None;
    cloud.image_size = Some((2, 3));
    assert_eq!(length(write_cloud_pcd(&path, &cloud)), ("image pixels", 6));
    cloud.image_size = None;
    cloud.sensor_pose = Some(Pose::from_translation(Vector3::new(0.0, f64::NAN, 0.0)));
    assert!(matches!(write_cloud_pcd(&path, &cloud), Err(WriteError::SensorPose { .. })));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_failed_write_leaves_the_old_file_and_no_other() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.txt");
    write_atomically(&path, |writer| writer.write_all(b"old")).unwrap();
    let failed = write_atomically(&path, |writer| {
        writer.write_all(&[b'x'; 100_000])?;
        Err(io::Error::other("the disk is full"))
    });
    let message = failed.unwrap_err().to_string();
    assert_eq!(message, format!("{}: cannot be written: the disk is full", path.display()));
    let panicked = std::panic::catch_unwind(|| write_atomically(&path, |_| panic!("on purpose")));
    assert!(panicked.is_err());
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    write_atomically(&path, |writer| writer.write_all(b"new")).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
}

#[test]
fn impossible_targets_are_errors() {
    let folder = TempDir::new().unwrap();
    let nothing = |path: &std::path::Path| write_atomically(path, |_| Ok(()));
    assert!(matches!(nothing(folder.path()), Err(WriteError::Io { .. })));
    assert!(matches!(nothing(&folder.path().join("absent/a.txt")), Err(WriteError::Io { .. })));
    assert!(matches!(nothing("..".as_ref()), Err(WriteError::Io { .. })));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_written_to() {
    let folder = TempDir::new().unwrap();
    let [target, link] = ["target", "link"].map(|name| folder.path().join(name));
    fs::write(&target, "old").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    write_atomically(&link, |writer| writer.write_all(b"new")).unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"new");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    write_atomically("/dev/null", |writer| writer.write_all(b"gone")).unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn a_picture_near_the_origin_takes_half_the_bytes_and_may_have_faces() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ply");
    let points = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.25, -999.0]].map(Point3::from);
    write_colored_ply(&path, &points, &[[9; 3]; 3], Some(&[0.5; 3]), &[[0, 1, 2]]).unwrap();
    let bytes = fs::read(&path).unwrap();
    let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    assert_eq!(bytes.len() - end, 3 * (3 * 4 + 3 + 4) + 13);
    let mesh = read_mesh(&path, LengthUnit::Metres).unwrap();
    assert_eq!((mesh.vertices(), mesh.triangles()), (&points[..], &[[0, 1, 2]][..]));
}

#[test]
fn colours_come_back_from_either_format() {
    let folder = TempDir::new().unwrap();
    let read = |name: &str| {
        cloudtouch_io::read_colors_within(folder.path().join(name), &Default::default()).unwrap()
    };
    let colors = [[255, 128, 1], [0, 7, 200]];
    let points = [Point3::origin(), Point3::new(1.0, 2.0, 3.0)];
    write_colored_ply(folder.path().join("a.ply"), &points, &colors, None, &[]).unwrap();
    assert_eq!(read("a.ply"), Some(colors.to_vec()));
    // As the Point Cloud Library writes them: the bits of a float, or a number that stands for them.
    let packed = colors.map(|[r, g, b]| u32::from_be_bytes([0, r, g, b]));
    for (name, kind) in [("u.pcd", "U"), ("f.pcd", "F")] {
        let header = |data: &str| {
            format!(
                "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F {kind}\nWIDTH 2\nHEIGHT 1\nDATA {data}\n"
            )
        };
        let word = |bits: u32| {
            if kind == "U" { bits.to_string() } else { format!("{:e}", f32::from_bits(bits)) }
        };
        let rows: String = packed.iter().map(|&bits| format!("1 2 3 {}\n", word(bits))).collect();
        fs::write(folder.path().join(name), header("ascii") + &rows).unwrap();
        assert_eq!(read(name), Some(colors.to_vec()), "{name} ascii");
        let mut bytes = header("binary").into_bytes();
        for bits in packed {
            bytes.extend([0; 12]);
            // With an opaque alpha, as a float it is no number.
            bytes.extend((bits | 0xff00_0000).to_le_bytes());
        }
        fs::write(folder.path().join(name), bytes).unwrap();
        assert_eq!(read(name), Some(colors.to_vec()), "{name} binary");
    }
    fs::write(folder.path().join("plain.xyz"), "1 2 3\n").unwrap();
    assert_eq!(read("plain.xyz"), None);
}
