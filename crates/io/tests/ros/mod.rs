//! A small writer of PointCloud2 messages, any part of which may be wrong.
#![allow(clippy::unwrap_used, reason = "a failing helper fails the test")]

use cloudtouch_io::pointcloud2::Encoding;

/// One field of a message.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(crate) name: String,
    pub(crate) offset: u32,
    pub(crate) datatype: u8,
    pub(crate) count: u32,
}

pub(crate) fn field(name: &str, offset: u32, datatype: u8, count: u32) -> Field {
    Field { name: name.to_owned(), offset, datatype, count }
}

/// A message part by part, as its definition lists them.
#[derive(Debug, Clone)]
pub(crate) struct Message {
    pub(crate) seconds: u32,
    pub(crate) nanoseconds: u32,
    pub(crate) frame: String,
    pub(crate) height: u32,
    pub(crate) width: u32,
    pub(crate) fields: Vec<Field>,
    pub(crate) big_endian: u8,
    pub(crate) point_step: u32,
    pub(crate) row_step: u32,
    pub(crate) data: Vec<u8>,
}

/// How a message becomes bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wire {
    LittleCdr,
    BigCdr,
    Ros1,
}

pub(crate) const ENCODINGS: [Wire; 3] = [Wire::LittleCdr, Wire::BigCdr, Wire::Ros1];

impl Wire {
    pub(crate) fn encoding(self) -> Encoding {
        if self == Self::Ros1 { Encoding::Ros1 } else { Encoding::Cdr }
    }
}

impl Message {
    /// A row of points as three floats each, in the frame `lidar` at 12 s and 345 ns.
    pub(crate) fn of_points(points: &[[f32; 3]]) -> Self {
        let width = u32::try_from(points.len()).unwrap();
        Self {
            seconds: 12,
            nanoseconds: 345,
            frame: "lidar".to_owned(),
            height: 1,
            width,
            fields: vec![field("x", 0, 7, 1), field("y", 4, 7, 1), field("z", 8, 7, 1)],
            big_endian: 0,
            point_step: 12,
            row_step: 12 * width,
            data: points.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect(),
        }
    }

    pub(crate) fn bytes(&self, wire: Wire) -> Vec<u8> {
        let mut out = Out { bytes: Vec::new(), wire };
        if wire == Wire::Ros1 {
            out.u32(77);
        }
        out.u32(self.seconds);
        out.u32(self.nanoseconds);
        out.text(&self.frame);
        out.u32(self.height);
        out.u32(self.width);
        out.u32(self.fields.len() as u32);
        for field in &self.fields {
            out.text(&field.name);
            out.u32(field.offset);
            out.bytes.push(field.datatype);
            out.u32(field.count);
        }
        out.bytes.push(self.big_endian);
        out.u32(self.point_step);
        out.u32(self.row_step);
        out.u32(self.data.len() as u32);
        out.bytes.extend(&self.data);
        out.bytes.push(1);
        let header: &[u8] = match wire {
            Wire::LittleCdr => &[0, 1, 0, 0],
            Wire::BigCdr => &[0, 0, 0, 0],
            Wire::Ros1 => &[],
        };
        [header, &out.bytes].concat()
    }
}

struct Out {
    bytes: Vec<u8>,
    wire: Wire,
}

impl Out {
    fn u32(&mut self, value: u32) {
        if self.wire != Wire::Ros1 {
            self.bytes.resize(self.bytes.len().next_multiple_of(4), 0xcc);
        }
        let is_big = self.wire == Wire::BigCdr;
        self.bytes.extend(if is_big { value.to_be_bytes() } else { value.to_le_bytes() });
    }

    fn text(&mut self, text: &str) {
        let ending: &[u8] = if self.wire == Wire::Ros1 { b"" } else { b"\0" };
        self.u32((text.len() + ending.len()) as u32);
        self.bytes.extend(text.bytes());
        self.bytes.extend(ending);
    }
}

/// Bytes of a datatype.
pub(crate) fn size(datatype: u8) -> u32 {
    [1, 1, 2, 2, 4, 4, 4, 8][usize::from(datatype) - 1]
}

/// A value as a datatype.
pub(crate) fn number(value: f64, datatype: u8, big_endian: bool) -> Vec<u8> {
    let mut bytes = match datatype {
        1 => (value as i8).to_le_bytes().to_vec(),
        2 => (value as u8).to_le_bytes().to_vec(),
        3 => (value as i16).to_le_bytes().to_vec(),
        4 => (value as u16).to_le_bytes().to_vec(),
        5 => (value as i32).to_le_bytes().to_vec(),
        6 => (value as u32).to_le_bytes().to_vec(),
        7 => (value as f32).to_le_bytes().to_vec(),
        _ => value.to_le_bytes().to_vec(),
    };
    if big_endian {
        bytes.reverse();
    }
    bytes
}
