//! Topics and scans of a recording.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use mcap::records::ChunkIndex;

use super::{
    chunk::for_each_message,
    index::{self, Channel, Index},
    scan::RecordedScan,
    source::Source,
};
use crate::recording_fault::{Names, RecordingFault};
use crate::{
    error::ReadError,
    limits::ReadLimits,
    pointcloud2::{Encoding, frame_id, parse_within},
    text::excerpt,
};

/// An open `.mcap` recording.
///
/// Of the file no more is held in memory than one chunk, so that the limit on bytes is one on a
/// chunk, packed and unpacked, and not on the recording. Checksums are verified where there are any.
#[derive(Debug)]
pub struct Recording {
    source: Source,
    index: Index,
}

/// A topic with scans.
#[derive(Debug, Clone, PartialEq)]
pub struct Topic {
    /// Its name.
    pub name: String,
    /// The frame of its first message, or why that cannot be read; later ones may be whole.
    pub frame_id: Result<String, RecordingFault>,
    /// How many messages it has, 1 or more.
    pub messages: usize,
    /// When the first was recorded, s from the beginning of the recording.
    pub first: f64,
    /// When the last was recorded, s from the beginning of the recording.
    pub last: f64,
}

impl Recording {
    /// Opens a recording and reads what it says of itself.
    ///
    /// # Errors
    /// When it cannot be read, is no MCAP file, was cut off, or has no index.
    pub fn open(path: impl AsRef<Path>, limits: &ReadLimits) -> Result<Self, ReadError> {
        let mut source = Source::open(path.as_ref(), limits)?;
        let index = index::read(&mut source)?;
        Ok(Self { source, index })
    }

    /// The topics with scans, by name. Reads through all chunks that hold any.
    ///
    /// # Errors
    /// When a chunk is damaged.
    pub fn topics(&mut self) -> Result<Vec<Topic>, ReadError> {
        let ids: BTreeSet<u16> = self.channels(Channel::has_clouds).collect();
        let chunks: Vec<ChunkIndex> = self.chunks_with(&ids).cloned().collect();
        let Index { channels, start, .. } = &self.index;
        let mut topics: BTreeMap<&str, Topic> = BTreeMap::new();
        for chunk in &chunks {
            for_each_message(&mut self.source, chunk, |id, log_time, bytes| {
                let Some(channel) = channels.get(&id).filter(|_| ids.contains(&id)) else {
                    return Ok(());
                };
                let time = seconds(log_time, *start);
                let name = channel.topic.clone();
                let topic = topics.entry(&channel.topic).or_insert_with(|| Topic {
                    name,
                    frame_id: Ok(String::new()),
                    messages: 0,
                    first: f64::INFINITY,
                    last: time,
                });
                topic.messages += 1;
                topic.last = topic.last.max(time);
                if time < topic.first {
                    topic.first = time;
                    topic.frame_id = frame_of(channel, time, bytes);
                }
                Ok(())
            })?;
        }
        Ok(topics.into_values().collect())
    }

    /// The first message of a topic at or after a time (s from the beginning of the recording, 0 or
    /// more), by the time of recording; without a topic, that of the only one with scans.
    ///
    /// # Errors
    /// When there is no such topic or message, several topics would do, a chunk is damaged, or the
    /// message is no scan.
    pub fn scan(
        &mut self,
        topic: Option<&str>,
        at: Option<f64>,
    ) -> Result<RecordedScan, ReadError> {
        let topic = self.resolve(topic).map_err(|fault| self.source.error(fault))?;
        let ids: BTreeSet<u16> =
            self.channels(|channel| channel.has_clouds() && channel.topic == topic).collect();
        let from = self.index.start.saturating_add((at.unwrap_or(0.0) * 1e9).round() as u64);
        let Some((id, log_time, bytes)) = self.first_message(&ids, from)? else {
            let topics = self.topics()?;
            let short = excerpt(topic.as_bytes());
            return Err(self.source.error(match topics.iter().find(|found| found.name == topic) {
                Some(Topic { last, .. }) => {
                    RecordingFault::TooLate { topic: short, at: at.unwrap_or(0.0), last: *last }
                }
                None => RecordingFault::UnknownTopic {
                    topic: short,
                    topics: Names(topics.into_iter().map(|topic| topic.name).collect()),
                },
            }));
        };
        let channel = &self.index.channels[&id];
        let time = seconds(log_time, self.index.start);
        let scan = encoding(channel).and_then(|encoding| {
            parse_within(&bytes, encoding, &self.source.limits).map_err(|problem| {
                RecordingFault::Message { topic: excerpt(topic.as_bytes()), time, problem }
            })
        });
        Ok(RecordedScan { scan: scan.map_err(|fault| self.source.error(fault))?, topic, time })
    }

