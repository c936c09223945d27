//! What lies between the chunks of a recording.

use mcap::{
    MAGIC,
    records::{ChunkIndex, op},
};

use super::source::{RECORD_HEAD, Source};
use crate::error::ReadError;
use crate::recording_fault::RecordingFault;

/// Refuses messages outside of chunks, and chunks that the index lacks: their scans would be passed over. The first
/// `end` bytes of the recording are looked at, which are all before its summary.
pub(super) fn check(source: &mut Source, chunks: &[ChunkIndex], end: u64) -> Result<(), ReadError> {
    let mut known: Vec<(u64, u64)> = chunks.iter().map(extent).collect();
    known.sort_unstable();
    let mut at = MAGIC.len() as u64;
    for (start, after) in known.into_iter().chain([(end, end)]) {
        check_records(source, at, start)?;
        at = at.max(after);
    }
    Ok(())
}

/// Where a chunk begins, and where the index of its messages ends, which follows it.
fn extent(chunk: &ChunkIndex) -> (u64, u64) {
    let start = chunk.chunk_start_offset;
    let length = chunk.chunk_length.saturating_add(chunk.message_index_length);
    (start, start.saturating_add(length))
}

/// Goes from head to head through the records of a gap.
fn check_records(source: &mut Source, mut at: u64, end: u64) -> Result<(), ReadError> {
    while at < end {
        let head = source.bytes(at, RECORD_HEAD as u64, "a record between chunks")?;
        let no_index = |reason| RecordingFault::NoIndex { reason };
        match head[0] {
            op::MESSAGE => {
                return Err(
                    source.error(no_index("has messages outside of its chunks, in no index"))
                );
            }
            op::CHUNK => return Err(source.error(no_index("has a chunk that is in no index"))),
            _ => {}
        }
        let mut length = [0; 8];
        length.copy_from_slice(&head[1..]);
        let after =
            at.saturating_add(RECORD_HEAD as u64).saturating_add(u64::from_le_bytes(length));
        if after > end {
            return Err(source.damaged(at, "a record goes into the next chunk"));
        }
        at = after;
    }
    Ok(())
}
