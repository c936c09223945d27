//! Messages of ROS: every layout they come in, and what is wrong in one.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::ros;
use crate::ros::{ENCODINGS, Message, Wire, field};
use cloudtouch_geom::{Covariance, Point3};
use cloudtouch_io::pointcloud2::{Encoding, parse, parse_within};
use cloudtouch_io::{Fault, Place, ReadLimits};
use proptest::prelude::*;

fn triple() -> Message {
    Message::of_points(&[[0.5, -1.25, 2.0], [f32::NAN; 3], [3.0, 4.0, 5.0], [6.0, 7.0, 8.0]])
}

#[test]
fn every_encoding_gives_the_same_scan() {
    let message = triple();
    for wire in ENCODINGS {
        let scan = parse(&message.bytes(wire), wire.encoding()).unwrap();
        assert_eq!((scan.frame_id.as_str(), scan.stamp_ns), ("lidar", 12_000_000_345), "{wire:?}");
        let cloud = scan.cloud;
        assert_eq!(cloud.points[0], Point3::new(0.5, -1.25, 2.0));
        assert!(cloud.points[1].iter().all(|v| v.is_nan()));
        assert_eq!((cloud.len(), cloud.image_size, &cloud.covariances), (4, None, &None));
        assert_eq!(cloud.sensor_origin(), Point3::origin());
    }
}

#[test]
fn an_image_has_several_rows_and_columns() {
    for (width, height, image) in [(2, 2, Some((2, 2))), (1, 4, None), (4, 1, None)] {
        let message = Message { width, height, row_step: width * 12, ..triple() };
        let scan = parse(&message.bytes(Wire::Ros1), Encoding::Ros1).unwrap();
        assert_eq!((scan.cloud.len(), scan.cloud.image_size), (4, image));
    }
}

#[test]
fn bytes_between_points_and_rows_are_passed_over() {
    let mut message = Message {
        fields: vec![
            field("z", 1, 3, 1),
            field("ring", 0, 2, 1),
            field("X", 4, 8, 0),
            field("weird", 900, 77, 5),
            field("y", 12, 6, 1),
        ],
        width: 1,
        height: 2,
        point_step: 17,
        row_step: 20,
        data: Vec::new(),
        ..triple()
    };
    for (x, y, z) in [(0.1_f64, 4_000_000_000_u32, -7_i16), (1e300, 1, 300)] {
        let row = [&[0xff][..], &z.to_be_bytes(), &[0xee], &x.to_be_bytes(), &y.to_be_bytes()];
        message.data.extend(row.concat());
        message.data.extend([0xdd; 4]);
    }
    message.big_endian = 1;
    let points = [Point3::new(0.1, 4e9, -7.0), Point3::new(1e300, 1.0, 300.0)];
    // The padding of the last row may be missing.
    for wire in ENCODINGS {
        for length in [40, 37] {
            let message = Message { data: message.data[..length].to_vec(), ..message.clone() };
            assert_eq!(parse(&message.bytes(wire), wire.encoding()).unwrap().cloud.points, points);
        }
    }
}

#[test]
fn one_row_needs_no_row_step() {
    let message = Message { row_step: 0, ..triple() };
    assert_eq!(parse(&message.bytes(Wire::LittleCdr), Encoding::Cdr).unwrap().cloud.len(), 4);
}

#[test]
fn covariances_come_along() {
    let names = ["x", "y", "z", "cov_xx", "cov_xy", "cov_xz", "cov_yy", "cov_yz", "cov_zz"];
    let values = [1.0_f32, 2.0, 3.0, 4.0, 0.0, 0.0, 1.0, 0.0, 0.25];
    let message = Message {
        fields: (0..).zip(names).map(|(i, name)| field(name, 4 * i, 7, 1)).collect(),
        width: 1,
        point_step: 36,
        row_step: 36,
        data: values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        ..triple()
    };
    let cloud = parse(&message.bytes(Wire::Ros1), Encoding::Ros1).unwrap().cloud;
    assert_eq!(cloud.covariances, Some(vec![Covariance::diagonal([4.0, 1.0, 0.25])]));
    let mut broken = message;
    broken.data[12..16].copy_from_slice(&(-4.0_f32).to_le_bytes());
    let error = parse(&broken.bytes(Wire::Ros1), Encoding::Ros1).unwrap_err();
    assert!(matches!(error.fault, Fault::Covariance { row: 0, .. }), "{error}");
}

