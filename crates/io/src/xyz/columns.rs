//! Which columns of a table are a point, and what a row has in them.

use crate::{
    builder::Row,
    column_names::{count, of_comment, of_header, separator, values},
    fault::{Fault, FormatError, Place},
    text::{number, parse as parse_number},
};

/// Which columns are what, as the first row and the comments before it show.
#[derive(Debug)]
pub(super) struct Columns {
    /// `None` for white space.
    pub separator: Option<u8>,
    /// Of each value of a [`Row`] that the table has.
    pub places: Vec<usize>,
    /// The same in the order of the columns, each with its place in a [`Row`].
    wanted: Vec<(usize, usize)>,
    /// How many values a row has at least. Between white space an empty one moves all that follow it: where
    /// columns have names, or tabs between them, a row has as many as the first.
    pub fewest: usize,
    /// How many columns have names, if any: those without may be anything.
    pub names: Option<usize>,
    /// Whether the first row is the one that names them, and no point.
    pub is_header: bool,
}

impl Columns {
    pub(super) fn of(comments: &[&[u8]], first: &[u8], place: Place) -> Result<Self, FormatError> {
        let separator = separator(first);
        let is_number = |value| parse_number::<f64>(value).is_some();
        let is_header = !values(first, separator).next().is_none_or(is_number);
        let named = if is_header {
            Some(of_header(first, separator, place)?)
        } else {
            // The last of those that name columns: programs put other words below.
            let mut named =
                comments.iter().rev().map(|words| of_comment(words, first, separator).transpose());
            named.find_map(|found| found).transpose().map_err(|fault| place.error(fault))?
        };
        let is_named = named.is_some();
        // A comment has as many names as this row has numbers.
        let names = is_named.then(|| match is_header {
            true => count(first),
            false => values(first, separator).count(),
        });
        let places = named.unwrap_or_else(|| vec![0, 1, 2]);
        let mut wanted: Vec<(usize, usize)> = places.iter().copied().zip(0..).collect();
        wanted.sort_unstable();
        let fewest = match separator {
            None if is_named || first.contains(&b'\t') => count(first).max(3),
            _ => wanted.last().map_or(0, |&(column, _)| column + 1),
        };
        Ok(Self { separator, places, wanted, fewest, names, is_header })
    }

    /// What a row has of these columns, and how many it has in all.
    pub(super) fn row(&self, line: &[u8], line_number: usize) -> Result<(Row, usize), FormatError> {
        let mut row: Row = Default::default();
        let mut wanted = self.wanted.iter().peekable();
        let mut found = 0;
        for value in values(line, self.separator) {
            if let Some((_, slot)) = wanted.next_if(|(column, _)| *column == found) {
                row[*slot] = number(value, line_number, found + 1)?;
            }
            found += 1;
        }
        Ok((row, found))
    }

    /// Checks that no text with a separator in it, and no decimal comma, has moved a row of so many values to the
    /// right of its names. Words behind the coordinates move none of these.
    pub(super) fn check_surplus(&self, line: &[u8], found: usize) -> Result<(), Fault> {
        let Some(names) = self.names.filter(|names| found > *names) else { return Ok(()) };
        let values = values(line, self.separator);
        let last = self.wanted.last().map_or(0, |&(column, _)| column);
        let is_moved = match self.separator {
            Some(_) => values.skip(names).any(|value| !value.is_empty()),
            None => values.take(last).any(|value| parse_number::<f64>(value).is_none()),
        };
        if is_moved { Err(Fault::SurplusValues { names, found }) } else { Ok(()) }
    }
}
