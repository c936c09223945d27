//! PCD files: every encoding and quirk, and every way a header or row can be wrong.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_geom::{Covariance, Point3, Pose, Vector3};
use cloudtouch_io::{Fault, FormatError, Place, pcd};

/// A header for fields of one value each.
fn header(fields: &str, size: &str, kind: &str, points: usize, data: &str) -> String {
    format!(
        "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\nFIELDS {fields}\nSIZE {size}\n\
         TYPE {kind}\nWIDTH {points}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\n\
         DATA {data}\n"
    )
}

fn ascii(rows: &str, points: usize) -> Vec<u8> {
    (header("x y z", "4 4 4", "F F F", points, "ascii") + rows).into_bytes()
}

fn error(bytes: &[u8]) -> (Place, Fault) {
    let FormatError { place, fault } = pcd::parse(bytes).unwrap_err();
    (place, fault)
}

/// The header above with one line replaced.
fn with_line(starts: &str, replacement: &str) -> Vec<u8> {
    let text = String::from_utf8(ascii("1 2 3\n", 1)).unwrap();
    let lines = text.lines().map(|l| if l.starts_with(starts) { replacement } else { l });
    lines.collect::<Vec<_>>().join("\n").into_bytes()
}

#[test]
fn ascii_takes_padded_columns_comments_crlf_and_missing_returns() {
    let text =
        String::from_utf8(ascii("1.5     -2.25\t 3e-1  \n# note\nnan nan NaN\n", 2)).unwrap();
    for bytes in [text.clone(), text.replace('\n', "\r\n")] {
        let cloud = pcd::parse(bytes.as_bytes()).unwrap();
        assert_eq!(cloud.points[0], Point3::new(1.5, -2.25, 0.3));
        assert!(cloud.points[1].iter().all(|v| v.is_nan()));
        assert_eq!((cloud.len(), cloud.image_size), (2, None));
    }
}

#[test]
fn padding_fields_and_counts_are_passed_over_in_every_encoding() {
    let head = |data: &str| {
        format!(
            "FIELDS rgb z _ x y\nSIZE 4 8 1 4 2\nTYPE F F U F I\nCOUNT 1 1 4 1 1\nPOINTS 2\n\
             DATA {data}\n"
        )
    };
    let expected = vec![Point3::new(0.5, -7.0, 4e6 + 0.001), Point3::new(1.5, 9.0, -1.0)];
    let text = head("ascii") + "1 4000000.001 0 0 128 63 0.5 -7\n2 -1 0 0 0 0 1.5 9\n";
    assert_eq!(pcd::parse(text.as_bytes()).unwrap().points, expected);

    let mut binary = head("binary").into_bytes();
    let mut columns: [Vec<u8>; 5] = Default::default();
    for point in &expected {
        let fields: [&[u8]; 5] = [
            &1_f32.to_le_bytes(),
            &point.z.to_le_bytes(),
            &[0, 0, 128, 63],
            &(point.x as f32).to_le_bytes(),
            &(point.y as i16).to_le_bytes(),
        ];
        for (column, field) in columns.iter_mut().zip(fields) {
            binary.extend(field);
            column.extend(field);
        }
    }
    assert_eq!(pcd::parse(&binary).unwrap().points, expected);
    // A page of padding may follow, as in real files.
    binary.extend([0; 4096]);
    assert_eq!(pcd::parse(&binary).unwrap().points, expected);
    let start = head("binary").len();
    binary.push(1);
    assert_eq!(error(&binary), (Place::Byte(start + 44), Fault::Leftover { promised: 2 }));

    let packed = compressed(&head("binary_compressed"), &columns.concat());
    assert_eq!(pcd::parse(&packed).unwrap().points, expected);
    let padded = [&packed[..], &[0; 4096]].concat();
    assert_eq!(pcd::parse(&padded).unwrap().points, expected);
    let longer = [&packed[..], &[1]].concat();
    assert_eq!(error(&longer), (Place::Byte(packed.len()), Fault::Leftover { promised: 2 }));
}

fn compressed(head: &str, unpacked: &[u8]) -> Vec<u8> {
    // Literal runs: what is this short need not get shorter.
    let packed: Vec<u8> = unpacked
        .chunks(32)
        .flat_map(|run| std::iter::once(run.len() as u8 - 1).chain(run.iter().copied()))
        .collect();
    let mut bytes = head.as_bytes().to_vec();
    bytes.extend((packed.len() as u32).to_le_bytes());
    bytes.extend((unpacked.len() as u32).to_le_bytes());
    bytes.extend(packed);
    bytes
}

