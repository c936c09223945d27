//! OBJ files: faces in all their notations, the line of counts, and what can be wrong.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_geom::Point3;
use cloudtouch_io::{Fault, Place, obj};

const VERTICES: &str = "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n";

fn triangles(faces: &str) -> Vec<[u32; 3]> {
    obj::parse((VERTICES.to_owned() + faces).as_bytes()).unwrap().triangles().to_vec()
}

fn error(text: impl AsRef<str>) -> (Place, Fault) {
    let error = obj::parse(text.as_ref().as_bytes()).unwrap_err();
    (error.place, error.fault)
}

#[test]
fn faces_are_read_in_every_notation() {
    let expected = [[0, 1, 2], [0, 2, 3]];
    for faces in [
        "f 1 2 3 4",
        "f 1/1 2/1 3/1 4/1\n",
        "vn 0 0 1\nf 1//1 2//1 3//1 4//1 # a square\n",
        "vt 0 0\nf 1/1/1 2/1/1 3/1/1 4/1/1\r\n",
        "f -4 -3 -2 -1\n",
        "o name\ng a b\nusemtl red\ns off\nf 1 -3 3\nl 1 2\nf 1 3 4\n",
    ] {
        assert_eq!(triangles(faces), expected, "{faces:?}");
    }
    let faces_first = obj::parse(b"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap();
    assert_eq!(faces_first.vertices()[2], Point3::new(0.0, 1.0, 0.0));
}

/// The line after a path of Windows was taken for a part of it.
#[test]
fn a_backslash_ends_a_comment_or_a_name_like_any_other_letter() {
    for before in ["# from C:\\parts\\", "mtllib C:\\parts\\", "o part\\", "g \\"] {
        assert_eq!(triangles(&format!("{before}\nf 1 2 3\nf 1 3 4\n")), [[0, 1, 2], [0, 2, 3]]);
    }
    assert_eq!(triangles("f 1 2 \\\n3 4\nvn 0 0 \\\n1\n"), [[0, 1, 2], [0, 2, 3]]);
}

/// The face after a path of Windows behind another was taken for a part of that path.
#[test]
fn a_backslash_in_a_comment_behind_values_took_the_next_line_away() {
    let faces = "f 1 2 3 # of C:\\parts\\\nf 1 3 4\n";
    assert_eq!(triangles(faces), [[0, 1, 2], [0, 2, 3]]);
}

/// Every line was copied once more with each that followed it: 13 s for half as many.
#[test]
fn a_face_over_hundreds_of_thousands_of_lines_is_read() {
    let lines = 800_000;
    let face = format!("f \\\n{}3\n", "1 2 \\\n".repeat(lines));
    assert_eq!(triangles(&face).len(), 2 * lines - 1);
}

/// A scan beside a box was a box.
#[test]
fn points_beside_faces_are_not_lost_without_a_word() {
    let found = error(VERTICES.to_owned() + "p 1 2\nf 1 2 3\np 4\n");
    assert_eq!(found, (Place::Line(5), Fault::PointsBesideFaces));
}

#[test]
fn a_first_line_of_counts_is_taken_at_its_word() {
    let with = |counts: &str| format!("{counts}\r\n{VERTICES}f 1 2 3 4\nf 1 2 3\n");
    assert_eq!(obj::parse(with("4 2").as_bytes()).unwrap().triangles().len(), 3);
    assert_eq!(
        error(with("5 2")),
        (Place::Line(1), Fault::Count { what: "vertices", promised: 5, found: 4 })
    );
    assert_eq!(
        error(with("4 3")),
        (Place::Line(1), Fault::Count { what: "faces", promised: 3, found: 2 })
    );
    assert!(matches!(error(with("4 2 3")), (Place::Line(1), Fault::BadEntry { .. })));
    assert!(matches!(error(with("# c\n4 2")), (Place::Line(2), Fault::BadEntry { .. })));
}

#[test]
fn faults_are_named_by_line_and_column() {
    let face = |face: &str| error(VERTICES.to_owned() + face);
    let column = |line, column| Place::Column { line, column };
    let missing = |found: &str| Fault::MissingVertex { found: found.into(), vertices: 4 };
    assert_eq!(error(""), (Place::Whole, Fault::Empty));
    assert_eq!(face("f 1 2 3\nf 1 2 5\nf 1 2 4"), (column(6, 3), missing("5")));
    assert_eq!(face("f 1 0 2"), (column(5, 2), missing("0")));
    assert_eq!(face("f 1 -5 2"), (column(5, 2), missing("-5")));
    assert_eq!(face("f 1 9999999999 2"), (column(5, 2), missing("9999999999")));
    assert_eq!(face("f -9223372036854775808 1 2"), (column(5, 1), missing("-9223372036854775808")));
    assert_eq!(face("f 1 2.5 3"), (column(5, 2), Fault::NotANumber { found: "2.5".into() }));
    assert_eq!(
        face("f 1 2"),
        (Place::Line(5), Fault::Corners { found: 2, expected: "at least 3" })
    );
    assert_eq!(face(""), (Place::Line(1), Fault::NoTriangles));
    assert_eq!(face("v 1 2"), (Place::Line(5), Fault::RowLength { expected: 3, found: 2 }));
    assert_eq!(face("v 1 2 z"), (column(5, 3), Fault::NotANumber { found: "z".into() }));
    assert!(matches!(face("v 1 nan 3"), (_, Fault::NotFinite { value }) if value.is_nan()));
    assert!(matches!(face("curv 0 1 1 2 3"), (Place::Line(5), Fault::BadEntry { .. })));
}

/// A polygon with a notch became a fan that covered it: what stood in the notch collided.
#[test]
fn a_polygon_covers_nothing_of_its_notch() {
    let ell = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]];
    for first in 0..6 {
        // The face comes before its vertices.
        let mut text = "f 1 2 3 4 5 6\n".to_owned();
        let mut ply = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
                       element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            .to_owned();
        for [x, y] in (0..6).map(|k| ell[(first + k) % 6]) {
            text += &format!("v {x} {y} 0\n");
            ply += &format!("{x} {y} 0\n");
        }
        ply += "6 0 1 2 3 4 5\n";
        let of_obj = cloudtouch_io::obj::parse(text.as_bytes()).unwrap();
        let cloudtouch_io::Geometry::Mesh(of_ply) =
            cloudtouch_io::ply::parse(ply.as_bytes()).unwrap()
        else {
            panic!("no mesh");
        };
        for mesh in [of_obj, of_ply] {
            let area = |t| {
                let [a, b, c] = mesh.corners(t);
                0.5 * (b - a).cross(&(c - a)).z
            };
            let areas: Vec<f64> = (0..4).map(area).collect();
            assert!(
                areas.iter().all(|area| *area > 0.0) && areas.iter().sum::<f64>() == 5.0,
                "{areas:?}"
            );
        }
    }
}
