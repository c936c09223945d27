//! Tables of coordinates as text: `.xyz`, `.txt`, `.csv`.

mod columns;
mod unnamed;

use cloudtouch_geom::PointCloud;

use crate::{
    builder::CloudBuilder,
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
    text::{Lines, excerpt},
};

use self::columns::Columns;
use self::unnamed::{refuse_a_count, refuse_many_columns};

/// Reads a point cloud from a table with one point in each line.
///
/// Values are separated by semicolons, or else by commas, or else by white space, as the first
/// line that is neither blank nor a comment (from `#`) shows. When the first value of that line is
/// not a number it names the columns: x, y, z and perhaps cov_xx, cov_xy, cov_xz, cov_yy, cov_yz,
/// cov_zz (m², all six or none), in any order and case; so does the last comment before it that has x, y
/// and z among as many words as the line has numbers. `x (m)` and `x [m]` are x, and so is `Points:0` of
/// ParaView; another unit there is refused. Without names the first three columns are x, y, z.
/// Other columns are passed over, and separators between quotes are a part of the text there. `nan` is a missing
/// return.
///
/// # Errors
/// When
/// - there is nothing but comments, or there are more points than the default [`ReadLimits`] allow,
/// - a column is missing or named twice,
/// - a row is too short; between tabs, or between white space under names, where empty values do not show: shorter
///   than the first,
/// - a row has more values than there are names, so that these do not tell which is which,
/// - a value is no number, or a covariance is none,
/// - without column names, a row seems to hold several points, or the first of four or more columns counts the rows.
pub fn parse(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    parse_within(bytes, &ReadLimits::default())
}

/// As [`parse`], with other limits than the default ones.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(bytes: &[u8], limits: &ReadLimits) -> Result<PointCloud, FormatError> {
    if [b"\xff\xfe", b"\xfe\xff"].iter().any(|mark| bytes.starts_with(*mark)) {
        return Err(Place::Whole.error(Fault::Utf16));
    }
    let mut lines = Lines::new(bytes);
    let (comments, first) = first_row(&mut lines);
    let first = first.ok_or_else(|| Place::Whole.error(Fault::Empty))?;
    let first_place = lines.place();
    let columns = Columns::of(&comments, first, first_place)?;

    let mut pending = (!columns.is_header).then_some(first);
    let mut cloud = CloudBuilder::new(&columns.places, 0, limits);
    let mut widest = (0, lines.place());
    while let Some(line) = pending.take().or_else(|| next_row(&mut lines)) {
        let (row, found) = columns.row(line, lines.number)?;
        let expected = columns.fewest;
        if found < expected {
            let is_count = columns.names.is_none() && cloud.len() == 0 && found == 1;
            return Err(lines.place().error(match is_count {
                true => Fault::CountLine { found: excerpt(line) },
                false => Fault::RowLength { expected, found },
            }));
        }
        columns.check_surplus(line, found).map_err(|fault| lines.place().error(fault))?;
        cloud.push(&row, lines.place())?;
        if found > widest.0 {
            widest = (found, lines.place());
        }
    }
    let cloud = cloud.finish();
    if columns.names.is_none() {
        let (found, place) = widest;
        refuse_many_columns(found, cloud.len()).map_err(|fault| place.error(fault))?;
        refuse_a_count(&cloud.points, found, columns.separator)
            .map_err(|fault| first_place.error(fault))?;
    }
    Ok(cloud)
}

/// The first line with something in it, and the comments before it.
fn first_row<'a>(lines: &mut Lines<'a>) -> (Vec<&'a [u8]>, Option<&'a [u8]>) {
    let mut comments = Vec::new();
    for line in lines.by_ref() {
        match line.strip_prefix(b"#") {
            Some(words) => comments.push(words),
            None => {
                let row = line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii();
                if !row.is_empty() {
                    return (comments, Some(row));
                }
            }
        }
    }
    (comments, None)
}

/// The next line with something in it, without its comment.
fn next_row<'a>(lines: &mut Lines<'a>) -> Option<&'a [u8]> {
    lines
        .by_ref()
        .map(|line| line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii())
        .find(|line| !line.is_empty())
}
