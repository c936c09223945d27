//! Tables of coordinates: separators, names, comments, and what can be wrong with a row.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_geom::{Covariance, Point3};
use cloudtouch_io::{Fault, Place, xyz};

fn points(text: &str) -> Vec<Point3> {
    xyz::parse(text.as_bytes()).unwrap().points
}

fn error(text: &str) -> (Place, Fault) {
    let error = xyz::parse(text.as_bytes()).unwrap_err();
    (error.place, error.fault)
}

#[test]
fn every_separator_and_header_gives_the_same_points() {
    let expected = [Point3::new(1.0, -2.5, 3e-3), Point3::new(4.0, 5.0, 6.0)];
    for text in [
        "1 -2.5 3e-3\n4 5 6",
        "  1\t-2.5   .003 \r\n\r\n4 5 6\r\n",
        "# x y z\n1,-2.5,0.003 # first\n4, 5 ,6\n",
        "1;-2.5;0.003;\n4;5;6;7\n",
        "1 -2.5 0.003 lamp post\n4 5 6\n",
        "x,y,z\n1,-2.5,0.003\n4,5,6\n",
        "//X Y Z\n1 -2.5 0.003\n4 5 6\n",
        "\u{feff}\"id\";\"z\";\"x\";\"note\";\"y\"\n7;0.003;1;;-2.5\n8;6;4;a, b;5\n",
    ] {
        assert_eq!(points(text), expected, "{text:?}");
    }
    assert!(points("x y z\n").is_empty());
}

#[test]
fn missing_returns_stay() {
    let read = points("nan nan nan\n1 2 NaN\n");
    assert!(read[0].x.is_nan() && read[1].z.is_nan() && read[1].y == 2.0);
}

#[test]
fn covariance_columns_are_read_and_checked() {
    let head = "x y z cov_xx cov_xy cov_xz cov_yy cov_yz cov_zz\n";
    let cloud = xyz::parse((head.to_owned() + "1 2 3 4 0 0 1 0 0.25\n").as_bytes()).unwrap();
    assert_eq!(cloud.covariances, Some(vec![Covariance::diagonal([4.0, 1.0, 0.25])]));
    let (place, fault) = error(&(head.to_owned() + "1 2 3 4 9 0 1 0 0.25\n"));
    assert_eq!(place, Place::Line(2));
    assert!(matches!(fault, Fault::Covariance { row: 0, .. }));
    assert_eq!(
        error(&head.replace("cov_xx", "var")),
        (Place::Line(1), Fault::MissingColumn { name: "cov_xx" })
    );
}

/// As `numpy.savetxt` writes a header; the first three columns were x, y and z whatever it said.
#[test]
fn a_comment_that_names_every_column_is_a_header() {
    let point = |text: &str| xyz::parse(text.as_bytes()).unwrap().points[0];
    let expected = Point3::new(1.0, 2.0, 3.0);
    for text in [
        "# y,x,z\n2,1,3\n",
        "# from a bag\n# t x y z\n9 1 2 3\n",
        "#intensity;x;y;z\n9;1;2;3\n",
        "# y,x,z\n2 1 3\n",
        // Words that are not one for each number are prose.
        "# x y z of the room, in metres\n1 2 3\n",
        "# z y x and an intensity\n1 2 3 9\n",
        // The names are not always the last: these rows were read from their first column on.
        "# index x y z\n# sensor: a camera\n9 1 2 3\n",
        "# y x z\n# saved 2026\n2 1 3\n",
        // Only what stands before the first row.
        "1 2 3\n# y x z\n2 1 3\n",
    ] {
        assert_eq!(point(text), expected, "{text}");
    }
}

