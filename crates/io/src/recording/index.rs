//! The summary at the end of a recording: which topics there are, and what is where.

use std::collections::BTreeMap;

use mcap::{
    MAGIC, McapError, parse_record,
    records::{ChunkIndex, Record, op},
};

use super::{
    between,
    source::{RECORD_HEAD, Source},
    whole::{check, crc32, times},
};
use crate::error::ReadError;
use crate::recording_fault::RecordingFault;

/// What the summary says.
#[derive(Debug)]
pub(super) struct Index {
    /// By their number.
    pub(super) channels: BTreeMap<u16, Channel>,
    pub(super) chunks: Vec<ChunkIndex>,
    /// When the first message of any topic was recorded, ns.
    pub(super) start: u64,
}

/// One publisher of a topic.
#[derive(Debug)]
pub(super) struct Channel {
    pub(super) topic: String,
    /// The type of its messages.
    pub(super) kind: String,
    pub(super) encoding: String,
}

impl Channel {
    /// Whether its messages are scans.
    pub(super) fn has_clouds(&self) -> bool {
        ["sensor_msgs/msg/PointCloud2", "sensor_msgs/PointCloud2"].contains(&self.kind.as_str())
    }
}

/// Two offsets and a checksum.
const FOOTER: usize = 8 + 8 + 4;

/// Reads the summary of a recording that was written to its end.
pub(super) fn read(source: &mut Source) -> Result<Index, ReadError> {
    let magic = MAGIC.len() as u64;
    if source.size < magic || source.bytes(0, magic, "the beginning")? != MAGIC {
        return Err(source.error(RecordingFault::Magic));
    }
    let no_index = |reason| RecordingFault::NoIndex { reason };
    let tail = (RECORD_HEAD + FOOTER) as u64 + magic;
    let cut = no_index("does not end as a recording does, it was cut off while it was written");
    let Some(end) = source.size.checked_sub(tail).filter(|&end| end >= magic) else {
        return Err(source.error(cut));
    };
    let footer = source.bytes(end, tail, "the footer")?;
    if !footer.ends_with(MAGIC) || footer[0] != op::FOOTER {
        return Err(source.error(cut));
    }
    let mut start = [0; 8];
    start.copy_from_slice(&footer[RECORD_HEAD..RECORD_HEAD + 8]);
    let start = u64::from_le_bytes(start);
    if start == 0 {
        return Err(source.error(no_index("has no summary of what it holds")));
    }
    let Some(length) = end.checked_sub(start) else {
        return Err(source.damaged(end, "the summary begins after its end"));
    };
    let summary = source.bytes(start, length, "the summary")?;
    // Of the summary and of the footer up to here; 0 if the writer made none.
    let (before, sum) = footer.split_at(RECORD_HEAD + 16);
    let sum = [sum[0], sum[1], sum[2], sum[3]];
    if sum != [0; 4] && crc32(&[&summary, before]).to_le_bytes() != sum {
        return Err(source.damaged(start, "the summary is not what its checksum was made of"));
    }
    let index =
        parse(&summary).map_err(|(at, reason)| source.damaged(start + at as u64, reason))?;
    // A chunk of channels that the summary does not explain might hold scans.
    let is_explained = |chunk: &ChunkIndex| {
        chunk.message_index_offsets.keys().all(|id| index.channels.contains_key(id))
    };
    if index.chunks.is_empty()
        || index.channels.is_empty()
        || !index.chunks.iter().all(is_explained)
    {
        return Err(source.error(no_index("has no index of its chunks and channels")));
    }
    between::check(source, &index.chunks, start)?;
    Ok(index)
}

/// The records of a summary; an error is the place of the record and what is wrong with it.
fn parse(summary: &[u8]) -> Result<Index, (usize, String)> {
    let mut schemas: BTreeMap<u16, String> = BTreeMap::new();
    let mut channels = Vec::new();
    let (mut chunks, mut statistics) = (Vec::new(), None);
    let mut rest = summary;
    while !rest.is_empty() {
        let at = summary.len() - rest.len();
        let (opcode, body, following) = split_record(rest)
            .ok_or_else(|| (at, "a record goes beyond the summary".to_owned()))?;
        rest = following;
        // Others are passed over unread.
        if ![op::SCHEMA, op::CHANNEL, op::CHUNK_INDEX, op::STATISTICS].contains(&opcode) {
            continue;
        }
        match parse_record(opcode, body).map_err(|error| (at, reason(&error)))? {
            Record::Schema { header, .. } => {
                schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => channels.push(channel),
            Record::ChunkIndex(chunk) => chunks.push(chunk),
            Record::Statistics(told) => statistics = Some((at, told)),
            _ => {}
        }
    }
    let channels = channels.into_iter().map(|channel| {
        let kind = schemas.get(&channel.schema_id).cloned().unwrap_or_default();
        let encoding = channel.message_encoding;
        (channel.id, Channel { topic: channel.topic, kind, encoding })
    });
    let (earliest, _) = times(&chunks);
    let start = match &statistics {
        Some((at, told)) => {
            check(told, &chunks).map_err(|reason| (*at, reason))?;
            let of_chunk = |chunk: &ChunkIndex| chunk.message_start_time == told.message_start_time;
            // Of a chunk without messages the time is 0 too, so that only the statistics tell whether one was then.
            if chunks.iter().any(of_chunk) { told.message_start_time } else { earliest }
        }
        None => earliest,
    };
    Ok(Index { channels: channels.collect(), chunks, start })
}

/// The opcode and the body of the first record, and what follows it.
pub(super) fn split_record(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (head, rest) = bytes.split_first_chunk::<RECORD_HEAD>()?;
    let mut length = [0; 8];
    length.copy_from_slice(&head[1..]);
    let (body, rest) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(length)).ok()?)?;
    Some((head[0], body, rest))
}

/// What the library says, as a part of a sentence.
pub(super) fn reason(error: &McapError) -> String {
    crate::text::excerpt(error.to_string().as_bytes())
}
