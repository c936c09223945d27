//! Depth images: where their pixels are, what is missing, and what the messages say.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_geom::{Point3, Pose, Vector3};
use cloudtouch_io::{
    CameraError, DepthCamera, Fault, Place, ReadError, ReadLimits, depth, read_cloud,
    read_depth_image, read_depth_image_within,
};
use png::{BitDepth, ColorType};
use proptest::prelude::*;

/// A 16-bit greyscale PNG of so many columns.
pub(crate) fn png(width: usize, pixels: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = pixels.iter().flat_map(|steps| steps.to_be_bytes()).collect();
    encoded(width, pixels.len() / width, (ColorType::Grayscale, BitDepth::Sixteen), &bytes)
}

fn encoded(width: usize, height: usize, kind: (ColorType, BitDepth), bytes: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(kind.0);
    encoder.set_depth(kind.1);
    if kind.0 == ColorType::Indexed {
        encoder.set_palette(vec![0; 6]);
    }
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
    file
}

/// Of an image of four columns and three rows.
const CAMERA: DepthCamera =
    DepthCamera { fx: 5.0, fy: 4.0, cx: 1.5, cy: 1.0, depth_scale: 0.001, image_size: None };
const PIXELS: [u16; 12] = [1000, 1000, 0, 1000, 65535, 2000, 2000, 2000, 1, 65534, 3, 4];

#[test]
fn rows_and_columns_stay_and_what_did_not_come_back_is_missing() {
    let cloud = depth::parse(&png(4, &PIXELS), &CAMERA).unwrap();
    assert_eq!(cloud.image_size, Some((4, 3)));
    // The frame of the file is its camera's, which need not be said.
    assert_eq!(cloud.sensor_pose, Some(Pose::identity()));
    assert!(cloud.covariances.is_none());
    let missing: Vec<usize> =
        (0..12).filter(|&i| cloud.points[i].iter().all(|v| v.is_nan())).collect();
    assert_eq!(missing, [2, 4]);
    // Column 0 and row 0: left of and above the axis, which is -x and -y.
    assert_eq!(cloud.points[0], Point3::new(-1.5 / 5.0, -1.0 / 4.0, 1.0));
    assert_eq!(cloud.points[7], Point3::new(1.5 / 5.0 * 2.0, 0.0, 2.0));
    assert!((cloud.points[9].z - 65.534).abs() < 1e-12);
    // Of 5000 steps a metre.
    let tum = DepthCamera { depth_scale: 1.0 / 5000.0, ..CAMERA };
    let cloud = depth::parse(&png(4, &PIXELS), &tum).unwrap();
    assert!((cloud.points[7].z - 0.4).abs() < 1e-15);
}

/// 1000 and the row and column as digits, in the order of Adam7.
const INTERLACED: &[u8] =
    b"\x89PNG\x0d\x0a\x1a\x0a\x00\x00\x00\x0dIHDR\x00\x00\x00\x03\x00\x00\x00\x03\
      \x10\x00\x00\x00\x01T\xd4\x06\xb6\x00\x00\x00!IDATx\xdac`~\xc1\xc0\
      \xfc\x8a\x81\xf9\x0f\xf3?\x06\xe6\x97\x0c\xcc\x7f\x19\x98?1\x7ff\xfe\x02\x00^\xc0\
      \x08\xa7 \x8e\xe6\x95\x00\x00\x00\x00IEND\xaeB`\x82";

#[test]
fn interlaced_images_are_read_in_the_order_of_their_rows() {
    let cloud = depth::parse(INTERLACED, &CAMERA).unwrap();
    let steps: Vec<f64> = cloud.points.iter().map(|p| (p.z / 0.001).round()).collect();
    assert_eq!(steps, [1000.0, 1001.0, 1002.0, 1010.0, 1011.0, 1012.0, 1020.0, 1021.0, 1022.0]);
}