/// The message of a message that is wrong.
fn complaint(message: &Message) -> String {
    parse(&message.bytes(Wire::LittleCdr), Encoding::Cdr).unwrap_err().to_string()
}

#[test]
fn errors_say_where_what_and_what_to_do() {
    let good = triple();
    let with_x =
        |x| Message { fields: vec![x, field("y", 4, 7, 1), field("z", 8, 7, 1)], ..triple() };
    for (message, expected) in [
        (with_x(field("x", 0, 9, 1)), "byte 36: the datatype of a field is \"9\", expected 1 to 8"),
        (with_x(field("x", 0, 7, 3)), "byte 36: the count of a field is \"3\", expected 1"),
        (with_x(field("x", 9, 7, 1)), "the offset of a field is \"9\", expected a place within"),
        (with_x(field("x", u32::MAX, 7, 1)), "is \"4294967295\", expected a place within"),
        // Read without a word, with a half of each in the other.
        (with_x(field("x", 6, 7, 1)), "the offset of a field is \"4\", expected a place that no"),
        (with_x(field("i", 0, 7, 1)), "byte 32: there is no column x"),
        (with_x(field("Y", 0, 7, 1)), "byte 32: the column y appears a second time"),
        (Message { big_endian: 2, ..good.clone() }, "is_bigendian is \"2\", expected 0 or 1"),
        (Message { width: 5, ..good.clone() }, "promises 5 rows, which take 60 bytes, and 48"),
        (Message { width: 3, row_step: 36, ..good.clone() }, "promises 3 rows, and more data"),
        (Message { width: 2, height: 2, row_step: 23, ..good.clone() }, "row_step is \"23\""),
        (Message { point_step: 0, ..good.clone() }, "expected a place within point_step"),
        (Message { width: u32::MAX, ..good.clone() }, "at most 10000000 are read"),
        (Message { width: 0, height: u32::MAX, ..good.clone() }, "promises 0 rows, and more data"),
    ] {
        let complaint = complaint(&message);
        assert!(complaint.contains(expected), "{complaint}\nhas no\n{expected}");
        assert!(complaint.starts_with("byte "), "{complaint}");
    }
    // A message taken for one of the other encoding.
    let error = parse(&good.bytes(Wire::LittleCdr), Encoding::Ros1).unwrap_err();
    assert!(error.to_string().contains("encoding"), "{error}");
    let error = parse(&good.bytes(Wire::Ros1), Encoding::Cdr).unwrap_err();
    assert_eq!(error.place, Place::Byte(0));
    let more = [good.bytes(Wire::Ros1), vec![1]].concat();
    let error = parse(&more, Encoding::Ros1).unwrap_err();
    assert!(matches!(error.fault, Fault::Leftover { promised: 4 }), "{error}");
}

#[test]
fn an_empty_scan_of_endless_height_ends() {
    let message = Message { width: 0, height: u32::MAX, data: Vec::new(), ..triple() };
    assert!(parse(&message.bytes(Wire::Ros1), Encoding::Ros1).unwrap().cloud.is_empty());
}

#[test]
fn points_are_counted_before_memory_is_taken() {
    let bytes = triple().bytes(Wire::Ros1);
    let limits = |points| ReadLimits { points, ..ReadLimits::default() };
    assert_eq!(parse_within(&bytes, Encoding::Ros1, &limits(4)).unwrap().cloud.len(), 4);
    let error = parse_within(&bytes, Encoding::Ros1, &limits(3)).unwrap_err();
    assert!(matches!(error.fault, Fault::TooMany { what: "points", found: 4, limit: 3 }));
}