    /// The earliest message of some channels at or after a time (ns): its channel, time and bytes.
    fn first_message(
        &mut self,
        ids: &BTreeSet<u16>,
        from: u64,
    ) -> Result<Option<(u16, u64, Vec<u8>)>, ReadError> {
        let mut chunks: Vec<ChunkIndex> =
            self.chunks_with(ids).filter(|chunk| chunk.message_end_time >= from).cloned().collect();
        chunks.sort_by_key(|chunk| (chunk.message_start_time, chunk.chunk_start_offset));
        let mut first: Option<(u16, u64, Vec<u8>)> = None;
        for chunk in &chunks {
            // Chunks overlap in time where messages came out of order.
            if first.as_ref().is_some_and(|(_, time, _)| *time <= chunk.message_start_time) {
                break;
            }
            for_each_message(&mut self.source, chunk, |id, log_time, bytes| {
                let is_earlier = first.as_ref().is_none_or(|(_, time, _)| log_time < *time);
                if ids.contains(&id) && log_time >= from && is_earlier {
                    first = Some((id, log_time, bytes.to_vec()));
                }
                Ok(())
            })?;
        }
        Ok(first)
    }

    /// The topic that is meant.
    fn resolve(&self, topic: Option<&str>) -> Result<String, RecordingFault> {
        let names = self.names();
        let Some(topic) = topic else {
            return match &names[..] {
                [] => Err(RecordingFault::NoClouds),
                [only] => Ok(only.clone()),
                _ => Err(RecordingFault::SeveralTopics { topics: Names(names) }),
            };
        };
        let short = excerpt(topic.as_bytes());
        if names.iter().any(|name| name == topic) {
            return Ok(topic.to_owned());
        }
        let mut same = self.index.channels.values().filter(|channel| channel.topic == topic);
        Err(match same.next() {
            Some(channel) if !channel.has_clouds() => RecordingFault::OtherType {
                topic: short,
                found: excerpt(channel.kind.as_bytes()),
                topics: Names(names),
            },
            _ => RecordingFault::UnknownTopic { topic: short, topics: Names(names) },
        })
    }

    /// Topics with scans: those that were announced and never used are none.
    fn names(&self) -> Vec<String> {
        let names: BTreeSet<&str> = self
            .index
            .channels
            .iter()
            .filter(|(id, channel)| {
                channel.has_clouds() && self.chunks_with(&BTreeSet::from([**id])).next().is_some()
            })
            .map(|(_, channel)| channel.topic.as_str())
            .collect();
        names.into_iter().map(str::to_owned).collect()
    }

    fn channels(&self, wanted: impl Fn(&Channel) -> bool) -> impl Iterator<Item = u16> {
        self.index.channels.iter().filter(move |(_, channel)| wanted(channel)).map(|(id, _)| *id)
    }

    /// Chunks that may hold messages of some channels: not all writers say which a chunk holds.
    fn chunks_with(&self, ids: &BTreeSet<u16>) -> impl Iterator<Item = &ChunkIndex> {
        self.index.chunks.iter().filter(|chunk| {
            let held = &chunk.message_index_offsets;
            held.is_empty() || held.keys().any(|id| ids.contains(id))
        })
    }
}

fn frame_of(channel: &Channel, time: f64, bytes: &[u8]) -> Result<String, RecordingFault> {
    let topic = excerpt(channel.topic.as_bytes());
    frame_id(bytes, encoding(channel)?).map_err(|problem| RecordingFault::Message {
        topic,
        time,
        problem,
    })
}

fn encoding(channel: &Channel) -> Result<Encoding, RecordingFault> {
    match channel.encoding.as_str() {
        "cdr" => Ok(Encoding::Cdr),
        "ros1" => Ok(Encoding::Ros1),
        other => Err(RecordingFault::Encoding {
            topic: excerpt(channel.topic.as_bytes()),
            found: excerpt(other.as_bytes()),
        }),
    }
}

/// From the beginning of the recording, s.
fn seconds(log_time: u64, start: u64) -> f64 {
    log_time.saturating_sub(start) as f64 / 1e9
}