#[test]
fn what_is_no_depth_image_is_told_with_what_to_do() {
    let grey = |depth, bytes: &[u8]| encoded(2, 2, (ColorType::Grayscale, depth), bytes);
    let cut = |bytes: Vec<u8>, less: usize| bytes[..bytes.len() - less].to_vec();
    let whole = png(4, &PIXELS);
    let mut damaged = whole.clone();
    let middle = damaged.len() - 20;
    damaged[middle] ^= 1;
    let mut large = whole.clone();
    large[16..20].copy_from_slice(&[0, 0x20, 0, 0]);
    for (bytes, place, parts) in [
        (vec![], None, ["the file is empty", "completely"]),
        (b"P5 4 3 65535\n".to_vec(), Some(0), ["expected a PNG", "extension right"]),
        (grey(BitDepth::Eight, &[9; 4]), Some(24), ["is 8-bit grey", "expected 16-bit grey"]),
        (grey(BitDepth::One, &[0; 2]), Some(24), ["is 1-bit grey", "the depth image itself"]),
        (
            encoded(2, 2, (ColorType::Rgb, BitDepth::Eight), &[9; 12]),
            Some(24),
            ["is 8-bit colour", "neither the colour image"],
        ),
        (
            encoded(2, 2, (ColorType::Rgba, BitDepth::Sixteen), &[9; 32]),
            Some(24),
            ["16-bit colour with transparency", "neither"],
        ),
        (
            encoded(2, 2, (ColorType::GrayscaleAlpha, BitDepth::Sixteen), &[9; 16]),
            Some(24),
            ["16-bit grey with transparency", "neither"],
        ),
        (
            encoded(2, 2, (ColorType::Indexed, BitDepth::Eight), &[0; 4]),
            Some(24),
            ["8-bit with a palette", "picture of the depths"],
        ),
        (png(12, &PIXELS), Some(16), ["12 x 1 pixels", "two rows and columns"]),
        (png(4, &[0; 12]), None, ["none of 12 pixels", "not a mask"]),
        (png(4, &[65535; 12]), None, ["none of 12 pixels", "0 and 65535"]),
        (cut(whole.clone(), 30), None, ["the file ends", "the rest of the image"]),
        // All pixels are there, and the mark at the end is not.
        (cut(whole.clone(), 6), None, ["the file ends", "cut off"]),
        (damaged, None, ["the image is damaged", "again"]),
        ([&whole[..], b"PNG"].concat(), Some(whole.len()), ["more data follows", "remove"]),
        (large, None, ["the image is damaged", "CRC"]),
    ] {
        let error = depth::parse(&bytes, &CAMERA).unwrap_err();
        let message = error.to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        assert_eq!(message.starts_with("byte "), error.place != Place::Whole, "{message}");
        if let Some(place) = place {
            assert_eq!(error.place, Place::Byte(place), "{message}");
        }
    }
    assert!(depth::parse(&[&whole[..], b"\n\0"].concat(), &CAMERA).is_ok());
}

/// The checksum of the name and the contents of a chunk.
fn checksum(bytes: &[u8]) -> u32 {
    let bit = |sum: u32| if sum & 1 == 1 { 0xedb8_8320 ^ (sum >> 1) } else { sum >> 1 };
    let byte = |sum: u32, byte: &u8| (0..8).fold(sum ^ u32::from(*byte), |sum, _| bit(sum));
    !bytes.iter().fold(u32::MAX, byte)
}

#[test]
fn a_size_is_believed_only_as_far_as_the_file_backs_it() {
    let limits = ReadLimits { points: 11, ..ReadLimits::default() };
    let fault = |bytes: &[u8], limits: ReadLimits| {
        depth::parse_within(bytes, &CAMERA, &limits).unwrap_err()
    };
    let error = fault(&png(4, &PIXELS), limits);
    assert_eq!(error.place, Place::Byte(16));
    assert!(matches!(error.fault, Fault::TooMany { what: "points", found: 12, limit: 11 }));
    let error =
        fault(&png(4, &PIXELS), ReadLimits { bytes: 23, points: 12, ..ReadLimits::default() });
    assert!(matches!(error.fault, Fault::TooMany { found: 24, limit: 23, .. }), "{error}");

    // Eight million pixels in some hundred bytes.
    let mut promise = png(4, &PIXELS);
    promise[16..24].copy_from_slice(&[0, 0, 16, 0, 0, 0, 8, 0]);
    let sum = checksum(&promise[12..29]);
    promise[29..33].copy_from_slice(&sum.to_be_bytes());
    let error = fault(&promise, ReadLimits::default());
    assert!(matches!(error.fault, Fault::TooShort { promised: 2048, .. }), "{error}");
    // And so many that their number overflows.
    promise[16..24].copy_from_slice(&[0x7f, 255, 255, 255, 0x7f, 255, 255, 255]);
    let sum = checksum(&promise[12..29]);
    promise[29..33].copy_from_slice(&sum.to_be_bytes());
    let error = fault(&promise, ReadLimits::default());
    assert!(matches!(error.fault, Fault::TooMany { .. }), "{error}");
}

