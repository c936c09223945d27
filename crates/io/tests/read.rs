//! Reading by file name: what is read as what, in which unit, and what the messages say.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::{fs, path::PathBuf};

use cloudtouch_geom::{Covariance, Point3};
use cloudtouch_io::{Geometry, LengthUnit, ReadError, read_cloud, read_geometry, read_mesh};
use tempfile::TempDir;

fn file(folder: &TempDir, name: &str, contents: &str) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, contents).unwrap();
    path
}

const MESH_PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\n\
    property int z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0\n1000 0 0\n0 1000 0\n3 0 1 2\n";

/// A scan with one face was read as that face, and what stood in it was free; so was one with faces among half of its
/// points, and whoever asked for a mesh got one of any.
#[test]
fn points_beside_a_few_faces_are_not_lost_without_a_word() {
    let folder = TempDir::new().unwrap();
    let header = MESH_PLY.replace("vertex 3", "vertex 7");
    let mixed = header.replace("3 0 1 2\n", "0 0 1\n0 0 2\n0 0 3\n0 0 4\n3 0 1 2\n");
    let path = file(&folder, "mixed.ply", &mixed);
    let errors = [
        read_geometry(&path, LengthUnit::Metres).unwrap_err(),
        read_mesh(&path, LengthUnit::Metres).unwrap_err(),
    ];
    for message in errors.map(|error| error.to_string()) {
        for part in ["mixed.ply", "4 of 7 vertices belong to no face", "a cloud or a mesh"] {
            assert!(message.contains(part), "{message}");
        }
    }
}

/// A fiftieth is too many to be left over; three are not, nor is one in a hundred.
#[test]
fn vertices_that_a_tool_left_behind_do_not_refuse_a_mesh() {
    let folder = TempDir::new().unwrap();
    let of = |faces: usize, loose: usize| {
        let vertices = 3 * faces + loose;
        let mut text = MESH_PLY.replace("vertex 3", &format!("vertex {vertices}"));
        text = text.replace("face 1", &format!("face {faces}"));
        text.truncate(text.find("0 0 0").unwrap());
        (0..vertices).for_each(|i| text += &format!("{i} {} 0\n", i * i));
        (0..faces).for_each(|i| text += &format!("3 {} {} {}\n", 3 * i, 3 * i + 1, 3 * i + 2));
        let path = file(&folder, "of.ply", &text);
        let mesh = read_mesh(&path, LengthUnit::Metres).map(|mesh| mesh.triangles().len());
        let same = matches!(read_geometry(&path, LengthUnit::Metres), Ok(Geometry::Mesh(_)));
        assert_eq!(mesh.is_ok(), same);
        mesh.ok()
    };
    assert_eq!([of(1, 3), of(200, 6), of(200, 12)], [Some(1), Some(200), None]);
}

#[test]
fn content_decides_and_units_count() {
    let folder = TempDir::new().unwrap();
    let ply = file(&folder, "a.PLY", MESH_PLY);
    let mesh = read_mesh(&ply, LengthUnit::Millimetres).unwrap();
    assert_eq!(mesh.vertices()[1], Point3::new(1.0, 0.0, 0.0));
    let Geometry::Mesh(same) = read_geometry(&ply, LengthUnit::Millimetres).unwrap() else {
        panic!("a cloud")
    };
    assert_eq!(same, mesh);
    // As a cloud it read free between its vertices.
    let message = read_cloud(&ply).unwrap_err().to_string();
    for part in ["a.PLY", "and 1 would be lost", "read it as a mesh"] {
        assert!(message.contains(part), "{message}");
    }

    let table = file(
        &folder,
        "a.csv",
        "x,y,z,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz\n100,0,0,1,0,0,4,0,1\n",
    );
    let Geometry::Cloud(cloud) = read_geometry(&table, LengthUnit::Centimetres).unwrap() else {
        panic!("a mesh")
    };
    assert_eq!(cloud.points, [Point3::new(1.0, 0.0, 0.0)]);
    let variances = cloud.covariances.unwrap()[0].upper_triangle();
    let expected = Covariance::diagonal([1e-4, 4e-4, 1e-4]).upper_triangle();
    assert!(variances.iter().zip(expected).all(|(v, e)| (v - e).abs() < 1e-18));

    let pcd =
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nVIEWPOINT 100 0 0 1 0 0 0\nPOINTS 0\nDATA ascii\n";
    let pcd = file(&folder, "a.pcd", pcd);
    let Geometry::Cloud(cloud) = read_geometry(&pcd, LengthUnit::Inches).unwrap() else {
        panic!("a mesh")
    };
    assert_eq!(cloud.sensor_origin(), Point3::new(2.54, 0.0, 0.0));
}

