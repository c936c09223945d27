//! Whether the summary of a recording is as it was written, and tells of all its messages.

use mcap::records::{ChunkIndex, Statistics};

/// The checksum of the format over parts that follow one another.
pub(super) fn crc32(parts: &[&[u8]]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    parts.iter().for_each(|part| hasher.update(part));
    hasher.finalize()
}

/// When the first and the last message of these chunks were recorded, ns.
pub(super) fn times(chunks: &[ChunkIndex]) -> (u64, u64) {
    let is_empty =
        |chunk: &ChunkIndex| chunk.message_end_time == 0 && chunk.message_index_offsets.is_empty();
    let filled = || chunks.iter().filter(|chunk| !is_empty(chunk));
    let first = filled().map(|chunk| chunk.message_start_time).min();
    let last = filled().map(|chunk| chunk.message_end_time).max();
    (first.unwrap_or_default(), last.unwrap_or_default())
}

/// Whether the index of chunks leads to all messages that the statistics tell of: scans would be passed over that are
/// not in it.
pub(super) fn check(told: &Statistics, chunks: &[ChunkIndex]) -> Result<(), String> {
    if chunks.is_empty() || told.message_count == 0 {
        return Ok(());
    }
    let found = chunks.len();
    if told.chunk_count as usize != found {
        let all = told.chunk_count;
        return Err(format!("of {all} chunks the index has {found}"));
    }
    let (first, last) = times(chunks);
    let (start, end) = (told.message_start_time, told.message_end_time);
    // 0 is also what is written by those who do not know it.
    if (start != 0 && start != first) || end > last {
        return Err(format!(
            "the statistics tell of messages from {start} to {end} ns, and the index of chunks from {first} to {last} ns"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_format() {
        assert_eq!(crc32(&[b"1234", b"", b"56789"]), 0xcbf4_3926);
        assert_eq!(crc32(&[]), 0);
    }
}