#[test]
fn all_number_types_are_read() {
    for (kind, size, low) in [("I", 1, true), ("I", 2, true), ("I", 4, true), ("I", 8, true)]
        .into_iter()
        .chain([("U", 1, false), ("U", 2, false), ("U", 4, false), ("U", 8, false)])
    {
        let triple = |v: &str| [v; 3].join(" ");
        let head = header("x y z", &triple(&size.to_string()), &triple(kind), 1, "binary");
        let mut bytes = head.into_bytes();
        for value in [1_i64, 100, if low { -2 } else { 3 }] {
            bytes.extend(&value.to_le_bytes()[..size]);
        }
        let z = if low { -2.0 } else { 3.0 };
        let cloud = pcd::parse(&bytes).unwrap();
        assert_eq!(cloud.points, [Point3::new(1.0, 100.0, z)], "{kind}{size}");
    }
}

#[test]
fn doubles_keep_the_millimetres_of_map_coordinates() {
    let point = Point3::new(512_700.883, 5_403_547.501, 295.25);
    let mut bytes = header("x y z", "8 8 8", "F F F", 1, "binary").into_bytes();
    point.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    assert_eq!(pcd::parse(&bytes).unwrap().points, [point]);
    let text = header("x y z", "8 8 8", "F F F", 1, "ascii") + "512700.883 5403547.501 295.25";
    assert_eq!(pcd::parse(text.as_bytes()).unwrap().points, [point]);
}

#[test]
fn viewpoint_gives_the_pose_of_the_sensor_and_points_stay() {
    let read = |line| pcd::parse(&with_line("VIEWPOINT", line)).unwrap();
    let cloud = read("VIEWPOINT 1 2.5 -3 0 1 0 0");
    assert_eq!(cloud.sensor_origin(), Point3::new(1.0, 2.5, -3.0));
    assert_eq!(cloud.points, [Point3::new(1.0, 2.0, 3.0)]);
    // Half a turn about x: the rotation was dropped.
    let looks = cloud.from_sensor().transform_vector(&Vector3::z());
    assert!((looks + Vector3::z()).norm() < 1e-15, "{looks}");
    let unturned = Pose::from_translation(Vector3::new(1.0, 2.5, -3.0));
    assert_eq!(read("VIEWPOINT 1 2.5 -3").sensor_pose, Some(unturned));
    // What writers put that do not know.
    assert_eq!(read("VIEWPOINT 0 0 0 1 0 0 0").sensor_pose, None);
    let quarter = read("VIEWPOINT 0 0 0 0.70711 0 0.70711 0").from_sensor();
    assert!((quarter.transform_vector(&Vector3::z()) - Vector3::x()).norm() < 1e-12);
    for (line, fault) in [
        ("VIEWPOINT 0 0 0 1 0", Fault::RowLength { expected: 7, found: 5 }),
        (
            "VIEWPOINT 0 0 0 0 0 0 0",
            Fault::BadEntry {
                entry: "VIEWPOINT",
                found: "0 0 0 0 0 0 0".into(),
                expected: "a position and a quaternion w x y z of length one",
            },
        ),
    ] {
        assert_eq!(error(&with_line("VIEWPOINT", line)), (Place::Line(8), fault));
    }
    assert_eq!(
        error(&with_line("VIEWPOINT", "VIEWPOINT 1 2 x")),
        (Place::Column { line: 8, column: 3 }, Fault::NotANumber { found: "x".into() })
    );
    assert_eq!(
        error(&with_line("VIEWPOINT", "VIEWPOINT inf 2 x")),
        (Place::Column { line: 8, column: 1 }, Fault::NotFinite { value: f64::INFINITY })
    );
    assert_eq!(
        error(&with_line("VIEWPOINT", "VIEWPOINT 1 2")),
        (Place::Line(8), Fault::RowLength { expected: 3, found: 2 })
    );
}

#[test]
fn organised_clouds_keep_their_size() {
    let text = "COLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 3\nDATA ascii\n".to_owned()
        + &"1 2 3\n".repeat(6);
    assert_eq!(pcd::parse(text.as_bytes()).unwrap().image_size, Some((2, 3)));
    // One column is a list, not an image.
    let text = text.replace("WIDTH 2\nHEIGHT 3", "WIDTH 1\nHEIGHT 6");
    assert_eq!(pcd::parse(text.as_bytes()).unwrap().image_size, None);
}