#[test]
fn a_message_cut_off_anywhere_is_an_error() {
    for wire in ENCODINGS {
        let bytes = triple().bytes(wire);
        for length in 0..bytes.len() {
            let error = parse(&bytes[..length], wire.encoding()).unwrap_err();
            assert!(matches!(error.fault, Fault::MessageEnd { .. }), "{length}: {error}");
        }
    }
}

/// One field of the message: its type, and the gap before it.
fn any_layout() -> impl Strategy<Value = Vec<(u8, u32)>> {
    prop::collection::vec((1..=8_u8, 0..5_u32), 3)
}

proptest! {
    #[test]
    fn what_is_written_is_read(
        layout in any_layout(),
        order in prop::sample::select(vec![[0, 1, 2], [2, 0, 1], [1, 0, 2]]),
        (width, height) in (0..4_u32, 0..4_u32),
        (step_padding, row_padding) in (0..5_u32, 0..5_u32),
        big_endian in 0..=1_u8,
        wire in prop::sample::select(ENCODINGS.to_vec()),
        frame in "[a-z_/]{0,9}",
        values in prop::collection::vec(-100..100_i8, 48),
    ) {
        let mut offset = 0;
        let mut fields = Vec::new();
        for &axis in &order {
            let (datatype, gap) = layout[axis];
            fields.push(field(["x", "y", "z"][axis], offset + gap, datatype, 1));
            offset += gap + ros::size(datatype);
        }
        let point_step = offset + step_padding;
        let row_step = width * point_step + row_padding;
        let rows = if width == 0 { 0 } else { height };
        let mut data = vec![0xa5; (rows * row_step) as usize];
        let mut expected = Vec::new();
        let mut values = values.into_iter();
        for at in (0..height).flat_map(|v| (0..width).map(move |u| v * row_step + u * point_step)) {
            let mut point = Point3::origin();
            for (&axis, field) in order.iter().zip(&fields) {
                // Types without a sign hold a byte of it.
                let is_unsigned = matches!(field.datatype, 2 | 4 | 6);
                let value = values.next().unwrap();
                let value = if is_unsigned { f64::from(value as u8) } else { f64::from(value) };
                point[axis] = value;
                let bytes = ros::number(value, field.datatype, big_endian == 1);
                let start = (at + field.offset) as usize;
                data[start..start + bytes.len()].copy_from_slice(&bytes);
            }
            expected.push(point);
        }
        let message = Message {
            frame: frame.clone(), fields, width, height, point_step, row_step, data, big_endian,
            ..triple()
        };
        let scan = parse(&message.bytes(wire), wire.encoding()).unwrap();
        prop_assert_eq!(scan.cloud.points, expected);
        prop_assert_eq!(scan.frame_id, frame);
    }

    #[test]
    fn damaged_messages_are_survived(
        wire in prop::sample::select(ENCODINGS.to_vec()),
        damages in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = triple().bytes(wire);
        for (index, byte) in damages {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        match parse(&bytes, wire.encoding()) {
            Ok(scan) => prop_assert!(scan.cloud.len() <= bytes.len()),
            Err(error) => prop_assert!(error.to_string().len() < 500),
        }
    }

    #[test]
    fn arbitrary_bytes_are_survived(noise in prop::collection::vec(any::<u8>(), 0..200)) {
        let cdr = [&[0, 1, 0, 0][..], &noise].concat();
        prop_assert!(parse(&noise, Encoding::Ros1).map_or(0, |scan| scan.cloud.len()) <= 200);
        prop_assert!(parse(&cdr, Encoding::Cdr).map_or(0, |scan| scan.cloud.len()) <= 200);
    }
}
