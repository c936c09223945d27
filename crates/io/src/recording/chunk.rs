//! The messages in a chunk of a recording, which is unpacked and checked as a whole first.

use mcap::{
    parse_record,
    records::{ChunkIndex, Record, op},
    sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions},
};

use super::{
    index::{reason, split_record},
    source::Source,
};
use crate::error::ReadError;

/// No chunk unpacks to more than this many times its size: a zstd block of four bytes stands for at
/// most 128 KiB, and LZ4 stays far below.
const LARGEST_EXPANSION: u64 = 32_768;

/// Shows every message of a chunk: its channel, when it was recorded (ns), and its bytes.
pub(super) fn for_each_message(
    source: &mut Source,
    chunk: &ChunkIndex,
    mut each: impl FnMut(u16, u64, &[u8]) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let start = chunk.chunk_start_offset;
    let bytes = source.bytes(start, chunk.chunk_length, "a chunk")?;
    let mut reader = reader(source, start, &bytes)?;
    let mut rest = &bytes[..];
    while let Some(event) = reader.next_event() {
        match event.map_err(|error| source.damaged(start, reason(&error)))? {
            LinearReadEvent::ReadRequest(wanted) => {
                // What it asks for may be far more than there is.
                let (given, following) = rest.split_at(wanted.min(rest.len()));
                if !given.is_empty() {
                    reader.insert(given.len()).copy_from_slice(given);
                }
                reader.notify_read(given.len());
                rest = following;
            }
            LinearReadEvent::Record { opcode: op::MESSAGE, data } => {
                match parse_record(op::MESSAGE, data) {
                    Ok(Record::Message { header, data }) => {
                        each(header.channel_id, header.log_time, &data)?;
                    }
                    Ok(_) => {}
                    Err(error) => return Err(source.damaged(start, reason(&error))),
                }
            }
            LinearReadEvent::Record { .. } => {}
        }
    }
    Ok(())
}

/// A reader for one chunk, of which is known that it takes no more memory than its bytes back.
fn reader(source: &Source, start: u64, bytes: &[u8]) -> Result<LinearReader, ReadError> {
    let Some((op::CHUNK, body, [])) = split_record(bytes) else {
        return Err(source.damaged(start, "there is no chunk where the summary says"));
    };
    let (header, data) = match parse_record(op::CHUNK, body) {
        Ok(Record::Chunk { header, data }) => (header, data),
        Ok(_) => return Err(source.damaged(start, "there is no chunk where the summary says")),
        Err(error) => return Err(source.damaged(start, reason(&error))),
    };
    // Bytes after the last record would be taken for a part of it.
    if !body.ends_with(&data) || body.len() - data.len() != 40 + header.compression.len() {
        return Err(source.damaged(start, "the chunk is not as long as it says"));
    }
    let most = header.compressed_size.saturating_mul(LARGEST_EXPANSION);
    if header.uncompressed_size > most {
        return Err(
            source.damaged(start, "the chunk is too short to unpack to the size it announces")
        );
    }
    let unpacked = source.check_size(start, header.uncompressed_size, "an unpacked chunk")?;
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(unpacked.max(bytes.len()));
    Ok(LinearReader::new_with_options(options))
}