#[test]
fn no_points_are_a_cloud_too() {
    for data in ["ascii", "binary", "binary_compressed"] {
        let bytes = header("x y z", "4 4 4", "F F F", 0, data);
        assert!(pcd::parse(bytes.as_bytes()).unwrap().is_empty(), "{data}");
        let more = bytes + "1 2 3\n";
        assert_eq!(error(more.as_bytes()).1, Fault::Leftover { promised: 0 }, "{data}");
    }
}

#[test]
fn covariance_columns_are_read_and_checked() {
    let head = |points| {
        header(
            "x y z cov_xx cov_xy cov_xz cov_yy cov_yz cov_zz",
            "8 8 8 8 8 8 8 8 8",
            "F F F F F F F F F",
            points,
            "ascii",
        )
    };
    let good = "0 0 1 4e-4 0 0 1e-4 0 9e-4\nnan nan nan nan nan nan nan nan nan\n";
    let cloud = pcd::parse((head(2) + good).as_bytes()).unwrap();
    let expected = [Covariance::diagonal([4e-4, 1e-4, 9e-4]), Covariance::zero()];
    assert_eq!(cloud.covariances.as_deref(), Some(&expected[..]));

    let bad = head(3) + good + "0 0 1 -4e-4 0 0 1e-4 0 9e-4\n";
    let (place, fault) = error(bad.as_bytes());
    assert_eq!(place, Place::Line(13));
    assert!(matches!(&fault, Fault::Covariance { row: 2, .. }));
    assert!(fault.to_string().starts_with("point 2: covariance has the negative eigenvalue"));

    let partial = head(1).replace("cov_yz", "normal");
    let expected = (Place::Line(3), Fault::MissingColumn { name: "cov_yz" });
    assert_eq!(error(partial.as_bytes()), expected);
}

#[test]
fn bad_headers_are_named_by_line() {
    let bad = |entry: &'static str, found: &str, expected: &'static str| Fault::BadEntry {
        entry,
        found: found.into(),
        expected,
    };
    let per_field = "one value for each of FIELDS";
    let cases = [
        ("FIELDS", "FIELDS x y i", 3, Fault::MissingColumn { name: "z" }),
        ("FIELDS", "FIELDS x y x", 3, Fault::Repeated { entry: "the column x".into() }),
        ("FIELDS", "FIELDS x y", 4, bad("SIZE", "4 4 4", per_field)),
        ("SIZE", "SIZE 4 4", 4, bad("SIZE", "4 4", per_field)),
        ("SIZE", "SIZE 4 4 four", 4, bad("SIZE", "four", "1, 2, 4 or 8")),
        // It was told of the line of types.
        ("SIZE", "SIZE 4 4 3", 4, bad("SIZE", "3", "1, 2, 4 or 8")),
        (
            "SIZE",
            "SIZE 4 4 2",
            5,
            bad("TYPE", "F F F", "I or U with SIZE 1, 2, 4 or 8, or F with 4 or 8"),
        ),
        (
            "TYPE",
            "TYPE F F D",
            5,
            bad("TYPE", "F F D", "I or U with SIZE 1, 2, 4 or 8, or F with 4 or 8"),
        ),
        ("TYPE", "COUNT 1 1 1", 10, Fault::MissingEntry { entry: "TYPE" }),
        ("VERSION", "COUNT 1 0 1", 2, bad("COUNT", "0", "a whole number from 1")),
        ("VERSION", "COUNT 1 2 1", 3, bad("COUNT", "2", "1 for coordinates and covariances")),
        ("WIDTH", "WIDTH -1", 6, bad("WIDTH", "-1", "a whole number from 0")),
        ("HEIGHT", "HEIGHT 2", 9, Fault::PointCount { points: 1, width: 1, height: 2 }),
        ("HEIGHT", "WIDTH 2", 7, Fault::Repeated { entry: "WIDTH".into() }),
        ("POINTS", "POINTS 2", 9, Fault::PointCount { points: 2, width: 1, height: 1 }),
        ("DATA", "DATA zipped", 10, bad("DATA", "zipped", "ascii, binary or binary_compressed")),
    ];
    for (starts, replacement, line, fault) in cases {
        assert_eq!(error(&with_line(starts, replacement)), (Place::Line(line), fault));
    }
    let text = with_line("POINTS", "PIONTS 1");
    let text = String::from_utf8(text).unwrap().replace("WIDTH 1\n", "");
    assert_eq!(error(text.as_bytes()), (Place::Line(9), Fault::MissingEntry { entry: "POINTS" }));
}

