//! PLY files: clouds and meshes in every encoding, and what can be wrong with them.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_geom::{Covariance, Point3, PointCloud, TriangleMesh};
use cloudtouch_io::{Fault, Geometry, Place, ply};

fn cloud(bytes: &[u8]) -> PointCloud {
    match ply::parse(bytes).unwrap() {
        Geometry::Cloud(cloud) => cloud,
        Geometry::Mesh(_) => panic!("a mesh"),
    }
}

fn mesh(bytes: &[u8]) -> TriangleMesh {
    match ply::parse(bytes).unwrap() {
        Geometry::Mesh(mesh) => mesh,
        Geometry::Cloud(_) => panic!("a cloud"),
    }
}

fn error(bytes: impl AsRef<[u8]>) -> (Place, Fault) {
    let error = ply::parse(bytes.as_ref()).unwrap_err();
    (error.place, error.fault)
}

const SQUARE: &str = "ply\nformat ascii 1.0\ncomment a square and a tail\nelement vertex 5\n\
    property float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 2\n\
    property uchar flags\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n0 0 1 9\n1 4 0 1 2 3\n1 3 0 1 4\n";

#[test]
fn polygons_become_fans_whatever_the_line_ends() {
    for text in [SQUARE.to_owned(), SQUARE.replace('\n', "\r\n")] {
        let mesh = mesh(text.as_bytes());
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [0, 1, 4]]);
        assert_eq!(mesh.vertices()[4], Point3::new(0.0, 0.0, 1.0));
    }
}

/// The square above in binary, faces first, with an element nobody knows in between.
fn binary_square(big: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement face 2\n\
         property list ushort uint vertex_index\nelement edge 2\nproperty list uchar double w\n\
         property short k\nelement nothing 1000000000000\nelement vertex 5\nproperty double z\n\
         property list uchar float extra\nproperty double x\nproperty int y\nend_header\n"
    )
    .into_bytes();
    macro_rules! put {
        ($($value:expr),*) => {
            $(bytes.extend(if big { $value.to_be_bytes() } else { $value.to_le_bytes() });)*
        };
    }
    put!(4_u16, 0_u32, 1_u32, 2_u32, 3_u32, 3_u16, 0_u32, 1_u32, 4_u32);
    put!(2_u8, 0.5_f64, 1.5_f64, -1_i16, 0_u8, 7_i16);
    for (x, y, z) in
        [(0.0_f64, 0_i32, 0.0_f64), (1.0, 0, 0.0), (1.0, 1, 0.0), (0.0, 1, 0.0), (0.0, 0, 1.0)]
    {
        put!(z, 1_u8, 2.5_f32, x, y);
    }
    bytes
}

#[test]
fn binary_of_either_byte_order_says_the_same() {
    let expected = mesh(SQUARE.as_bytes());
    assert_eq!(mesh(&binary_square(false)), expected);
    assert_eq!(mesh(&binary_square(true)), expected);
}

const CLOUD: &str = "ply\nformat ascii 1.0\nelement vertex 2\nproperty double y\n\
    property double x\nproperty double z\nelement face 0\n\
    property list uchar int vertex_indices\nend_header\n5403547.501 512700.883 1\nnan nan nan\n";

#[test]
fn without_faces_it_is_a_cloud_with_missing_returns_and_full_precision() {
    let cloud = cloud(CLOUD.as_bytes());
    assert_eq!(cloud.points[0], Point3::new(512_700.883, 5_403_547.501, 1.0));
    assert!(cloud.points[1].x.is_nan() && cloud.covariances.is_none());
}

#[test]
fn covariance_properties_are_read_and_checked() {
    let names = ["cov_zz", "x", "y", "z", "cov_xx", "cov_xy", "cov_xz", "cov_yy", "cov_yz"];
    let properties: String = names.iter().map(|n| format!("property float {n}\n")).collect();
    let text = format!("ply\nformat ascii 1.0\nelement vertex 1\n{properties}end_header\n");
    let good = cloud((text.clone() + "0.25 1 2 3 1 0 0 4 0\n").as_bytes());
    assert_eq!(good.covariances, Some(vec![Covariance::diagonal([1.0, 4.0, 0.25])]));
    let (place, fault) = error(text.clone() + "0.25 1 2 3 1 nan 0 4 0\n");
    assert_eq!(place, Place::Line(14));
    assert!(matches!(fault, Fault::Covariance { row: 0, .. }));
    let partial = text.replace("property float cov_yz\n", "");
    assert_eq!(error(partial), (Place::Line(3), Fault::MissingColumn { name: "cov_yz" }));
}

