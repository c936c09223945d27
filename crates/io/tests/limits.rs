//! What is larger than the limits is an error that names them, however it is written.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_io::{
    Fault, FormatError, LengthUnit, Place, ReadError, ReadLimits, obj, pcd, ply, read_bytes,
    read_cloud, read_cloud_within, read_geometry_within, read_mesh_within, stl, xyz,
};

const TWO: ReadLimits = ReadLimits { bytes: 10_000, points: 2, triangles: 2 };
const THREE: ReadLimits = ReadLimits { bytes: 10_000, points: 3, triangles: 3 };
const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

fn pcd(data: &str, body: &[u8]) -> Vec<u8> {
    let mut bytes =
        format!("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA {data}\n").into_bytes();
    bytes.extend(body);
    bytes
}

fn ply(format: &str, body: &[u8]) -> Vec<u8> {
    let mut bytes =
        format!("ply\nformat {format} 1.0\nelement vertex 3\n{XYZ}end_header\n").into_bytes();
    bytes.extend(body);
    bytes
}

fn too_many<T: std::fmt::Debug>(result: Result<T, FormatError>) -> (Place, &'static str, usize) {
    let error = result.unwrap_err();
    let message = error.to_string();
    assert!(message.contains("limit"), "{message}");
    match error {
        FormatError { place, fault: Fault::TooMany { what, found, .. } } => (place, what, found),
        other => panic!("{other}"),
    }
}

#[test]
fn points_are_counted_in_every_format() {
    let text = b"0 0 1\n0 0 2\n0 0 3\n";
    let packed = {
        let packed = lzf::compress(&[0; 36]).unwrap();
        let sizes = [(packed.len() as u32).to_le_bytes(), 36_u32.to_le_bytes()].concat();
        [sizes, packed].concat()
    };
    for (bytes, place) in [
        (pcd("ascii", text), Place::Line(8)),
        (pcd("binary", &[0; 36]), Place::Line(4)),
        (pcd("binary_compressed", &packed), Place::Line(4)),
    ] {
        assert!(pcd::parse_within(&bytes, &THREE).is_ok());
        assert_eq!(too_many(pcd::parse_within(&bytes, &TWO)), (place, "points", 3));
    }
    for (bytes, place) in [
        (ply("ascii", text), Place::Line(10)),
        (ply("binary_little_endian", &[0; 36]), Place::Line(3)),
    ] {
        assert!(ply::parse_within(&bytes, &THREE).is_ok());
        assert_eq!(too_many(ply::parse_within(&bytes, &TWO)), (place, "points", 3));
    }
    assert!(xyz::parse_within(text, &THREE).is_ok());
    assert_eq!(too_many(xyz::parse_within(text, &TWO)), (Place::Line(3), "points", 3));
    let mesh = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert!(obj::parse_within(mesh, &THREE).is_ok());
    assert_eq!(too_many(obj::parse_within(mesh, &TWO)), (Place::Line(3), "points", 3));
}

#[test]
fn triangles_are_counted_in_every_format() {
    let corners = "outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n";
    let facet = format!("facet normal 0 0 1\n{corners}endfacet\n");
    let ascii = |count: usize| format!("solid s\n{}endsolid s\n", facet.repeat(count)).into_bytes();
    let binary =
        |count: u8| [&[0; 80], &[count, 0, 0, 0][..], &[0; 50].repeat(count.into())].concat();
    for (fits, beyond, place) in
        [(ascii(2), ascii(3), Place::Line(18)), (binary(2), binary(3), Place::Byte(80))]
    {
        assert!(stl::parse_within(&fits, &TWO).is_ok());
        assert_eq!(too_many(stl::parse_within(&beyond, &TWO)), (place, "triangles", 3));
    }
    // A polygon counts by what becomes of it.
    let points = ReadLimits { points: 10, ..TWO };
    let polygon = |corners: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {corners}\n").into_bytes();
    assert!(obj::parse_within(&polygon("1 2 3 1"), &points).is_ok());
    let beyond = obj::parse_within(&polygon("1 2 3 1 2"), &points);
    assert_eq!(too_many(beyond), (Place::Line(4), "triangles", 3));
    let polygon = |corners: &str| {
        let faces = "element face 1\nproperty list uchar int vertex_index\n";
        let header = format!("ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}{faces}end_header\n");
        format!("{header}0 0 0\n1 0 0\n0 1 0\n{corners}\n").into_bytes()
    };
    assert!(ply::parse_within(&polygon("4 0 1 2 0"), &points).is_ok());
    let beyond = ply::parse_within(&polygon("5 0 1 2 0 1"), &points);
    assert_eq!(too_many(beyond), (Place::Line(13), "triangles", 3));
}

