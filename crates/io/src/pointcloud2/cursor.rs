//! The two ways in which ROS writes the parts of a message one after another.

use crate::{
    fault::{Fault, FormatError, Place},
    scalar::ByteOrder,
    text::excerpt,
};

/// How the parts of a message were turned into bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// ROS 2: plain CDR, whose first four bytes tell the byte order; numbers are aligned to their
    /// size, texts end with a zero byte.
    Cdr,
    /// ROS 1: little endian, nothing aligned.
    Ros1,
}

/// Walks through the parts of a message and knows where it is.
#[derive(Debug)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    /// Where the next part begins, before it is aligned.
    position: usize,
    encoding: Encoding,
    order: ByteOrder,
}

/// Bytes before the first part of a CDR message: they do not count for the alignment.
const ENCAPSULATION: usize = 4;

impl<'a> Cursor<'a> {
    /// Before the first part of a message.
    pub(super) fn new(bytes: &'a [u8], encoding: Encoding) -> Result<Self, FormatError> {
        let (position, order) = match (encoding, bytes) {
            (Encoding::Ros1, _) => (0, ByteOrder::Little),
            (Encoding::Cdr, [0, 0, _, _, ..]) => (ENCAPSULATION, ByteOrder::Big),
            (Encoding::Cdr, [0, 1, _, _, ..]) => (ENCAPSULATION, ByteOrder::Little),
            (Encoding::Cdr, [a, b, _, _, ..]) => {
                return Err(Place::Byte(0).error(Fault::BadEntry {
                    entry: "the representation",
                    found: format!("{a:02x} {b:02x}"),
                    expected: "00 00 or 00 01, plain CDR as ROS 2 records it",
                }));
            }
            (Encoding::Cdr, _) => return Err(end(bytes, "the CDR header")),
        };
        Ok(Self { bytes, position, encoding, order })
    }

    /// Where the next part begins, if it is a byte.
    pub(super) fn position(&self) -> usize {
        self.position
    }

    /// Where the next part begins, if it is a number of four bytes.
    pub(super) fn place_of_u32(&self) -> Place {
        Place::Byte(self.aligned())
    }

    fn aligned(&self) -> usize {
        match self.encoding {
            Encoding::Cdr => {
                ENCAPSULATION + (self.position - ENCAPSULATION).next_multiple_of(size_of::<u32>())
            }
            Encoding::Ros1 => self.position,
        }
    }

    /// The next `length` bytes.
    pub(super) fn take(
        &mut self,
        length: usize,
        expected: &'static str,
    ) -> Result<&'a [u8], FormatError> {
        let rest = self.rest();
        let taken = rest.get(..length).ok_or_else(|| end(self.bytes, expected))?;
        self.position += length;
        Ok(taken)
    }

    pub(super) fn u8(&mut self, expected: &'static str) -> Result<u8, FormatError> {
        Ok(self.take(1, expected)?[0])
    }

    pub(super) fn u32(&mut self, expected: &'static str) -> Result<u32, FormatError> {
        self.position = self.aligned();
        let mut raw = [0; size_of::<u32>()];
        raw.copy_from_slice(self.take(size_of::<u32>(), expected)?);
        Ok(match self.order {
            ByteOrder::Little => u32::from_le_bytes(raw),
            ByteOrder::Big => u32::from_be_bytes(raw),
        })
    }

    /// A truth value, which is one byte.
    pub(super) fn bool(&mut self, entry: &'static str) -> Result<bool, FormatError> {
        let place = Place::Byte(self.position);
        match self.u8(entry)? {
            0 => Ok(false),
            1 => Ok(true),
            other => Err(place.error(Fault::BadEntry {
                entry,
                found: other.to_string(),
                expected: "0 or 1",
            })),
        }
    }

    /// A text of UTF-8.
    pub(super) fn text(&mut self, entry: &'static str) -> Result<&'a str, FormatError> {
        let length = self.u32(entry)? as usize;
        let place = Place::Byte(self.position);
        let mut text = self.take(length, entry)?;
        if self.encoding == Encoding::Cdr {
            text = text.strip_suffix(&[0]).unwrap_or(text);
        }
        std::str::from_utf8(text).map_err(|_| {
            place.error(Fault::BadEntry { entry, found: excerpt(text), expected: "UTF-8" })
        })
    }

    /// What follows the part taken last.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position..).unwrap_or_default()
    }
}

fn end(bytes: &[u8], expected: &'static str) -> FormatError {
    Place::Byte(bytes.len()).error(Fault::MessageEnd { expected })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_aligned_in_cdr_and_not_in_ros_1() {
        // Aligned from the fifth byte on, as the first four are not part of it.
        let cdr = [0, 1, 0, 0, 9, 99, 99, 99, 1, 2, 0, 0];
        let mut cursor = Cursor::new(&cdr, Encoding::Cdr).unwrap();
        assert_eq!(cursor.u8("a"), Ok(9));
        assert_eq!(cursor.place_of_u32(), Place::Byte(8));
        assert_eq!(cursor.u32("b"), Ok(0x201));
        assert!(cursor.rest().is_empty());
        let mut cursor = Cursor::new(&[9, 1, 2, 0, 0], Encoding::Ros1).unwrap();
        assert_eq!((cursor.u8("a"), cursor.u32("b")), (Ok(9), Ok(0x201)));
        let mut cursor = Cursor::new(&[0, 0, 0, 0, 0, 0, 2, 1], Encoding::Cdr).unwrap();
        assert_eq!(cursor.u32("big"), Ok(0x201));
    }

    #[test]
    fn texts_end_with_a_zero_byte_in_cdr_alone() {
        let cdr = [0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0];
        assert_eq!(Cursor::new(&cdr, Encoding::Cdr).unwrap().text("t"), Ok("ab"));
        // Some writers leave the zero byte out.
        let cdr = [0, 1, 0, 0, 2, 0, 0, 0, b'a', b'b'];
        assert_eq!(Cursor::new(&cdr, Encoding::Cdr).unwrap().text("t"), Ok("ab"));
        let ros1 = [2, 0, 0, 0, b'a', b'b'];
        assert_eq!(Cursor::new(&ros1, Encoding::Ros1).unwrap().text("t"), Ok("ab"));
    }

    #[test]
    fn what_is_not_there_is_an_error_at_the_end() {
        let mut cursor = Cursor::new(&[9, 0, 0, 0, b'a'], Encoding::Ros1).unwrap();
        let error = cursor.text("frame_id").unwrap_err();
        assert_eq!(error, Place::Byte(5).error(Fault::MessageEnd { expected: "frame_id" }));
        for bytes in [&[0, 1, 0][..], &[0, 7, 0, 0], b"ply\n"] {
            assert!(Cursor::new(bytes, Encoding::Cdr).is_err(), "{bytes:?}");
        }
    }
}