/// The cloud lay along its times, tens of metres from where it was, and all was free there.
#[test]
fn a_first_column_of_times_or_row_numbers_was_taken_for_x() {
    let rows = |between: char, first: fn(usize) -> String| -> String {
        let row = |i| format!("{}{between}0.{}{between}1{between}2\n", first(i), i % 3);
        (0..12).map(row).collect()
    };
    let rounded = rows(' ', |i| format!("{:.3}", 1e9 + i as f64 / 30.0));
    for (text, header) in [
        (rows(',', |i| format!("{}", i + 1)), "t,x,y,z"),
        (rows(';', |i| format!("{}", 0.1 * i as f64)), "t;x;y;z"),
        ("# a scan\n".to_owned() + &rounded, "t x y z"),
    ] {
        let (place, fault) = error(&text);
        assert_eq!(place, Place::Line(1 + usize::from(text.starts_with('#'))));
        assert!(fault.to_string().contains(&format!("such as `{header}`")), "{fault}");
        assert_eq!(points(&format!("{header}\n{text}")).len(), 12);
    }
    let (_, fault) = error(&rows(',', |i| format!("{}", 0.5 * i as f64)));
    let told = "grows by 0.5 in each of 12 rows, from 0, as a time or a row number does";
    assert!(fault.to_string().contains(told), "{fault}");
    // A grid goes back to its first x, few rows may be chance, and three columns leave none for z.
    assert_eq!(points(&rows(',', |i| format!("{}", i % 6))).len(), 12);
    assert_eq!(points("1 0 0 9\n2 0 0 9\n3 0 0 9\n").len(), 3);
    assert_eq!(points(&rows(' ', |i| format!("{i}")).replace(" 2\n", "\n")).len(), 12);
    assert_eq!(
        points(&rows(',', |i| format!("{}", 0.1 * i as f64 + 0.02 * (i % 2) as f64))).len(),
        12
    );
}

#[test]
fn names_may_have_a_unit_or_be_those_of_paraview() {
    let expected = [Point3::new(1.0, 2.0, 3.0)];
    for text in [
        "x (m),y (m),z (m)\n1,2,3\n",
        "t [s];X [m];Y[m];Z(m)\n9;1;2;3\n",
        "x (m) y (m) z (m)\n1 2 3\n",
        "# z [m] y [m] x [m]\n3 2 1\n",
        "\"Normals:0\",\"Points:0\",\"Points:1\",\"Points:2\"\n9,1,2,3\n",
    ] {
        assert_eq!(points(text), expected, "{text}");
    }
    let unit = |unit: &str| Fault::ColumnUnit { column: "x".into(), unit: unit.into() };
    assert_eq!(error("x [mm],y [mm],z [mm]\n1,2,3\n"), (Place::Line(1), unit("mm")));
    assert_eq!(error("# x (ft) y (ft) z (ft)\n1 2 3\n"), (Place::Line(2), unit("ft")));
    assert!(unit("mm").to_string().contains("name it x alone, and state that unit"));
    // No name of a column, though it has a bracket.
    assert_eq!(points("# a scan at x (see the log) of today\n1 2 3\n"), expected);
}

/// As a `.pts` begins; it was told to have a value too few.
#[test]
fn a_count_before_the_points_is_told_as_such() {
    let (place, fault) = error("18300\n1 2 3\n");
    assert_eq!((place, &fault), (Place::Line(1), &Fault::CountLine { found: "18300".into() }));
    assert!(fault.to_string().contains(".pts begins with: remove it"), "{fault}");
}

#[test]
fn faults_are_named_by_line_and_column() {
    let not_a_number = |found: &str| Fault::NotANumber { found: found.into() };
    let column = |line, column| Place::Column { line, column };
    assert_eq!(error(""), (Place::Whole, Fault::Empty));
    assert_eq!(error("# nothing\n\n"), (Place::Whole, Fault::Empty));
    assert_eq!(error("1 2 3\n# c\n1 two 3\n"), (column(3, 2), not_a_number("two")));
    // A decimal comma must not turn three numbers into six.
    assert_eq!(error("1,5;2,5;3,5\n").0, Place::Line(1));
    assert_eq!(error("x;y;z\n1,5;2,5;3,5\n"), (column(2, 1), not_a_number("1,5")));
    assert_eq!(error("1,5 2,5 3,5\n"), (column(1, 2), not_a_number("5 2")));
    assert_eq!(error("1,,3\n"), (column(1, 2), not_a_number("")));
    assert_eq!(error("1 2 3\n4 5\n"), (Place::Line(2), Fault::RowLength { expected: 3, found: 2 }));
    assert_eq!(error("x,y\n1,2\n"), (Place::Line(1), Fault::MissingColumn { name: "z" }));
    assert_eq!(
        error("x,y,z,y\n"),
        (Place::Line(1), Fault::Repeated { entry: "the column y".into() })
    );
    let (place, fault) = error("one 2 3\n");
    assert_eq!(place, Place::Line(1));
    assert!(
        matches!(fault, Fault::BadEntry { entry: "the first row", found, .. } if found == "one 2 3")
    );
}

