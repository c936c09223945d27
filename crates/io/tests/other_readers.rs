//! Independent readers must find in our files, and in plain files of theirs, what ours find.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::{fs, io::Cursor};

use cloudtouch_geom::{Covariance, Point3, PointCloud, TriangleMesh};
use cloudtouch_io::{obj, stl, write_cloud_ply, write_mesh_obj};
use ply_rs_bw::{
    parser::Parser,
    ply::{DefaultElement, Property},
};
use tempfile::TempDir;

fn mesh() -> TriangleMesh {
    let vertices = (0..6).map(|i| {
        let t = f64::from(i);
        Point3::new(t.cos() / 3.0, t.sin() * 1e-5, -t)
    });
    TriangleMesh::new(vertices.collect(), vec![[0, 1, 2], [5, 3, 1], [4, 2, 0]]).unwrap()
}

#[test]
fn ply_rs_reads_our_ply() {
    let points = vec![Point3::new(512_700.883, 5_403_547.501, 1.0), Point3::new(-1.0, 0.0, 2.0)];
    let covariances = vec![Covariance::diagonal([1.0, 2.0, 3.0]), Covariance::isotropic(0.1)];
    let cloud = PointCloud {
        covariances: Some(covariances.clone()),
        ..PointCloud::from_points(points.clone())
    };
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ply");
    write_cloud_ply(&path, &cloud).unwrap();
    let parser = Parser::<DefaultElement>::new();
    let read = parser.read_ply(&mut fs::File::open(&path).unwrap()).unwrap();
    let rows = &read.payload["vertex"];
    assert_eq!(rows.len(), 2);
    for (row, element) in rows.iter().enumerate() {
        for (name, expected) in ["x", "y", "z"]
            .into_iter()
            .zip(points[row].iter().copied())
            .chain([("cov_yy", covariances[row].upper_triangle()[3])])
        {
            assert!(matches!(element[name], Property::Double(v) if v == expected), "{name}");
        }
    }
}

#[test]
fn tobj_reads_our_obj() {
    let mesh = mesh();
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.obj");
    write_mesh_obj(&path, &mesh).unwrap();
    let bytes = fs::read(&path).unwrap();
    assert_eq!(obj::parse(&bytes).unwrap(), mesh);
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let (models, _) =
        tobj::load_obj_buf(&mut Cursor::new(&bytes), &options, |_| Ok(Default::default())).unwrap();
    let read = &models[0].mesh;
    let corner = |i: usize| &read.positions[3 * read.indices[i] as usize..][..3];
    for triangle in 0..mesh.triangles().len() {
        for (k, expected) in mesh.corners(triangle).iter().enumerate() {
            let single: Vec<f32> = expected.iter().map(|&v| v as f32).collect();
            assert_eq!(corner(3 * triangle + k), single);
        }
    }
}

#[test]
fn we_read_what_stl_io_writes() {
    let mesh = mesh();
    let triangles: Vec<stl_io::Triangle> = (0..mesh.triangles().len())
        .map(|t| stl_io::Triangle {
            normal: stl_io::Normal::new([0.0; 3]),
            vertices: mesh
                .corners(t)
                .map(|p| stl_io::Vertex::new([p.x as f32, p.y as f32, p.z as f32])),
        })
        .collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, triangles.iter()).unwrap();
    let read = stl::parse(&bytes).unwrap();
    assert_eq!(read.triangles().len(), 3);
    for (t, expected) in triangles.iter().enumerate() {
        for (corner, vertex) in read.corners(t).iter().zip(expected.vertices) {
            assert_eq!(corner.coords.as_slice(), vertex.0.map(f64::from));
        }
    }
}
