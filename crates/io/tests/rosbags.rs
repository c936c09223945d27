//! Messages and recordings written by others: the Python package `rosbags`.
//!
//! Skipped, with the reason, where no Python has it. To have it:
//! `python3 -m venv target/rosbags && target/rosbags/bin/pip install rosbags==0.11.9`.
#![cfg(feature = "mcap")]
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::path::{Path, PathBuf};
use std::process::Command;

use cloudtouch_geom::Point3;
use cloudtouch_io::pointcloud2::{self, Encoding, Scan};
use cloudtouch_io::recording::{Recording, Topic};
use cloudtouch_io::{ReadLimits, read_scan_within};

/// A Python with the package: the one of the environment named above, or that of the system.
fn python() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    [root.join("target/rosbags/bin/python"), "python3".into()].into_iter().find(|python| {
        let import = Command::new(python).args(["-c", "import rosbags.rosbag2, numpy"]).output();
        import.is_ok_and(|output| output.status.success())
    })
}

/// What `write.py` puts into its scan of a number.
fn check(scan: &Scan, number: i64) {
    assert_eq!(scan.frame_id, "lidar_top");
    assert_eq!(scan.stamp_ns, 1_700_000_000_250_000_000 + number);
    assert_eq!(scan.cloud.image_size, Some((3, 2)));
    let heights = [1.0, 2.0, 3.0, 4.0, f64::NAN, 6.0];
    for (i, (point, z)) in scan.cloud.points.iter().zip(heights).enumerate() {
        let expected = Point3::new(i as f64 / 10.0 + number as f64, i as f64 - 3.0, z);
        assert_eq!((point.x, point.y), (expected.x, expected.y));
        assert!(point.z == z || point.z.is_nan() && z.is_nan());
    }
    assert_eq!(scan.cloud.len(), 6);
}

#[test]
fn what_rosbags_writes_is_read() {
    let Some(python) = python() else {
        println!("skipped: no Python here has the package rosbags");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/rosbags/write.py");
    let written = Command::new(python).arg(script).arg(folder.path()).output().unwrap();
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));

    for (name, encoding) in
        [("little.cdr", Encoding::Cdr), ("big.cdr", Encoding::Cdr), ("ros1.bin", Encoding::Ros1)]
    {
        let bytes = std::fs::read(folder.path().join(name)).unwrap();
        check(&pointcloud2::parse(&bytes, encoding).unwrap(), 0);
    }
    for name in ["plain", "packed"] {
        let path = folder.path().join(name).join(format!("{name}.mcap"));
        let limits = ReadLimits::default();
        let topics = Recording::open(&path, &limits).unwrap().topics().unwrap();
        let expected = Topic {
            name: "/lidar/points".to_owned(),
            frame_id: Ok("lidar_top".to_owned()),
            messages: 5,
            first: 0.25,
            last: 0.65,
        };
        assert_eq!(topics, [expected]);
        for (at, number, time) in
            [("", 0, 0.25), ("#/lidar/points@0.35", 1, 0.35), ("#@0.36", 2, 0.45)]
        {
            let found = read_scan_within(format!("{}{at}", path.display()), &limits).unwrap();
            check(&found.scan, number);
            assert_eq!(found.time, time);
        }
    }
}