#[test]
fn an_empty_value_between_tabs_moved_the_others_to_its_left() {
    let short = |line, found| (Place::Line(line), Fault::RowLength { expected: 4, found });
    assert_eq!(error("x\ty\tz\ti\n1\t2\t3\t4\n1\t\t3\t4\n"), short(3, 3));
    assert_eq!(error("# x\ty\tz\ti\n1 2 3 4\n\t2\t3\t4\n"), short(3, 3));
    assert_eq!(error("1\t2\t3\t4\n\t2\t3\t4\n"), short(2, 3));
    // Values with spaces in them, after the coordinates, are no matter.
    assert_eq!(points("x y z name\n1 2 3 a lid\n").len(), 1);
    assert_eq!(points("1 2 3 a lid\n1 2 3\n").len(), 2);
    // Where commas show it, an empty value of another column is one.
    assert_eq!(points("x,y,z,i\n1,2,3,\n1,2,3\n").len(), 2);
}

/// What Windows PowerShell redirects into a file was told to have no numbers in its first row.
#[test]
fn text_in_utf_16_is_told_as_such() {
    let two_bytes = |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        std::iter::once(0xfeff).chain("1 2 3\r\n".encode_utf16()).flat_map(bytes).collect()
    };
    for text in [two_bytes(u16::to_le_bytes), two_bytes(u16::to_be_bytes)] {
        let error = xyz::parse(&text).unwrap_err().to_string();
        assert!(error.contains("UTF-16: save it as UTF-8"), "{error}");
    }
}

/// The columns after it moved one to the right: the cloud lay where nothing was, and all was free there.
#[test]
fn a_comma_in_quotes_or_for_a_decimal_point_moved_the_columns() {
    let expected = [Point3::new(1.0, 2.0, 3.0)];
    for text in [
        "label,id,x,y,z\n\"a, b\",7,1,2,3\n",
        "label;id;x;y;z\n \"a;b\" ;7;1;2;3\n",
        "label,id,x,y,z\n\"a \"\"b\"\", c\",7,1,2,3\n",
        "label,id,x,y,z\n\"\",7,1,2,3\n",
        "label,x,y,z\n\"a,1,2,3\n",
        "x,y,z,label\n1,2,3,\"a, b\"\n",
        // A separator at the end, as some programs write it.
        "x,y,z\n1,2,3,\n",
        "x;y;z\n1;2;3; ;\n",
        // What comes after the coordinates moves none.
        "id x y z name\n7 1 2 3 a lid\n",
    ] {
        assert_eq!(points(text), expected, "{text}");
    }
    let surplus = |line, names, found| (Place::Line(line), Fault::SurplusValues { names, found });
    assert_eq!(error("x,y,z\n1,2,3\n1,5,2,5,3,5\n"), surplus(3, 3, 6));
    assert_eq!(error("# x,y,z\n1,2,3\n1,5,2,5,3,5\n"), surplus(3, 3, 6));
    assert_eq!(error("label,id,x,y,z\na, b,7,1,2,3\n"), surplus(2, 5, 6));
    assert_eq!(error("label\tid\tx\ty\tz\na lid\t7\t1\t2\t3\n"), surplus(2, 5, 6));
    let (_, fault) = error("x,y,z\n1,5,2,5,3,5\n");
    assert!(fault.to_string().contains("write decimals with a point"), "{fault}");
}