#[test]
fn files_are_named_in_every_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.PNG");
    std::fs::write(&path, png(4, &PIXELS)).unwrap();
    assert_eq!(read_depth_image(&path, &CAMERA).unwrap().len(), 12);

    let other = DepthCamera { image_size: Some((640, 480)), ..CAMERA };
    let message = read_depth_image(&path, &other).unwrap_err().to_string();
    for part in ["frame.PNG: the image has ", "4 x 3 pixels", "of 640 x 480"] {
        assert!(message.contains(part), "{message}");
    }
    // Those of an image twice as large were taken without a word.
    let twice = DepthCamera { cx: 3.9, cy: 2.9, ..CAMERA };
    for aside in [DepthCamera { cx: 6.0, ..CAMERA }, twice] {
        let error = read_depth_image(&path, &aside).unwrap_err();
        let ReadError::Format { problem, .. } = error else { panic!("{error}") };
        assert!(matches!(problem.fault, Fault::Camera(CameraError::LooksAside { name: "cx", .. })));
    }
    // Those of one half as large too, and places in the image were off by half and more.
    let half = DepthCamera::new(300.0, 300.0, 159.5, 119.5);
    let refused = half.validate_for(640, 480).unwrap_err();
    assert!(matches!(refused, CameraError::OfHalf { .. }), "{refused}");
    assert!(half.validate_for(320, 240).is_ok());
    // A part of a larger image, and one that says its size.
    assert!(DepthCamera { fx: 600.0, ..half }.validate_for(640, 480).is_ok());
    assert!(DepthCamera { image_size: Some((640, 480)), ..half }.validate_for(640, 480).is_ok());

    let small = ReadLimits { bytes: 20, ..ReadLimits::default() };
    let message = read_depth_image_within(&path, &CAMERA, &small).unwrap_err().to_string();
    assert!(message.contains("more than 20 bytes"), "{message}");
    // Without a camera, and what is no image.
    let message = read_cloud(&path).unwrap_err().to_string();
    assert!(message.contains("intrinsics of its camera"), "{message}");
    let message = read_depth_image("scan.pcd", &CAMERA).unwrap_err().to_string();
    assert!(message.contains(".png (depth images)"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    /// Checksums that agree let damage through to what unpacks the image.
    #[test]
    fn damage_with_checksums_that_agree_is_survived(
        damages in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = png(4, &PIXELS);
        let mut chunks = vec![];
        let mut at = 8;
        while at < bytes.len() {
            let size = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
            chunks.push(at + 4..at + 8 + size);
            at += 12 + size;
        }
        for (index, byte) in damages {
            // What the header and the packed image hold, not how long they are.
            let places: Vec<usize> = chunks.iter().flat_map(|c| c.start + 4..c.end).collect();
            bytes[places[index.index(places.len())]] = byte;
        }
        for chunk in chunks {
            let sum = checksum(&bytes[chunk.clone()]);
            bytes[chunk.end..chunk.end + 4].copy_from_slice(&sum.to_be_bytes());
        }
        match depth::parse(&bytes, &CAMERA) {
            Ok(cloud) => prop_assert!(cloud.len() <= 516 * bytes.len()),
            Err(error) => prop_assert!(error.to_string().len() < 500),
        }
    }

    /// A plane, rounded to steps along z, comes back within half a step of itself along z, and every point on
    /// the ray of its pixel.
    #[test]
    fn a_plane_comes_back_within_half_a_step(
        (focal, squeeze) in (20.0..90.0_f64, 0.8..1.25_f64),
        (cx, cy) in (10.0..30.0_f64, 8.0..22.0_f64),
        tilt in [-0.8..0.8_f64, -0.8..0.8_f64],
        (distance, scale) in (0.5..5.0_f64, prop::sample::select(vec![0.001, 0.0002, 0.0001])),
    ) {
        let (width, height) = (40_usize, 30_usize);
        let camera = DepthCamera {
            depth_scale: scale,
            image_size: Some((width, height)),
            ..DepthCamera::new(focal, focal * squeeze, cx, cy)
        };
        let normal = Vector3::new(tilt[0], tilt[1], 1.0).normalize();
        let ray = |index: usize| Vector3::new(
            ((index % width) as f64 - camera.cx) / camera.fx,
            ((index / width) as f64 - camera.cy) / camera.fy,
            1.0,
        );
        // How far along z the plane is, none behind the camera or farther than 16 bits reach.
        let depth = |index: usize| {
            let z = distance / normal.dot(&ray(index));
            (z > 0.0 && z / scale < 65534.4).then_some(z).filter(|z| z / scale >= 0.5)
        };
        let steps = |index| depth(index).map_or(0, |z| (z / scale).round() as u16);
        let pixels: Vec<u16> = (0..width * height).map(steps).collect();
        prop_assume!(pixels.iter().any(|steps| *steps > 0));
        let cloud = depth::parse(&png(width, &pixels), &camera).unwrap();
        prop_assert_eq!(cloud.image_size, Some((width, height)));
        for (index, point) in cloud.points.iter().enumerate() {
            let Some(z) = depth(index) else {
                prop_assert!(point.iter().all(|v| v.is_nan()));
                continue;
            };
            prop_assert!((point.z - z).abs() <= 0.5 * scale * (1.0 + 1e-9));
            prop_assert!((point.coords - point.z * ray(index)).norm() <= 1e-12 * point.z);
            // So it is no farther from the plane than the half step is along its normal.
            let off = (normal.dot(&point.coords) - distance).abs();
            prop_assert!(off <= 0.5 * scale * normal.dot(&ray(index)).abs() + 1e-9);
        }
    }
}
