//! STL files: which of the two kinds it is, and what can be wrong with either.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_geom::Point3;
use cloudtouch_io::{Fault, Place, stl};

const TETRAHEDRON: [[f32; 9]; 4] = [
    [0., 0., 0., 0., 1., 0., 1., 0., 0.],
    [0., 0., 0., 1., 0., 0., 0., 0., 1.],
    [0., 0., 0., 0., 0., 1., 0., 1., 0.],
    [1., 0., 0., 0., 1., 0., 0., 0., 1.],
];

fn binary(title: &str, triangles: &[[f32; 9]]) -> Vec<u8> {
    let mut bytes = title.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii() -> String {
    let mut text = String::from("solid a name\n");
    for t in TETRAHEDRON {
        text += " facet normal 0 0 0\n  outer loop\n";
        for c in t.chunks(3) {
            text += &format!("   vertex {} {} {:e}\n", c[0], c[1], c[2]);
        }
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid a name\n"
}

fn error(bytes: impl AsRef<[u8]>) -> (Place, Fault) {
    let error = stl::parse(bytes.as_ref()).unwrap_err();
    (error.place, error.fault)
}

#[test]
fn both_kinds_give_the_same_closed_mesh() {
    let expected = stl::parse(&binary("", &TETRAHEDRON)).unwrap();
    assert_eq!(expected.triangles().len(), 4);
    assert_eq!(expected.corners(3)[2], Point3::new(0.0, 0.0, 1.0));
    assert_eq!(expected.merged().open_edges(), 0);
    for text in [ascii(), ascii().replace('\n', "\r\n"), ascii().to_uppercase()] {
        assert_eq!(stl::parse(text.as_bytes()).unwrap(), expected);
    }
    // Binary files may call themselves solid, and even more.
    let sly = binary("solid sly\nfacet normal 0 0 0\n", &TETRAHEDRON);
    assert_eq!(stl::parse(&sly).unwrap(), expected);
}

#[test]
fn several_solids_make_one_mesh() {
    let two = ascii() + &ascii();
    assert_eq!(stl::parse(two.as_bytes()).unwrap().triangles().len(), 8);
}

#[test]
fn binary_files_must_hold_what_they_count() {
    let whole = binary("solid", &TETRAHEDRON);
    assert_eq!(
        error(&whole[..whole.len() - 1]),
        (Place::Byte(80), Fault::TooShort { promised: 4, needed: 200, available: 199 })
    );
    let mut many = whole.clone();
    many[80..84].fill(0xff);
    assert!(matches!(error(many).1, Fault::TooShort { promised: 0xffff_ffff, .. }));
    assert!(matches!(error([0; 83]), (Place::Byte(83), Fault::UnexpectedEnd { .. })));
    let mut few = whole.clone();
    few[80] = 3;
    assert_eq!(error(few), (Place::Byte(234), Fault::Leftover { promised: 3 }));
    assert_eq!(stl::parse(&[&whole[..], &[0; 60]].concat()).unwrap().triangles().len(), 4);
    assert_eq!(error(binary("", &[])), (Place::Whole, Fault::NoTriangles));
    let mut bad = TETRAHEDRON;
    bad[2][4] = f32::NEG_INFINITY;
    assert_eq!(
        error(binary("", &bad)),
        (Place::Byte(84 + 2 * 50 + 12 + 4 * 4), Fault::NotFinite { value: f64::NEG_INFINITY })
    );
}

#[test]
fn ascii_faults_are_named_by_line() {
    assert_eq!(error(""), (Place::Whole, Fault::Empty));
    let column = |line, column| Place::Column { line, column };
    let with = |line: usize, to: &str| {
        let text = ascii();
        let mut lines: Vec<&str> = text.lines().collect();
        lines[line - 1] = to;
        error(lines.join("\n"))
    };
    assert!(matches!(with(1, "o cube"), (Place::Line(1), Fault::WrongMagic { .. })));
    assert!(matches!(
        with(2, "fcaet"),
        (Place::Line(2), Fault::BadEntry { entry: "the line", .. })
    ));
    assert_eq!(with(5, "vertex 1 a 3"), (column(5, 2), Fault::NotANumber { found: "a".into() }));
    assert!(matches!(
        with(5, "vertex 1 2 nan"),
        (Place::Column { line: 5, column: 3 }, Fault::NotFinite { .. })
    ));
    let short = Fault::RowLength { expected: 3, found: 2 };
    assert_eq!(with(5, "vertex 1 2"), (Place::Line(5), short));
    assert_eq!(with(5, ""), (Place::Line(8), Fault::Corners { found: 2, expected: "3" }));
    assert!(matches!(with(30, ""), (Place::Line(29), Fault::UnexpectedEnd { .. })));
    assert_eq!(error("solid\nendsolid\n"), (Place::Whole, Fault::NoTriangles));
    assert!(matches!(error("solid\nendsolid\nsolid\n").1, Fault::UnexpectedEnd { .. }));
}

/// They were read as binary, with a count of triangles that no file has.
#[test]
fn files_of_other_formats_are_told_by_how_they_begin() {
    for begin in ["ply\nformat binary_little_endian 1.0\n", "# .PCD v0.7\n", "PK\x03\x04"] {
        let bytes = [begin.as_bytes(), &[0; 200]].concat();
        let message = stl::parse(&bytes).unwrap_err().to_string();
        assert!(message.contains("is the file extension right?"), "{message}");
    }
}
