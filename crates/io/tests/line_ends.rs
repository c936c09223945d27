//! Text as other systems write it: any line ends, byte order marks, continued lines, stray characters.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_io::{Fault, Geometry, obj, pcd, ply, stl, xyz};

const XYZ: &str = "1 2 3\n4 5 6\n7 8 9\n";
const PCD: &str =
    "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA ascii\n1 2 3\n4 5 6\n7 8 9\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                   property float z\nend_header\n1 2 3\n4 5 6\n7 8 9\n";
const OBJ: &str = "v 1 2 3\nv 4 5 6\nv 7 8 0\nf 1 2 3\n";
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
                   endloop\nendfacet\nendsolid a\n";

/// How many points or vertices each reader makes of its text.
fn counts(change: impl Fn(&str) -> String) -> [usize; 5] {
    let text = |text: &str| change(text).into_bytes();
    let ply = match ply::parse(&text(PLY)).unwrap() {
        Geometry::Cloud(cloud) => cloud.len(),
        Geometry::Mesh(mesh) => mesh.vertices().len(),
    };
    [
        xyz::parse(&text(XYZ)).unwrap().len(),
        pcd::parse(&text(PCD)).unwrap().len(),
        ply,
        obj::parse(&text(OBJ)).unwrap().vertices().len(),
        stl::parse(&text(STL)).unwrap().vertices().len(),
    ]
}

#[test]
fn a_file_whose_lines_end_in_cr_alone_was_one_point() {
    for end in ["\n", "\r\n", "\r"] {
        assert_eq!(counts(|text| text.replace('\n', end)), [3; 5], "{end:?}");
    }
}

#[test]
fn a_byte_order_mark_was_refused_by_all_readers_but_one() {
    assert_eq!(counts(|text| format!("\u{feff}{text}")), [3; 5]);
}

#[test]
fn several_points_in_a_row_were_read_as_the_first() {
    let row = |points: usize| (0..3 * points).map(|i| i.to_string()).collect::<Vec<_>>().join(" ");
    for text in [row(2), row(7), format!("{}\n{}\n", row(7), row(7))] {
        let error = xyz::parse(text.as_bytes()).unwrap_err();
        assert!(matches!(error.fault, Fault::ManyColumns { .. }), "{error}");
    }
    // A normal and an intensity; and named columns may be as many as there are.
    assert_eq!(xyz::parse(b"1 2 3 0 0 1 7\n4 5 6 0 0 1 7\n").unwrap().len(), 2);
    let names = (0..30).map(|i| format!("c{i}")).collect::<Vec<_>>().join(" ");
    let wide = format!("x y z {names}\n{}\n", row(11));
    assert_eq!(xyz::parse(wide.as_bytes()).unwrap().len(), 1);
}

#[test]
fn a_face_over_two_lines_was_refused() {
    let mesh = obj::parse(b"v 1 2 3\nv 4 5 6\nv 7 8 0\nf 1 2 \\\n3\n").unwrap();
    assert_eq!(mesh.triangles(), [[0, 1, 2]]);
    assert!(obj::parse(b"v 1 2 3\\").is_err());
}

#[test]
fn a_control_character_in_the_name_of_an_ascii_stl_made_it_binary() {
    let text = STL.replace("solid a\nfacet", "solid a\u{1}b\u{0}\nfacet");
    assert_eq!(stl::parse(text.as_bytes()).unwrap().triangles().len(), 1);
}
