//! The line of a table of coordinates that names its columns.

use crate::{
    builder::{COLUMN_NAMES, find_columns},
    fault::{Fault, FormatError, Place},
    text::{excerpt, words},
};

/// What ParaView calls the coordinates, as x, y and z.
const PARAVIEW: [[&str; 2]; 3] =
    [["points:0", "points_0"], ["points:1", "points_1"], ["points:2", "points_2"]];

/// Metres, and those of a covariance.
const UNITS: [&str; 4] = ["m", "m²", "m^2", "m2"];

/// What stands between the values of a table, where it is not white space.
pub(crate) fn separator(line: &[u8]) -> Option<u8> {
    [b';', b','].into_iter().find(|separator| line.contains(separator))
}

/// The values of a row, without the white space and quotes around them.
pub(crate) fn values(line: &[u8], separator: Option<u8>) -> Box<dyn Iterator<Item = &[u8]> + '_> {
    let Some(separator) = separator else { return Box::new(words(line)) };
    let mut rest = Some(line);
    Box::new(std::iter::from_fn(move || {
        let line = rest?;
        let end = end_of_value(line, separator);
        rest = line.get(end + 1..);
        let value = line[..end].trim_ascii();
        Some(value.strip_prefix(b"\"").and_then(|v| v.strip_suffix(b"\"")).unwrap_or(value))
    }))
}

/// Where the first value ends: at a separator that is not between quotes, or with the line.
fn end_of_value(line: &[u8], separator: u8) -> usize {
    let text = line.trim_ascii_start();
    let quoted = text.strip_prefix(b"\"").and_then(closing_quote);
    let from = quoted.map_or(0, |length| line.len() - text.len() + 1 + length);
    line[from..].iter().position(|&b| b == separator).map_or(line.len(), |at| from + at)
}

/// Where the quote is that closes a text; one of the text itself is there twice.
fn closing_quote(text: &[u8]) -> Option<usize> {
    let mut at = 0;
    loop {
        at += text[at..].iter().position(|&b| b == b'"')?;
        if text.get(at + 1) != Some(&b'"') {
            return Some(at);
        }
        at += 2;
    }
}

/// The columns that the first line names.
pub(crate) fn of_header(
    line: &[u8],
    separator: Option<u8>,
    place: Place,
) -> Result<Vec<usize>, FormatError> {
    let line = without_slashes(line);
    let names = names(line, separator).map_err(|fault| place.error(fault))?;
    find_columns(names.iter().map(String::as_str)).map_err(|fault| match fault {
        // Whoever meant a row of numbers is helped more by seeing what was taken for names.
        Fault::MissingColumn { .. } if !names.iter().any(|n| n.eq_ignore_ascii_case("x")) => place
            .error(Fault::BadEntry {
                entry: "the first row",
                found: excerpt(line),
                expected: "three numbers, or column names with x, y and z",
            }),
        fault => place.error(fault),
    })
}

/// The columns that a comment names, as numpy writes a header: one for each number of the first row.
pub(crate) fn of_comment(
    comment: &[u8],
    row: &[u8],
    separator_of_rows: Option<u8>,
) -> Result<Option<Vec<usize>>, Fault> {
    let words = comment.trim_ascii();
    let names = match names(words, separator(words)) {
        // A unit in the middle of prose names no column.
        Err(fault) if count(words) == count(row) => return Err(fault),
        Err(_) => return Ok(None),
        Ok(names) => names,
    };
    let is_whole = names.len() == values(row, separator_of_rows).count();
    Ok(is_whole.then(|| find_columns(names.iter().map(String::as_str)).ok()).flatten())
}

/// How many columns a line names.
pub(crate) fn count(line: &[u8]) -> usize {
    let line = without_slashes(line);
    joined(line, separator(line)).len()
}

/// CloudCompare puts two slashes before its column names.
fn without_slashes(line: &[u8]) -> &[u8] {
    line.strip_prefix(b"//").unwrap_or(line).trim_ascii_start()
}

/// The names as [`find_columns`] knows them.
fn names(line: &[u8], separator: Option<u8>) -> Result<Vec<String>, Fault> {
    joined(line, separator).into_iter().map(plain).collect()
}

/// The names as they stand, each with its unit: white space is between these too.
fn joined(line: &[u8], separator: Option<u8>) -> Vec<String> {
    let mut names = Vec::<String>::new();
    for value in values(line, separator) {
        let name = String::from_utf8_lossy(value);
        match names.last_mut() {
            Some(last) if separator.is_none() && name.starts_with(['(', '[']) => {
                last.push_str(&name);
            }
            _ => names.push(name.into_owned()),
        }
    }
    names
}

/// A name without its unit, where that is metres; x, y or z for what others call them.
fn plain(name: String) -> Result<String, Fault> {
    let is_of = |names: &[&str; 2]| names.iter().any(|other| name.eq_ignore_ascii_case(other));
    if let Some(axis) = PARAVIEW.iter().position(is_of) {
        return Ok(COLUMN_NAMES[axis].to_owned());
    }
    let Some((column, unit)) = name.split_once(['(', '[']) else { return Ok(name) };
    let (column, unit) = (column.trim(), unit.trim_end_matches([')', ']']).trim());
    if !COLUMN_NAMES.iter().any(|known| known.eq_ignore_ascii_case(column)) {
        return Ok(name);
    }
    if UNITS.contains(&unit) {
        return Ok(column.to_owned());
    }
    let unit = excerpt(unit.as_bytes());
    Err(Fault::ColumnUnit { column: column.to_owned(), unit })
}
