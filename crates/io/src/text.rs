//! Lines, words and numbers of text that may be hostile: bytes, not necessarily UTF-8.

use crate::fault::{Fault, FormatError, Place};

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Walks through the lines of a file and knows where it is.
#[derive(Debug, Clone)]
pub(crate) struct Lines<'a> {
    bytes: &'a [u8],
    /// Where the next line begins.
    pub(crate) position: usize,
    /// The number of the line handed out last, from 1; 0 before the first.
    pub(crate) number: usize,
}

impl<'a> Lines<'a> {
    /// A byte order mark, as spreadsheets and Windows editors write it, belongs to no line.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let position = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        Self { bytes, position, number: 0 }
    }

    /// What follows the line handed out last.
    pub(crate) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.position..]
    }

    /// Where the line handed out last is.
    pub(crate) fn place(&self) -> Place {
        Place::Line(self.number.max(1))
    }

    /// The next line that is not blank.
    pub(crate) fn next_filled(&mut self) -> Option<&'a [u8]> {
        self.find(|line| !line.is_empty())
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    /// The next line without the white space around it. Lines end in LF, CRLF or CR alone.
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let (line, taken) = match rest.iter().position(|&b| matches!(b, b'\n' | b'\r')) {
            Some(end) if rest[end..].starts_with(b"\r\n") => (&rest[..end], end + 2),
            Some(end) => (&rest[..end], end + 1),
            None => (rest, rest.len()),
        };
        self.position += taken;
        self.number += 1;
        Some(line.trim_ascii())
    }
}

/// The words of a line.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A number, NaN and infinities included; `None` when it is none.
pub(crate) fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A number, or the error of not finding one in that column (from 1).
pub(crate) fn number(word: &[u8], line: usize, column: usize) -> Result<f64, FormatError> {
    parse(word).ok_or_else(|| {
        Place::Column { line, column }.error(Fault::NotANumber { found: excerpt(word) })
    })
}

/// A finite number, or the error of not finding one in that column (from 1).
pub(crate) fn finite_number(word: &[u8], line: usize, column: usize) -> Result<f64, FormatError> {
    let value = number(word, line, column)?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Place::Column { line, column }.error(Fault::NotFinite { value }))
    }
}

/// The three finite coordinates that follow a keyword; what comes after them is passed over.
pub(crate) fn finite_triple<'a>(
    mut values: impl Iterator<Item = &'a [u8]>,
    line: usize,
) -> Result<[f64; 3], FormatError> {
    let mut triple = [0.0; 3];
    for (found, coordinate) in triple.iter_mut().enumerate() {
        let word = values
            .next()
            .ok_or_else(|| Place::Line(line).error(Fault::RowLength { expected: 3, found }))?;
        *coordinate = finite_number(word, line, found + 1)?;
    }
    Ok(triple)
}

/// Whether bytes after the last row of a binary file say nothing.
///
/// The Point Cloud Library pads its files to a memory page, other writers end them with a line end.
pub(crate) fn is_padding(bytes: &[u8]) -> bool {
    bytes.iter().all(|&b| b == 0 || b.is_ascii_whitespace())
}

/// The beginning of what was found, fit for a message.
pub(crate) fn excerpt(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * LONGEST)]);
    let mut short: String = text.chars().take(LONGEST).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_any_usual_way_and_keep_their_numbers() {
        let mut lines = Lines::new(b"one \r\n\n  two\nthree");
        assert_eq!(lines.next_filled(), Some(&b"one"[..]));
        assert_eq!((lines.number, lines.position), (1, 6));
        assert_eq!(lines.next_filled(), Some(&b"two"[..]));
        assert_eq!((lines.number, lines.rest()), (3, &b"three"[..]));
        assert_eq!(lines.next(), Some(&b"three"[..]));
        assert_eq!(lines.next(), None);
        let mut old = Lines::new(b"\xef\xbb\xbfone\rtwo\r\rthree\r");
        assert_eq!(old.by_ref().map(<[u8]>::len).collect::<Vec<_>>(), [3, 3, 0, 5]);
        assert_eq!((old.number, old.rest()), (4, &b""[..]));
    }

    #[test]
    fn excerpts_are_short_whatever_they_are_taken_from() {
        assert_eq!(excerpt(b"648"), "648");
        assert_eq!(excerpt(&[b'a'; 1000]).len(), 43);
        assert!(excerpt(&[0xff; 1000]).chars().count() <= 43);
    }
}
