//! Tables of coordinates as text: `.xyz`, `.txt`, `.csv`.

use cloudtouch_geom::{Point3, PointCloud};

use crate::{
    builder::{CloudBuilder, Row},
    column_names::{self, values},
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
    text::{Lines, excerpt, number, parse as parse_number},
};

/// A row without column names has no more numbers than this.
const MOST_COLUMNS: usize = 20;

/// Reads a point cloud from a table with one point in each line.
///
/// Values are separated by semicolons, or else by commas, or else by white space, as the first
/// line that is neither blank nor a comment (from `#`) shows. When the first value of that line is
/// not a number it names the columns: x, y, z and perhaps cov_xx, cov_xy, cov_xz, cov_yy, cov_yz,
/// cov_zz (m², all six or none), in any order and case; so does the last comment before it, when it has x, y
/// and z among as many words as the line has numbers. `x (m)` and `x [m]` are x, and so is `Points:0` of
/// ParaView; another unit there is refused. Without names the first three columns are x, y, z.
/// Other columns are passed over. `nan` is a missing return.
///
/// # Errors
/// When there is nothing but comments, a column is missing or named twice, a row is too short, a
/// value is no number, a covariance is none, a row
/// without column names seems to hold several points, the first of four or more such columns counts the rows, or there are more points than the default [`ReadLimits`] allow.
pub fn parse(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    parse_within(bytes, &ReadLimits::default())
}

/// As [`parse`], with other limits than the default ones.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(bytes: &[u8], limits: &ReadLimits) -> Result<PointCloud, FormatError> {
    let mut lines = Lines::new(bytes);
    let (comment, first) = first_row(&mut lines);
    let first = first.ok_or_else(|| Place::Byte(0).error(Fault::Empty))?;
    let first_place = lines.place();
    let separator = column_names::separator(first);

    let mut pending = None;
    let mut is_named = true;
    let columns =
        if values(first, separator).next().is_none_or(|v| parse_number::<f64>(v).is_some()) {
            pending = Some(first);
            let by_comment = match comment {
                Some(comment) => column_names::of_comment(comment, first, separator)
                    .map_err(|fault| first_place.error(fault))?,
                None => None,
            };
            is_named = by_comment.is_some();
            by_comment.unwrap_or_else(|| vec![0, 1, 2])
        } else {
            column_names::of_header(first, separator, lines.place())?
        };
    let mut wanted: Vec<(usize, usize)> = columns.iter().copied().zip(0..).collect();
    wanted.sort_unstable();
    let expected = wanted.last().map_or(0, |&(column, _)| column + 1);

    let mut cloud = CloudBuilder::new(&columns, 0, limits);
    let mut widest = (0, lines.place());
    while let Some(line) = pending.take().or_else(|| next_row(&mut lines)) {
        let mut row: Row = Default::default();
        let mut targets = wanted.iter().peekable();
        let mut found = 0;
        for value in values(line, separator) {
            match targets.peek() {
                None => {}
                Some(&&(column, slot)) if column == found => {
                    row[slot] = number(value, lines.number, found + 1)?;
                    targets.next();
                }
                Some(_) => {}
            }
            found += 1;
        }
        if targets.peek().is_some() {
            if !is_named && cloud.len() == 0 && found == 1 {
                return Err(lines.place().error(Fault::CountLine { found: excerpt(line) }));
            }
            return Err(lines.place().error(Fault::RowLength { expected, found }));
        }
        cloud.push(&row, lines.place())?;
        if found > widest.0 {
            widest = (found, lines.place());
        }
    }
    let (columns, place) = widest;
    // Normals, colours and an intensity are columns of a point; more numbers are more points.
    let are_points = columns > MOST_COLUMNS || cloud.len() == 1 && columns >= 6 && columns % 3 == 0;
    if !is_named && are_points {
        return Err(place.error(Fault::ManyColumns { found: columns }));
    }
    let cloud = cloud.finish();
    if !is_named && columns > 3 {
        refuse_a_count(&cloud.points, separator).map_err(|fault| first_place.error(fault))?;
    }
    Ok(cloud)
}

/// Fewer rows in equal steps may be chance, or a few points set by hand.
const FEWEST_COUNTED: usize = 10;

/// A share of a step: times are rounded as they are written, such as .033, .067, .100.
const STEP_TOLERANCE: f64 = 0.05;

/// A time or a row number taken for x puts the cloud where nothing is, which reads free. Points in rows
/// and columns go back to their first x, so only a single line of them along x is taken for a count.
fn refuse_a_count(points: &[Point3], separator: Option<u8>) -> Result<(), Fault> {
    let [first, .., last] = points else { return Ok(()) };
    let step = (last.x - first.x) / (points.len() - 1) as f64;
    let is_counted = |(row, point): (usize, &Point3)| {
        (point.x - (first.x + row as f64 * step)).abs() <= STEP_TOLERANCE * step
    };
    if points.len() < FEWEST_COUNTED || step <= 0.0 || !points.iter().enumerate().all(is_counted) {
        return Ok(());
    }
    Err(Fault::CountedRows {
        rows: points.len(),
        first: first.x,
        step,
        separator: char::from(separator.unwrap_or(b' ')),
    })
}

/// The first line with something in it, and the last comment before it.
fn first_row<'a>(lines: &mut Lines<'a>) -> (Option<&'a [u8]>, Option<&'a [u8]>) {
    let mut comment = None;
    for line in lines.by_ref() {
        match line.strip_prefix(b"#") {
            Some(words) => comment = Some(words),
            None => {
                let row = line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii();
                if !row.is_empty() {
                    return (comment, Some(row));
                }
            }
        }
    }
    (comment, None)
}

/// The next line with something in it, without its comment.
fn next_row<'a>(lines: &mut Lines<'a>) -> Option<&'a [u8]> {
    lines
        .by_ref()
        .map(|line| line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii())
        .find(|line| !line.is_empty())
}