#[test]
fn bad_headers_are_named_by_line() {
    assert_eq!(error(""), (Place::Whole, Fault::Empty));
    assert!(matches!(error("solid a\n"), (Place::Line(1), Fault::WrongMagic { .. })));
    assert!(matches!(
        error("ply\nformat ascii 1.0\n"),
        (Place::Line(2), Fault::UnexpectedEnd { .. })
    ));
    type Check = fn(&Fault) -> bool;
    let cases: [(&str, &str, usize, Check); 10] = [
        ("format ascii 1.0", "format utf8 1.0", 2, |f| {
            matches!(f, Fault::BadEntry { entry: "the format", .. })
        }),
        ("format ascii 1.0\n", "", 8, |f| {
            matches!(f, Fault::MissingEntry { entry: "format line" })
        }),
        ("vertex 2", "vertex two", 3, |f| matches!(f, Fault::BadEntry { entry: "an element", .. })),
        ("element vertex", "element point", 9, |f| {
            matches!(f, Fault::MissingEntry { entry: "element vertex" })
        }),
        ("element face", "element vertex", 7, |f| matches!(f, Fault::Repeated { .. })),
        ("element face 0", "element tristrips 1", 7, |f| matches!(f, Fault::BadEntry { .. })),
        ("double z", "real z", 6, |f| matches!(f, Fault::BadEntry { entry: "a property", .. })),
        ("double z", "double w", 3, |f| matches!(f, Fault::MissingColumn { name: "z" })),
        ("list uchar", "list float", 8, |f| {
            matches!(f, Fault::BadEntry { entry: "a property", .. })
        }),
        ("end_header", "end", 9, |f| matches!(f, Fault::BadEntry { entry: "the header line", .. })),
    ];
    for (from, to, line, check) in cases {
        let (place, fault) = error(CLOUD.replace(from, to));
        assert!(place == Place::Line(line) && check(&fault), "{to}: {place} {fault:?}");
    }
    let early = "ply\nproperty float x\n";
    assert_eq!(error(early), (Place::Line(2), Fault::MissingEntry { entry: "element before it" }));
    let list = CLOUD.replace("property double z", "property list uchar double z");
    assert!(matches!(error(list), (Place::Line(3), Fault::BadEntry { .. })));
}

#[test]
fn bad_rows_are_named_by_line_and_column() {
    let column = |line, column| Place::Column { line, column };
    let cases = [
        ("1 1 0 9", "1 one 0 9", column(15, 2), Fault::NotANumber { found: "one".into() }),
        ("1 1 0 9", "1 1 0", Place::Line(15), Fault::RowLength { expected: 4, found: 3 }),
        ("1 1 0 9", "1 1 0 9 9", Place::Line(15), Fault::RowLength { expected: 4, found: 5 }),
        ("1 1 0 9", "1 inf 0 9", column(15, 2), Fault::NotFinite { value: f64::INFINITY }),
        (
            "3 0 1 4\n",
            "3 0 1 5\n",
            column(19, 5),
            Fault::MissingVertex { found: "5".into(), vertices: 5 },
        ),
        (
            "3 0 1 4\n",
            "3 0 -1 4\n",
            column(19, 4),
            Fault::MissingVertex { found: "-1".into(), vertices: 5 },
        ),
        (
            "3 0 1 4\n",
            "3 0 0.5 4\n",
            column(19, 4),
            Fault::MissingVertex { found: "0.5".into(), vertices: 5 },
        ),
        (
            "3 0 1 4\n",
            "2 0 1\n",
            Place::Line(19),
            Fault::Corners { found: 2, expected: "at least 3" },
        ),
        ("1 3 0 1 4\n", "", Place::Line(18), Fault::FewRows { promised: 2, found: 1 }),
        ("3 0 1 4\n", "3 0 1 4\n\n7\n", Place::Line(20), Fault::Leftover { promised: 2 }),
    ];
    for (from, to, place, fault) in cases {
        assert_eq!(error(SQUARE.replace(from, to)), (place, fault), "{to}");
    }
    assert!(matches!(
        error(SQUARE.replace("1 3 0 1 4", "1 -3 0 1 4")),
        (
            Place::Column { line: 19, column: 2 },
            Fault::BadEntry { entry: "the length of a list", .. }
        )
    ));
    let unknown = SQUARE.replace("vertex_indices", "corners");
    assert!(matches!(error(unknown), (Place::Line(9), Fault::MissingEntry { .. })));
}

#[test]
fn binary_files_cut_off_or_too_long_are_named_by_byte() {
    let whole = binary_square(false);
    let end = whole.len();
    // Rows of vertices have a list, so only what they take at least is known beforehand.
    let (place, fault) = error(&whole[..end - 1]);
    assert_eq!(place, Place::Byte(end - 1));
    assert!(matches!(fault, Fault::UnexpectedEnd { .. }));
    assert!(matches!(
        error(&whole[..end - 30]),
        (Place::Line(9), Fault::TooShort { promised: 5, needed: 105, available: 95 })
    ));
    let padded = [&whole[..], &[0; 40]].concat();
    assert_eq!(mesh(&padded), mesh(&whole));
    let longer = [&whole[..], b"\n1"].concat();
    assert_eq!(error(longer), (Place::Byte(end), Fault::Leftover { promised: 5 }));
    let promise = |text: &[u8]| {
        let text = String::from_utf8_lossy(text).replace("face 2", "face 18446744073709551615");
        error(text)
    };
    assert!(matches!(promise(&whole), (Place::Line(3), Fault::TooShort { .. })));
    assert!(matches!(promise(SQUARE.as_bytes()), (_, Fault::FewRows { .. })));
}

#[test]
fn vertices_without_coordinates_are_no_cloud() {
    // They would take no bytes, so that any number of them could be promised.
    let text = "ply\nformat ascii 1.0\nelement vertex 1000000000000\nend_header\n";
    assert_eq!(
        ply::parse(text.as_bytes()).unwrap_err().to_string(),
        "line 3: there is no column x: it needs x, y, z, and all six of cov_* or none"
    );
}