#[test]
fn messages_name_file_place_finding_and_remedy() {
    let folder = TempDir::new().unwrap();
    let message = |name: &str, contents: &str| {
        let path = file(&folder, name, contents);
        let message = read_geometry(&path, LengthUnit::Metres).unwrap_err().to_string();
        message.strip_prefix(&format!("{}: ", path.display())).unwrap().to_owned()
    };
    assert_eq!(
        message("a.xyz", "1 2 3\n1 2 three\n"),
        "line 2, column 3: \"three\" is not a number: write it like -0.25, 1e-3 or nan"
    );
    assert_eq!(
        message("a.stl", "ply\n"),
        "line 1: found \"ply\", expected \"solid\" or a binary header: is the file extension right?"
    );
    assert_eq!(message("a.pcd", ""), "the file is empty: was it written completely?");
    assert_eq!(
        message("a.las", ""),
        "the extension \"las\" is not one of .pcd, .ply, .xyz, .txt, .csv, .stl, .obj: convert it to \
         .ply or .pcd with CloudCompare or PDAL"
    );
}

#[test]
fn wrong_kinds_and_absent_files_are_told_apart() {
    let folder = TempDir::new().unwrap();
    let unit = LengthUnit::Metres;
    for name in ["a.stl", "a.obj", "a"] {
        let path = file(&folder, name, "");
        assert!(matches!(read_cloud(path), Err(ReadError::Extension { .. })), "{name}");
    }
    for name in ["a.pcd", "a.xyz", "a.ply.gz"] {
        let path = file(&folder, name, "");
        assert!(matches!(read_mesh(path, unit), Err(ReadError::Extension { .. })), "{name}");
    }
    let absent = folder.path().join("absent.pcd");
    assert!(matches!(read_cloud(&absent), Err(ReadError::Io { path, .. }) if path == absent));
    let no_faces =
        file(&folder, "b.ply", &MESH_PLY.replace("face 1", "face 0").replace("3 0 1 2\n", ""));
    assert!(read_mesh(&no_faces, unit).unwrap_err().to_string().contains("there are no faces"));
    assert_eq!(read_cloud(&no_faces).unwrap().len(), 3);
}

/// The extension of a folder was said not to be one that is read.
#[test]
fn a_folder_is_told_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let error = cloudtouch_io::read_cloud(folder.path()).unwrap_err().to_string();
    assert!(error.contains("it is a folder: give a file in it"), "{error}");
}

/// Names that mean something to other programs were said to be of no file, and no more.
#[test]
fn a_name_that_is_of_no_file_is_told_why() {
    for (name, why) in [
        ("-", "standard input is not read: give the name of a file"),
        ("~/scan.pcd", "only a shell takes `~` for a home folder, outside of quotes"),
        ("{\"shoulder\": 0}", "write it to one, and give its name"),
        ("file:///home/me/scan.pcd", "addresses are not read: give the path of a file"),
    ] {
        let error = cloudtouch_io::read_bytes(name, 100).unwrap_err();
        assert!(matches!(error, ReadError::Io { .. }), "{error}");
        let error = error.to_string();
        assert!(error.starts_with(&format!("{name}: cannot be read: ")), "{error}");
        assert!(error.contains(why), "{error}");
    }
    let error = cloudtouch_io::read_bytes("scan~.pcd", 100).unwrap_err().to_string();
    assert!(!error.contains("home"), "{error}");
}
