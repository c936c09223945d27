//! Recordings written by the library of the format: which scan is found, and what is wrong in one.
#![cfg(feature = "mcap")]
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::PathBuf;

use crate::ros::{Message, Wire};
use cloudtouch_io::recording::Recording;
use cloudtouch_io::{
    Geometry, LengthUnit, ReadError, ReadLimits, read_cloud, read_colors_within, read_geometry,
    read_mesh, read_scan_within,
};
use mcap::{Compression, MessageStream, WriteOptions, records::MessageHeader};
use proptest::prelude::*;
use tempfile::TempDir;

const CLOUD: &str = "sensor_msgs/msg/PointCloud2";
const SECOND: u64 = 1_000_000_000;
/// When recordings begin, ns.
const START: u64 = 1_700_000_000 * SECOND;

/// Topic, type, encoding, time since the beginning (ns), bytes.
type Entry = (&'static str, &'static str, &'static str, u64, Vec<u8>);

/// A recording of messages in their order.
fn recording(options: WriteOptions, entries: &[Entry]) -> Vec<u8> {
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    for (sequence, (topic, kind, encoding, time, bytes)) in (0..).zip(entries) {
        let schema_id = writer.add_schema(kind, "ros2msg", b"").unwrap();
        let channel_id = writer.add_channel(schema_id, topic, encoding, &BTreeMap::new()).unwrap();
        let log_time = START + time;
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        writer.write_to_known_channel(&header, bytes).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// A message whose only point tells which it is.
fn numbered(x: f32, wire: Wire) -> Vec<u8> {
    Message::of_points(&[[x, 0.0, 0.0]]).bytes(wire)
}

fn cloud_at(topic: &'static str, time: u64, x: f32) -> Entry {
    (topic, CLOUD, "cdr", time, numbered(x, Wire::LittleCdr))
}

fn zstd() -> WriteOptions {
    WriteOptions::new().compression(Some(Compression::Zstd))
}

/// Two topics with scans, out of order, and one of another type, which came first.
fn two_topics(options: WriteOptions) -> Vec<u8> {
    recording(
        options,
        &[
            ("/tf", "tf2_msgs/msg/TFMessage", "cdr", 0, vec![0; 8]),
            cloud_at("/front", 2 * SECOND, 2.0),
            cloud_at("/rear", SECOND / 2, 10.0),
            cloud_at("/front", SECOND, 1.0),
            ("/front", "sensor_msgs/PointCloud2", "ros1", 3 * SECOND, numbered(3.0, Wire::Ros1)),
            cloud_at("/rear", 3 * SECOND, 11.0),
        ],
    )
}

/// A file in a folder of its own.
fn file(bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("run.mcap");
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn limits() -> ReadLimits {
    ReadLimits::default()
}

#[test]
fn a_name_finds_its_scan_however_the_recording_is_packed() {
    let small = |options: WriteOptions| options.chunk_size(Some(100));
    for options in [
        zstd(),
        small(zstd()),
        WriteOptions::new().compression(Some(Compression::Lz4)),
        small(WriteOptions::new().compression(None)),
        small(zstd()).emit_message_indexes(false),
        small(zstd()).emit_statistics(false),
    ] {
        let (_folder, path) = file(&two_topics(options));
        let named = |scan: &str| PathBuf::from(format!("{}#{scan}", path.display()));
        for (scan, x, time) in [
            ("/front", 1.0, 1.0),
            ("/front@0", 1.0, 1.0),
            ("/front@1", 1.0, 1.0),
            ("/front@1.000000001", 2.0, 2.0),
            ("/front@2.5", 3.0, 3.0),
            ("/rear", 10.0, 0.5),
            ("/rear@0.6", 11.0, 3.0),
        ] {
            let found = read_scan_within(named(scan), &limits()).unwrap();
            assert_eq!(found.scan.cloud.points[0].x, x, "{scan}");
            assert_eq!((found.time, found.scan.frame_id.as_str()), (time, "lidar"), "{scan}");
            assert!(scan.starts_with(&found.topic));
        }
        assert_eq!(read_cloud(named("/rear")).unwrap().points[0].x, 10.0);
        let Geometry::Cloud(cloud) =
            read_geometry(named("/rear"), LengthUnit::Millimetres).unwrap()
        else {
            panic!("a mesh")
        };
        assert_eq!(cloud.points[0].x, 0.01);
        assert_eq!(read_colors_within(named("/rear"), &limits()).unwrap(), None);
        assert!(read_mesh(named("/rear"), LengthUnit::Metres).is_err());

        let topics = Recording::open(&path, &limits()).unwrap().topics().unwrap();
        let told: Vec<_> = topics
            .iter()
            .map(|t| (t.name.as_str(), t.frame_id.as_deref().unwrap(), t.messages, t.first, t.last))
            .collect();
        assert_eq!(told, [("/front", "lidar", 3, 1.0, 3.0), ("/rear", "lidar", 2, 0.5, 3.0)]);
    }
}

#[test]
fn the_only_topic_needs_no_name() {
    let unused = "/announced_and_never_used";
    let mut writer = zstd().create(Cursor::new(Vec::new())).unwrap();
    let schema = writer.add_schema(CLOUD, "ros2msg", b"").unwrap();
    writer.add_channel(schema, unused, "cdr", &BTreeMap::new()).unwrap();
    let channel_id = writer.add_channel(schema, "/points", "cdr", &BTreeMap::new()).unwrap();
    let header = MessageHeader { channel_id, sequence: 0, log_time: START, publish_time: START };
    writer.write_to_known_channel(&header, &numbered(1.0, Wire::BigCdr)).unwrap();
    writer.finish().unwrap();
    let (_folder, path) = file(&writer.into_inner().into_inner());
    assert_eq!(read_scan_within(&path, &limits()).unwrap().topic, "/points");
    let at = format!("{}#@0", path.display());
    assert_eq!(read_scan_within(at, &limits()).unwrap().time, 0.0);
}

#[test]
fn errors_name_file_topic_time_and_remedy() {
    let (_folder, path) = file(&two_topics(zstd()));
    let complaint = |scan: &str| {
        let path = format!("{}{scan}", path.display());
        read_scan_within(path, &limits()).unwrap_err().to_string()
    };
    for (scan, expected) in [
        ("", "several topics hold PointCloud2: name one of /front, /rear, as in"),
        ("#/side", "there is no topic /side: PointCloud2 is on /front, /rear"),
        ("#/tf", "topic /tf holds tf2_msgs/msg/TFMessage, not sensor_msgs/PointCloud2"),
        (
            "#/rear@3.5",
            "topic /rear has no message at or after 3.5 s from the beginning, its last is at 3 s",
        ),
        ("#/rear@soon", "\"soon\" is no time"),
    ] {
        let complaint = complaint(scan);
        assert!(complaint.contains(expected) && complaint.contains("run.mcap"), "{complaint}");
    }
    let mut broken = cloud_at("/points", SECOND, 0.0);
    broken.4.truncate(50);
    let other = ("/json", CLOUD, "json", SECOND, b"{}".to_vec());
    let first = cloud_at("/points", 0, 0.0);
    let (_folder, path) = file(&recording(zstd(), &[first, broken, other]));
    let complaint = |scan: &str| {
        let path = format!("{}{scan}", path.display());
        read_scan_within(path, &limits()).unwrap_err().to_string()
    };
    let found = complaint("#/points@0.5");
    assert!(
        found.contains("run.mcap: topic /points at 1 s from the beginning: byte 50: "),
        "{found}"
    );
    let found = complaint("#/json");
    assert!(found.contains("topic /json is encoded as \"json\""), "{found}");
    let (_folder, path) = file(&recording(zstd(), &[("/tf", "tf", "cdr", 0, vec![0])]));
    let found = read_scan_within(&path, &limits()).unwrap_err().to_string();
    assert!(found.contains("no topic holds sensor_msgs/PointCloud2"), "{found}");
}

/// `info` said nothing of any topic.
#[test]
fn one_topic_that_cannot_be_read_hid_all_others() {
    let mut broken = cloud_at("/broken", 0, 0.0);
    broken.4.truncate(3);
    let other = ("/json", CLOUD, "json", SECOND, b"{}".to_vec());
    let good = cloud_at("/good", SECOND, 1.0);
    let later = cloud_at("/broken", SECOND, 2.0);
    let (_folder, path) = file(&recording(zstd(), &[broken, other, good, later]));
    let topics = Recording::open(&path, &limits()).unwrap().topics().unwrap();
    let told = topics.iter().map(|t| (t.name.as_str(), t.messages, t.frame_id.is_ok()));
    let expected = [("/broken", 2, false), ("/good", 1, true), ("/json", 1, false)];
    assert_eq!(told.collect::<Vec<_>>(), expected);
}

#[test]
fn a_recording_that_is_none_or_was_cut_off_says_so() {
    let whole = two_topics(zstd());
    let complaint = |bytes: &[u8]| {
        let (_folder, path) = file(bytes);
        Recording::open(path, &limits()).unwrap_err().to_string()
    };
    for (bytes, expected) in [
        (&b"ply\n"[..], "is no MCAP recording"),
        (b"", "is no MCAP recording"),
        (&whole[..8], "was cut off while it was written: mend it with `mcap recover"),
        (&whole[..whole.len() - 100], "was cut off while it was written"),
        (&recording(zstd().emit_summary_records(false), &[cloud_at("/a", 0, 1.0)]), "has no"),
        (&recording(zstd().use_chunks(false), &[cloud_at("/a", 0, 1.0)]), "has no index"),
    ] {
        let complaint = complaint(bytes);
        assert!(complaint.contains(expected), "{complaint}");
    }
    let missing = Recording::open("there-is-none.mcap", &limits()).unwrap_err();
    assert!(matches!(missing, ReadError::Io { .. }));
}

/// Writes other numbers into the statistics of a recording: their place among its eight, counted in bytes, and the number.
fn with_statistics(mut bytes: Vec<u8>, place: usize, number: &[u8]) -> Vec<u8> {
    let footer = bytes.len() - 8 - 20;
    let summary = u64::from_le_bytes(bytes[footer..footer + 8].try_into().unwrap());
    let mut at = usize::try_from(summary).unwrap();
    while bytes[at] != mcap::records::op::STATISTICS {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
        at += 9 + usize::try_from(length).unwrap();
    }
    bytes[at + 9 + place..][..number.len()].copy_from_slice(number);
    bytes
}

/// Of a chunk that the index lacks, and of messages outside of chunks, the scans were passed over, and another was taken for
/// the first.
#[test]
fn an_index_that_leaves_out_messages_is_refused() {
    const CHUNKS: usize = 8 + 2 + 4 + 4 + 4;
    const FIRST: usize = CHUNKS + 4;
    const LAST: usize = FIRST + 8;
    let options = || zstd().chunk_size(Some(100)).calculate_summary_section_crc(false);
    let whole = || two_topics(options());
    let complaint = |bytes: &[u8]| {
        let (_folder, path) = file(bytes);
        Recording::open(path, &limits()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(complaint(&whole()), Ok(()));
    for (place, number, expected) in [
        (CHUNKS, &7_u32.to_le_bytes()[..], "of 7 chunks the index has"),
        (FIRST, &(START - 1).to_le_bytes(), "and the index of chunks from 1700000000000000000"),
        (FIRST, &(START + SECOND).to_le_bytes(), "messages from 1700000001000000000"),
        (LAST, &(START + 4 * SECOND).to_le_bytes(), "to 1700000004000000000 ns, and"),
    ] {
        let error = complaint(&with_statistics(whole(), place, number)).unwrap_err();
        assert!(error.contains(expected) && error.contains("mcap recover"), "{error}");
    }
    // A writer that does not know when the recording began: seconds were counted from 1970.
    let (_folder, path) = file(&with_statistics(whole(), FIRST, &[0; 8]));
    let found = Recording::open(path, &limits()).unwrap().scan(Some("/front"), Some(2.5));
    assert_eq!(found.unwrap().time, 3.0);
}

/// A scan in a chunk at 0 s and one at 4 s, with a record between the chunks that takes the place of so many bytes.
fn with_record_between(kind: u8, body: &[u8]) -> Vec<u8> {
    let room = "x".repeat(body.len());
    let mut writer = WriteOptions::new().create(Cursor::new(Vec::new())).unwrap();
    let schema = writer.add_schema(CLOUD, "ros2msg", b"").unwrap();
    let channel_id = writer.add_channel(schema, "/a", "cdr", &BTreeMap::new()).unwrap();
    for time in [0, 4] {
        let log_time = START + time * SECOND;
        let header = MessageHeader { channel_id, sequence: 0, log_time, publish_time: log_time };
        writer.write_to_known_channel(&header, &numbered(time as f32, Wire::LittleCdr)).unwrap();
        let metadata = mcap::records::Metadata { name: room.clone(), metadata: BTreeMap::new() };
        writer.write_metadata(&metadata).unwrap();
    }
    writer.finish().unwrap();
    let mut bytes = writer.into_inner().into_inner();
    let at = bytes.windows(room.len()).position(|part| part == room.as_bytes()).unwrap();
    // Its opcode and length, and the length of its name.
    bytes[at - 13] = kind;
    bytes[at - 4..][..body.len()].copy_from_slice(body);
    bytes
}

/// Messages may lie outside of chunks. Asked for the scan from 0.5 s on, that at 4 s was given and not that at 1 s between
/// the chunks.
#[test]
fn messages_between_chunks_were_passed_over() {
    use mcap::records::op;
    let mut message = Vec::new();
    message.extend(0_u16.to_le_bytes());
    message.extend(0_u32.to_le_bytes());
    message.extend((START + SECOND).to_le_bytes());
    message.extend((START + SECOND).to_le_bytes());
    message.extend(numbered(1.0, Wire::LittleCdr));
    let name = u32::try_from(message.len()).unwrap().to_le_bytes();
    let found = |kind: u8, body: &[u8]| {
        let (_folder, path) = file(&with_record_between(kind, body));
        let found = Recording::open(&path, &limits())?.scan(Some("/a"), Some(0.5));
        found.map(|found| found.time)
    };
    let mut metadata = vec![b'x'; message.len()];
    metadata[..4].copy_from_slice(&name);
    assert_eq!(found(op::METADATA, &metadata).unwrap(), 4.0);
    for (kind, expected) in
        [(op::MESSAGE, "has messages outside of its chunks"), (op::CHUNK, "a chunk that is in no")]
    {
        let error = found(kind, &message).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("mcap recover"), "{error}");
    }
}

/// The checksum of the summary was not looked at: with another time of a chunk, or another letter of a topic, another scan
/// was the first, or none.
#[test]
fn a_changed_byte_in_the_summary_is_seen() {
    let whole = two_topics(zstd().chunk_size(Some(100)));
    let footer = whole.len() - 8 - 20;
    let summary = u64::from_le_bytes(whole[footer..footer + 8].try_into().unwrap());
    for at in (usize::try_from(summary).unwrap()..footer - 9).step_by(7) {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        let (_folder, path) = file(&bytes);
        let error = Recording::open(path, &limits()).unwrap_err().to_string();
        assert!(error.contains("its checksum") && error.contains("mcap recover"), "{at}: {error}");
    }
}

#[test]
fn a_changed_byte_in_a_chunk_is_seen() {
    let mut bytes = two_topics(WriteOptions::new().compression(None));
    let at = bytes.windows(6).position(|part| part == b"lidar\0").unwrap();
    bytes[at] = b'L';
    let (_folder, path) = file(&bytes);
    let error = read_scan_within(format!("{}#/rear", path.display()), &limits()).unwrap_err();
    assert!(error.to_string().contains("CRC failed"), "{error}");
}

#[test]
fn chunks_are_limited_packed_and_unpacked() {
    let zeros = Message { data: vec![0; 120_000], ..Message::of_points(&[[0.0; 3]; 10_000]) };
    let entry = ("/a", CLOUD, "cdr", 0, zeros.bytes(Wire::LittleCdr));
    let (_folder, path) = file(&recording(zstd(), &[entry]));
    let within = |bytes| ReadLimits { bytes, ..limits() };
    assert_eq!(read_scan_within(&path, &within(130_000)).unwrap().scan.cloud.len(), 10_000);
    let error = read_scan_within(&path, &within(100_000)).unwrap_err().to_string();
    assert!(
        error.contains("an unpacked chunk takes 12") && error.contains("limit on bytes"),
        "{error}"
    );
    let error = read_scan_within(&path, &within(20)).unwrap_err().to_string();
    assert!(error.contains("at most 20 are read"), "{error}");
    let points = ReadLimits { points: 9_999, ..limits() };
    let error = read_scan_within(&path, &points).unwrap_err().to_string();
    assert!(error.contains("raise the limit on points"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Against a walk through all messages, as the library of the format reads them.
    #[test]
    fn the_scan_is_the_earliest_from_that_time_on(
        times in prop::collection::hash_set(0..60_u64, 1..20),
        asked in 0..70_u64,
        chunk in 50..2000_u64,
    ) {
        let entries: Vec<Entry> = (0_u8..)
            .zip(times)
            .map(|(i, time)| {
                let topic = if i % 3 == 0 { "/b" } else { "/a" };
                cloud_at(topic, time * SECOND / 10, f32::from(i))
            })
            .collect();
        let bytes = recording(zstd().chunk_size(Some(chunk)), &entries);
        let all: Vec<_> = MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
        let start = all.iter().map(|message| message.log_time).min().unwrap();
        let from = start + asked * SECOND / 10;
        let expected = all
            .iter()
            .filter(|message| message.channel.topic == "/b" && message.log_time >= from)
            .min_by_key(|message| message.log_time);
        let (_folder, path) = file(&bytes);
        let found = Recording::open(&path, &limits())
            .unwrap()
            .scan(Some("/b"), Some(asked as f64 / 10.0));
        match expected {
            Some(message) => {
                let found = found.unwrap();
                prop_assert_eq!(found.time, (message.log_time - start) as f64 / 1e9);
                let expected = cloudtouch_io::pointcloud2::parse(
                    &message.data, cloudtouch_io::pointcloud2::Encoding::Cdr).unwrap();
                prop_assert_eq!(found.scan, expected);
            }
            None => prop_assert!(found.is_err()),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    #[test]
    fn damaged_recordings_are_survived(
        pick in 0..3_usize,
        damages in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        thread_local!(static SEEDS: [Vec<u8>; 3] = [
            two_topics(zstd().calculate_chunk_crcs(false)),
            two_topics(WriteOptions::new().compression(None).calculate_chunk_crcs(false)),
            two_topics(WriteOptions::new().compression(Some(Compression::Lz4))
                .calculate_chunk_crcs(false)),
        ]);
        let mut bytes = SEEDS.with(|seeds| seeds[pick].clone());
        for (index, byte) in damages {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        if let Some(cut) = cut {
            let at = cut.index(bytes.len());
            bytes.remove(at);
        }
        let (_folder, path) = file(&bytes);
        if let Ok(mut recording) = Recording::open(&path, &limits()) {
            let topics = recording.topics();
            let told = topics.as_ref().map_or(0, |all| all.iter().map(|t| t.messages).sum());
            prop_assert!(told < bytes.len());
            let scan = recording.scan(Some("/rear"), None);
            for error in topics.err().into_iter().chain(scan.err()) {
                prop_assert!(error.to_string().len() < 500, "{}", error);
            }
        }
    }
}
