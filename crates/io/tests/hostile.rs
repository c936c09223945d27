//! Arbitrary and mutated bytes: no panic, no end of memory, no end of time.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_io::{DepthCamera, Geometry, depth, obj, pcd, ply, stl, xyz};
use proptest::prelude::*;

use crate::depth::png;

/// Of images of some pixels.
fn camera() -> DepthCamera {
    DepthCamera::new(4.0, 4.0, 1.0, 1.0)
}

/// Points or vertices, and triangles.
fn sizes(geometry: Geometry) -> (usize, usize) {
    match geometry {
        Geometry::Cloud(cloud) => (cloud.len(), 0),
        Geometry::Mesh(mesh) => (mesh.vertices().len(), mesh.triangles().len()),
    }
}

/// Parses as every format; whatever comes out must be backed by the bytes that went in.
fn survives(bytes: &[u8]) {
    let results = [
        pcd::parse(bytes).map(Geometry::Cloud),
        ply::parse(bytes),
        xyz::parse(bytes).map(Geometry::Cloud),
        stl::parse(bytes).map(Geometry::Mesh),
        obj::parse(bytes).map(Geometry::Mesh),
        depth::parse(bytes, &camera()).map(Geometry::Cloud),
    ];
    for (format, result) in results.into_iter().enumerate() {
        match result {
            Ok(geometry) => {
                let (points, triangles) = sizes(geometry);
                // What LZF can make of a byte, and deflate, with two bytes a pixel; other formats need
                // three bytes for a point.
                let expansion = [88, 1, 1, 1, 1, 516][format];
                let most = expansion * bytes.len();
                assert!(points <= most && triangles <= bytes.len());
            }
            // The message must never hold more than an excerpt of the file.
            Err(error) => assert!(error.to_string().len() < 500),
        }
    }
}

/// Small valid files of every format and encoding.
fn seeds() -> Vec<Vec<u8>> {
    let pcd = |data: &str, body: &[u8]| {
        let mut bytes = format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS _ x y z\nSIZE 1 4 4 4\nTYPE U F F F\nCOUNT 3 1 1 1\n\
             WIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA {data}\n"
        )
        .into_bytes();
        bytes.extend(body);
        bytes
    };
    let unpacked = [63_u8; 60];
    let packed = lzf::compress(&unpacked).unwrap();
    let sizes = [(packed.len() as u32).to_le_bytes(), 60_u32.to_le_bytes()].concat();
    let ply = |format: &str, body: &[u8]| {
        let mut bytes = format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
             property float z\nelement face 1\nproperty list uchar uchar vertex_index\nend_header\n"
        )
        .into_bytes();
        bytes.extend(body);
        bytes
    };
    let triangle = [&[0_u8; 36][..], &[3, 0, 1, 2]].concat();
    let mut stl = vec![b' '; 80];
    stl.extend(1_u32.to_le_bytes());
    stl.extend([0; 50]);
    let seeds = vec![
        pcd("ascii", &b"0 0 0 1 2 nan\n".repeat(4)),
        pcd("binary", &unpacked),
        pcd("binary_compressed", &[sizes, packed].concat()),
        ply("ascii", b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        ply("binary_little_endian", &triangle),
        ply("binary_big_endian", &triangle),
        b"x;y;z;cov_xx;cov_xy;cov_xz;cov_yy;cov_yz;cov_zz\n1;2;3;1;0;0;1;0;1\n".to_vec(),
        b"1 2 3 4\n5 6 7\n".to_vec(),
        stl,
        b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
          endloop\nendfacet\nendsolid\n"
            .to_vec(),
        b"4 2\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf -1//2 -2 -3/1/1\n".to_vec(),
        png(3, &[1000, 0, 1001, 65535, 999, 998]),
    ];
    for seed in &seeds {
        let read = [
            pcd::parse(seed).is_ok(),
            ply::parse(seed).is_ok(),
            xyz::parse(seed).is_ok(),
            stl::parse(seed).is_ok(),
            obj::parse(seed).is_ok(),
            depth::parse(seed, &camera()).is_ok(),
        ];
        assert!(read.contains(&true), "{}", String::from_utf8_lossy(seed));
    }
    seeds
}

/// One damage to a file.
#[derive(Debug, Clone)]
enum Damage {
    Set(prop::sample::Index, u8),
    Cut(prop::sample::Index),
    Remove(prop::sample::Index, usize),
    Insert(prop::sample::Index, Vec<u8>),
}

fn any_damage() -> impl Strategy<Value = Damage> {
    let at = any::<prop::sample::Index>;
    let telling = prop::sample::select(vec![
        "9",
        "0",
        "-1",
        "-",
        ".",
        " ",
        "\n",
        "nan",
        "18446744073709551615",
        "4294967295",
        "e308",
        ";",
        ",",
        "#",
        "list ",
        "\u{0}",
        "property list uchar uchar q\n",
        "element e 99999999\n",
    ]);
    prop_oneof![
        4 => (at(), any::<u8>()).prop_map(|(at, byte)| Damage::Set(at, byte)),
        1 => at().prop_map(Damage::Cut),
        2 => (at(), 1..20_usize).prop_map(|(at, length)| Damage::Remove(at, length)),
        4 => (at(), telling).prop_map(|(at, text)| Damage::Insert(at, text.into())),
    ]
}

fn damaged(mut bytes: Vec<u8>, damages: &[Damage]) -> Vec<u8> {
    for damage in damages {
        let at = |index: &prop::sample::Index| index.index(bytes.len() + 1);
        match damage {
            Damage::Set(index, byte) => {
                let at = at(index);
                if let Some(place) = bytes.get_mut(at) {
                    *place = *byte;
                }
            }
            Damage::Cut(index) => bytes.truncate(at(index)),
            Damage::Remove(index, length) => {
                let start = at(index);
                bytes.drain(start..bytes.len().min(start + length));
            }
            Damage::Insert(index, text) => {
                let at = at(index);
                bytes.splice(at..at, text.iter().copied());
            }
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn damaged_files_are_survived(
        pick in any::<prop::sample::Index>(),
        damages in prop::collection::vec(any_damage(), 1..4),
    ) {
        thread_local!(static SEEDS: Vec<Vec<u8>> = seeds());
        SEEDS.with(|seeds| survives(&damaged(pick.get(seeds).clone(), &damages)));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn arbitrary_bytes_are_survived(
        start in prop::sample::select(vec!["", "ply\n", "solid", "v ", "VERSION .7\n", "//"]),
        noise in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        survives(&[start.as_bytes(), &noise].concat());
    }
}

#[test]
fn truncation_at_every_byte_is_survived() {
    for seed in seeds() {
        (0..seed.len()).for_each(|length| survives(&seed[..length]));
    }
}

#[test]
fn time_is_bounded_by_size() {
    // Each would run for hours if a count alone set the number of steps.
    let many = "18446744073709551615";
    let header = "property float x\nproperty float y\nproperty float z\n";
    for format in ["ascii", "binary_little_endian"] {
        survives(
            format!(
                "ply\nformat {format} 1.0\nelement nothing {many}\nelement vertex 0\n{header}\
                 element more {many}\nend_header\n"
            )
            .as_bytes(),
        );
    }
    let elements: String = (0..100_000).map(|i| format!("element e{i} 0\n")).collect();
    survives(format!("ply\nformat ascii 1.0\n{elements}").as_bytes());
    survives(format!("FIELDS x y z\nCOUNT {many} 1 1\nPOINTS {many}\n").repeat(20_000).as_bytes());
}