#[test]
fn the_default_limits_are_those_stated() {
    let limits = ReadLimits::default();
    let stated = ReadLimits { bytes: 2_147_483_648, points: 10_000_000, triangles: 5_000_000 };
    assert_eq!(limits, stated);
    // A true file of more points than that, which only its header tells before memory is taken.
    let points = limits.points + 1;
    let header = format!("FIELDS x y z\nSIZE 1 1 1\nTYPE U U U\nPOINTS {points}\nDATA binary\n");
    let mut bytes = header.into_bytes();
    bytes.resize(bytes.len() + 3 * points, 0);
    assert_eq!(too_many(pcd::parse(&bytes)), (Place::Line(4), "points", points));
}

#[test]
fn a_file_of_too_many_bytes_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let cloud = folder.path().join("cloud.xyz");
    std::fs::write(&cloud, "0 0 1\n").unwrap();
    let limits = |bytes| ReadLimits { bytes, ..TWO };
    assert_eq!(read_cloud_within(&cloud, &limits(6)).unwrap().len(), 1);
    let error = read_cloud_within(&cloud, &limits(5)).unwrap_err();
    assert!(matches!(error, ReadError::TooLarge { limit: 5, .. }));
    let message = error.to_string();
    assert!(message.contains("cloud.xyz") && message.contains('5'), "{message}");
    let metres = LengthUnit::Metres;
    assert!(read_geometry_within(&cloud, metres, &limits(5)).is_err());
    let mesh = folder.path().join("mesh.obj");
    std::fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    assert!(read_mesh_within(&mesh, metres, &THREE).is_ok());
    assert!(read_mesh_within(&mesh, metres, &TWO).is_err());

    // Longer than memory on most computers, and without a byte on the disk.
    let sparse = folder.path().join("sparse.pcd");
    std::fs::File::create(&sparse).unwrap().set_len(1 << 40).unwrap();
    assert!(matches!(read_cloud(&sparse), Err(ReadError::TooLarge { .. })));
}

#[cfg(unix)]
#[test]
fn a_device_without_a_size_ends_at_the_limit() {
    let error = read_bytes("/dev/zero", 1000).unwrap_err();
    assert!(matches!(error, ReadError::TooLarge { limit: 1000, .. }));
}

#[test]
fn unpacking_is_limited_too() {
    let packed = lzf::compress(&[0; 36_000]).unwrap();
    let sizes = [(packed.len() as u32).to_le_bytes(), 36_000_u32.to_le_bytes()].concat();
    let header = "FIELDS x y z pad\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 35988\nPOINTS 1\n";
    let bytes = [header.as_bytes(), b"DATA binary_compressed\n", &sizes, &packed].concat();
    let limits = |bytes| ReadLimits { bytes, ..TWO };
    assert_eq!(pcd::parse_within(&bytes, &limits(36_000)).unwrap().len(), 1);
    let (_, what, found) = too_many(pcd::parse_within(&bytes, &limits(35_999)));
    assert_eq!((what, found), ("unpacked bytes", 36_000));
}