#[test]
fn files_of_another_kind_and_empty_files_are_refused() {
    assert_eq!(error(b""), (Place::Whole, Fault::Empty));
    let (place, fault) = error(b"ply\nformat ascii 1.0\n");
    assert_eq!(place, Place::Line(1));
    assert!(matches!(fault, Fault::WrongMagic { found, .. } if found == "ply"));
    assert!(matches!(
        error(b"VERSION .7\nFIELDS x y z\n"),
        (Place::Line(2), Fault::UnexpectedEnd { .. })
    ));
}

#[test]
fn bad_rows_are_named_by_line_and_column() {
    let row = |rows: &str, points| error(&ascii(rows, points));
    let column = |line, column| Place::Column { line, column };
    assert_eq!(
        row("1 2 3\n1 2,5 3\n", 2),
        (column(12, 2), Fault::NotANumber { found: "2,5".into() })
    );
    assert_eq!(row("1 2\n", 1), (Place::Line(11), Fault::RowLength { expected: 3, found: 2 }));
    assert_eq!(row("1 2 3 4\n", 1), (Place::Line(11), Fault::RowLength { expected: 3, found: 4 }));
    assert_eq!(row("1 2 3\n", 2), (Place::Line(11), Fault::FewRows { promised: 2, found: 1 }));
    assert_eq!(row("1 2 3\n4 5 6\n", 1), (Place::Line(12), Fault::Leftover { promised: 1 }));
}

#[test]
fn promises_the_file_does_not_keep_cost_no_memory() {
    for (data, points) in [("binary", 2), ("binary", usize::MAX), ("binary_compressed", 1 << 40)] {
        let mut bytes = header("x y z", "4 4 4", "F F F", points, data).into_bytes();
        let start = bytes.len();
        bytes.extend([0; 12]);
        let (place, fault) = error(&bytes);
        assert_eq!(place, Place::Byte(start));
        match data {
            "binary" => assert_eq!(
                fault,
                Fault::TooShort {
                    promised: points,
                    needed: points.saturating_mul(12),
                    available: 12
                }
            ),
            _ => assert!(matches!(fault, Fault::Compression { .. })),
        }
    }
    let text = header("x y z", "4 4 4", "F F F", usize::MAX, "ascii") + "1 2 3\n";
    let promised = usize::MAX;
    assert_eq!(error(text.as_bytes()).1, Fault::FewRows { promised, found: 1 });
    let counts = text.replace("WIDTH", "COUNT 1 1 1 18446744073709551615\nWIDTH");
    let counts = counts.replace("x y z", "x y z _").replace("4 4 4", "4 4 4 8");
    let counts = counts.replace("F F F", "F F F U");
    for data in ["ascii", "binary", "binary_compressed"] {
        error(counts.replace("DATA ascii", &format!("DATA {data}")).as_bytes());
    }
}

#[test]
fn damaged_compression_is_told_apart() {
    let head = header("x y z", "4 4 4", "F F F", 2, "binary_compressed");
    let whole = compressed(&head, &[7; 24]);
    assert_eq!(pcd::parse(&whole).unwrap().len(), 2);
    let start = head.len();
    let reason = |bytes: &[u8]| match error(bytes) {
        (Place::Byte(at), Fault::Compression { reason }) if at == start => reason,
        other => panic!("{other:?}"),
    };
    assert!(matches!(
        error(&whole[..whole.len() - 1]),
        (Place::Byte(_), Fault::TooShort { promised: 2, needed: 33, available: 32 })
    ));
    assert!(matches!(
        error(&whole[..start + 5]).1,
        Fault::TooShort { needed: 8, available: 5, .. }
    ));
    assert!(reason(&compressed(&head, &[7; 23])).contains("POINTS times"));
    let announce = |packed: &[u8]| {
        let mut bytes = head.clone().into_bytes();
        bytes.extend((packed.len() as u32).to_le_bytes());
        bytes.extend(24_u32.to_le_bytes());
        bytes.extend(packed);
        bytes
    };
    assert!(reason(&announce(&[])).contains("too short"));
    assert!(reason(&announce(&[0, 7])).contains("less than"));
    assert!(reason(&announce(&[&[31][..], &[7; 32]].concat())).contains("more than"));
    assert!(reason(&announce(&[0xe0, 0xff, 0xff])).contains("more than"));
    assert!(reason(&announce(&[0x20, 0xff])).contains("not a valid"));
}
