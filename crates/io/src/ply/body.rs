//! The rows of a PLY file, one number after another, whether binary or text.

use crate::{
    fault::{Fault, FormatError, Place},
    scalar::{ByteOrder, Scalar},
    text::{Lines, excerpt, number, words},
};

/// What follows the header.
#[derive(Debug)]
pub(super) enum Body<'a> {
    Binary { bytes: &'a [u8], position: usize, row_start: usize, order: ByteOrder },
    Text { lines: Lines<'a>, row: &'a [u8], column: usize },
}

impl<'a> Body<'a> {
    pub(super) fn new(bytes: &'a [u8], lines: Lines<'a>, order: Option<ByteOrder>) -> Self {
        match order {
            Some(order) => {
                let position = lines.position;
                Self::Binary { bytes, position, row_start: position, order }
            }
            None => Self::Text { lines, row: &[], column: 0 },
        }
    }

    pub(super) fn is_binary(&self) -> bool {
        matches!(self, Self::Binary { .. })
    }

    /// What is still to be read.
    pub(super) fn unread(&self) -> &'a [u8] {
        match self {
            Self::Binary { bytes, position, .. } => &bytes[*position..],
            Self::Text { lines, .. } => lines.rest(),
        }
    }

    /// Just after the current row.
    pub(super) fn end_place(&self) -> Place {
        match self {
            Self::Binary { position, .. } => Place::Byte(*position),
            Self::Text { lines, .. } => Place::Line(lines.number + 1),
        }
    }

    /// Where the current row begins.
    pub(super) fn place(&self) -> Place {
        match self {
            Self::Binary { row_start, .. } => Place::Byte(*row_start),
            Self::Text { lines, .. } => lines.place(),
        }
    }

    /// Where the number handed out last is; of a binary file, where its row begins.
    pub(super) fn value_place(&self) -> Place {
        match self {
            Self::Binary { row_start, .. } => Place::Byte(*row_start),
            Self::Text { lines, column, .. } => {
                Place::Column { line: lines.number, column: *column }
            }
        }
    }

    /// Goes to row `found` of the `promised` ones.
    pub(super) fn begin_row(&mut self, found: usize, promised: usize) -> Result<(), FormatError> {
        match self {
            Self::Binary { position, row_start, .. } => *row_start = *position,
            Self::Text { lines, row, column } => {
                *row = lines
                    .next_filled()
                    .ok_or_else(|| lines.place().error(Fault::FewRows { promised, found }))?;
                *column = 0;
            }
        }
        Ok(())
    }

    /// The next number of the row.
    pub(super) fn value(&mut self, scalar: Scalar) -> Result<f64, FormatError> {
        match self {
            Self::Binary { bytes, position, order, .. } => {
                let rest = &bytes[*position..];
                if rest.len() < scalar.size() {
                    let end = Fault::UnexpectedEnd { expected: "the rest of the row" };
                    return Err(Place::Byte(bytes.len()).error(end));
                }
                *position += scalar.size();
                Ok(scalar.read(rest, *order))
            }
            Self::Text { lines, row, column } => {
                if row.is_empty() {
                    let (expected, found) = (*column + 1, *column);
                    return Err(lines.place().error(Fault::RowLength { expected, found }));
                }
                *column += 1;
                let end = row.iter().position(u8::is_ascii_whitespace).unwrap_or(row.len());
                let word = &row[..end];
                *row = row[end..].trim_ascii_start();
                number(word, lines.number, *column)
            }
        }
    }

    /// Checks that the row has no more numbers.
    pub(super) fn end_row(&self) -> Result<(), FormatError> {
        match self {
            Self::Text { lines, row, column } if !row.is_empty() => {
                let found = column + words(row).count();
                let fault = Fault::RowLength { expected: *column, found };
                Err(lines.place().error(fault))
            }
            _ => Ok(()),
        }
    }

    /// A whole number below `limit`, or the error that `fault` makes of what is there instead.
    pub(super) fn whole(
        &mut self,
        scalar: Scalar,
        limit: usize,
        fault: impl FnOnce(String) -> Fault,
    ) -> Result<usize, FormatError> {
        let value = self.value(scalar)?;
        if value >= 0.0 && value < limit as f64 && value.fract() == 0.0 {
            Ok(value as usize)
        } else {
            Err(self.value_place().error(fault(excerpt(value.to_string().as_bytes()))))
        }
    }
}
