//! From the bytes of a PCD file to a cloud.

use std::borrow::Cow;

use cloudtouch_geom::PointCloud;

use super::header::{self, Data, Field, Header};
use crate::{
    builder::{CloudBuilder, Row, find_columns},
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
    scalar::{ByteOrder, Scalar},
    text::{Lines, is_padding, number, words},
};

/// No LZF stream unpacks to more than this many times its size: three bytes stand for at most 264.
const LARGEST_EXPANSION: usize = 88;

/// Reads a point cloud from the bytes of a PCD file.
///
/// Fields may come in any order; other fields than x, y, z and cov_xx, cov_xy, cov_xz, cov_yy,
/// cov_yz, cov_zz (m², all six or none) are passed over. Numbers keep full double precision, and a
/// row without a return stays as a NaN row. VIEWPOINT becomes
/// [`sensor_pose`](PointCloud::sensor_pose), its rotation included; points are not moved by it. The identity
/// counts as not stated, for that is what writers put who do not know. A cloud of one row or one column is not an
/// image.
///
/// # Errors
/// When the header lacks or contradicts something, the file is shorter than it promises (found
/// before memory is taken), a value is no number, a covariance is none, VIEWPOINT is no pose, or there are more points
/// than the default [`ReadLimits`] allow.
pub fn parse(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    parse_within(bytes, &ReadLimits::default())
}

/// As [`parse`], with other limits than the default ones.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(bytes: &[u8], limits: &ReadLimits) -> Result<PointCloud, FormatError> {
    let mut lines = Lines::new(bytes);
    let header = header::read(&mut lines)?;
    let columns = find_columns(header.fields.iter().map(|field| field.name.as_str()))
        .map_err(|fault| header.fields_place.error(fault))?;
    if let Some(&many) = columns.iter().find(|&&field| header.fields[field].count != 1) {
        return Err(header.fields_place.error(Fault::BadEntry {
            entry: "COUNT",
            found: header.fields[many].count.to_string(),
            expected: "1 for coordinates and covariances",
        }));
    }
    let cloud = parse_columns(&header, &columns, lines, limits)?;
    Ok(PointCloud { image_size: header.image_size, sensor_pose: header.sensor_pose, ..cloud })
}

/// The rows that follow a header; `columns` are the fields for coordinates, and for covariances if
/// there are any.
pub(super) fn parse_columns(
    header: &Header,
    columns: &[usize],
    lines: Lines<'_>,
    limits: &ReadLimits,
) -> Result<PointCloud, FormatError> {
    match header.data {
        Data::Ascii => parse_ascii(header, columns, lines, limits),
        Data::Binary => parse_binary(header, columns, lines, limits),
        Data::BinaryCompressed => parse_compressed(header, columns, lines, limits),
    }
}

fn parse_ascii(
    header: &Header,
    columns: &[usize],
    mut lines: Lines<'_>,
    limits: &ReadLimits,
) -> Result<PointCloud, FormatError> {
    // Which word of a row goes where, in the order of the words.
    let word_of = |field: usize| {
        header.fields[..field].iter().fold(0, |sum: usize, f| sum.saturating_add(f.count))
    };
    let mut wanted: Vec<(usize, usize)> =
        columns.iter().enumerate().map(|(slot, &field)| (word_of(field), slot)).collect();
    wanted.sort_unstable();
    let expected = word_of(header.fields.len());

    // A number and its separator take two bytes.
    let capacity = header.points.min(lines.rest().len() / expected.saturating_mul(2) + 1);
    let mut cloud = CloudBuilder::new(columns, capacity, limits);
    while let Some(line) = lines.next_filled() {
        if line.starts_with(b"#") {
            continue;
        }
        if cloud.len() == header.points {
            return Err(lines.place().error(Fault::Leftover { promised: header.points }));
        }
        let mut values: Row = Default::default();
        let mut next = wanted.iter();
        let mut target = next.next();
        let mut found = 0;
        for word in words(line) {
            if let Some(&(_, slot)) = target.filter(|&&(at, _)| at == found) {
                values[slot] = number(word, lines.number, found + 1)?;
                target = next.next();
            }
            found += 1;
        }
        if found != expected {
            return Err(lines.place().error(Fault::RowLength { expected, found }));
        }
        cloud.push(&values, lines.place())?;
    }
    if cloud.len() < header.points {
        let (promised, found) = (header.points, cloud.len());
        return Err(lines.place().error(Fault::FewRows { promised, found }));
    }
    Ok(cloud.finish())
}

fn parse_binary(
    header: &Header,
    columns: &[usize],
    lines: Lines<'_>,
    limits: &ReadLimits,
) -> Result<PointCloud, FormatError> {
    let (body, start) = (lines.rest(), lines.position);
    let record = size_of_fields(&header.fields);
    let needed = header.points.saturating_mul(record);
    let Some((_, rest)) = body.split_at_checked(needed) else {
        let (promised, available) = (header.points, body.len());
        return Err(Place::Byte(start).error(Fault::TooShort { promised, needed, available }));
    };
    check_end(header, rest, start + needed)?;
    limits.check_points(header.points, header.points_place)?;
    let columns = columns.iter().map(|&field| Column {
        start: size_of_fields(&header.fields[..field]),
        stride: record,
        scalar: header.fields[field].scalar,
    });
    gather(body, header.points, &columns.collect::<Vec<_>>(), limits, |row| start + row * record)
}

fn parse_compressed(
    header: &Header,
    columns: &[usize],
    lines: Lines<'_>,
    limits: &ReadLimits,
) -> Result<PointCloud, FormatError> {
    let start = lines.position;
    let body = unpack(header, lines.rest(), start, limits)?;
    // Unpacked, each field is stored for all points before the next one begins.
    let columns = columns.iter().map(|&field| Column {
        start: size_of_fields(&header.fields[..field]).saturating_mul(header.points),
        stride: header.fields[field].scalar.size(),
        scalar: header.fields[field].scalar,
    });
    gather(&body, header.points, &columns.collect::<Vec<_>>(), limits, |_| start)
}

/// The uncompressed fields; as long as the header says.
fn unpack<'a>(
    header: &Header,
    body: &'a [u8],
    start: usize,
    limits: &ReadLimits,
) -> Result<Cow<'a, [u8]>, FormatError> {
    if header.points == 0 {
        check_end(header, body, start)?;
        return Ok(Cow::Borrowed(&[]));
    }
    let damaged = |reason| Place::Byte(start).error(Fault::Compression { reason });
    let too_short = |needed| {
        let (promised, available) = (header.points, body.len());
        Place::Byte(start).error(Fault::TooShort { promised, needed, available })
    };
    let (sizes, packed) = body.split_at_checked(8).ok_or_else(|| too_short(8))?;
    let size = |at: usize| Scalar::U32.read(&sizes[at..], ByteOrder::Little) as usize;
    let (packed_size, size) = (size(0), size(4));
    let (packed, rest) = packed
        .split_at_checked(packed_size)
        .ok_or_else(|| too_short(packed_size.saturating_add(8)))?;
    check_end(header, rest, start + 8 + packed_size)?;
    if header.points.checked_mul(size_of_fields(&header.fields)) != Some(size) {
        return Err(damaged("does not unpack to POINTS times the size of a point"));
    }
    if size > packed_size.saturating_mul(LARGEST_EXPANSION) {
        return Err(damaged("is too short to unpack to the size it announces"));
    }
    limits.check_points(header.points, header.points_place)?;
    limits.check_unpacked(size, Place::Byte(start))?;
    // The unpacker counts with 32-bit signed numbers.
    if size > i32::MAX as usize {
        return Err(damaged("unpacks to more than 2 GiB"));
    }
    match lzf::decompress(packed, size) {
        Ok(unpacked) if unpacked.len() == size => Ok(Cow::Owned(unpacked)),
        Ok(_) => Err(damaged("unpacks to less than the size it announces")),
        Err(lzf::LzfError::BufferTooSmall) => {
            Err(damaged("unpacks to more than the size it announces"))
        }
        Err(_) => Err(damaged("is not a valid LZF stream")),
    }
}

/// Where the values of one field are among the bytes.
struct Column {
    start: usize,
    stride: usize,
    scalar: Scalar,
}

fn gather(
    bytes: &[u8],
    points: usize,
    columns: &[Column],
    limits: &ReadLimits,
    byte_of_row: impl Fn(usize) -> usize,
) -> Result<PointCloud, FormatError> {
    let indices: Vec<usize> = (0..columns.len()).collect();
    let mut cloud = CloudBuilder::new(&indices, points, limits);
    let mut values: Row = Default::default();
    for row in 0..points {
        for (value, column) in values.iter_mut().zip(columns) {
            let at = column.start + row * column.stride;
            *value = column.scalar.read(&bytes[at..], ByteOrder::Little);
        }
        cloud.push(&values, Place::Byte(byte_of_row(row)))?;
    }
    Ok(cloud.finish())
}

/// Bytes of some fields of one point; saturates, as a header may claim anything.
fn size_of_fields(fields: &[Field]) -> usize {
    fields.iter().fold(0, |sum: usize, field| {
        sum.saturating_add(field.scalar.size().saturating_mul(field.count))
    })
}

/// Whether nothing more follows the points.
fn check_end(header: &Header, rest: &[u8], byte: usize) -> Result<(), FormatError> {
    if is_padding(rest) {
        return Ok(());
    }
    Err(Place::Byte(byte).error(Fault::Leftover { promised: header.points }))
}
