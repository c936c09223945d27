//! From the bytes of a message to a cloud.

use cloudtouch_geom::PointCloud;

use super::cursor::{Cursor, Encoding};
use super::header::{self, Header};
use crate::{
    builder::{CloudBuilder, Row},
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
    text::is_padding,
};

/// A cloud with what a message says of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// In the frame `frame_id`, with the sensor at its origin; m by the conventions of ROS.
    pub cloud: PointCloud,
    /// The name of the frame. No transform is applied: where that frame is, others tell (`/tf`).
    pub frame_id: String,
    /// When it was measured by the clock of the driver, ns since that clock's epoch.
    pub stamp_ns: i64,
}

/// Reads a scan from the bytes of a `sensor_msgs/PointCloud2`.
///
/// Fields may come in any order, of any of the eight types, with gaps between them; other fields
/// than x, y, z and cov_xx, cov_xy, cov_xz, cov_yy, cov_yz, cov_zz (m², all six or none) are passed
/// over. A row without a return stays as a NaN row, whatever `is_dense` says. A cloud of one row or
/// one column is not an image. `row_step` counts where there are several rows.
///
/// # Errors
/// When the bytes end too early or go on after the message, a column is missing or lies outside of
/// `point_step`, there are fewer or more points than `width` times `height` (found before memory is
/// taken), a covariance is none, or there are more points than the default [`ReadLimits`] allow.
pub fn parse(bytes: &[u8], encoding: Encoding) -> Result<Scan, FormatError> {
    parse_within(bytes, encoding, &ReadLimits::default())
}

/// As [`parse`], with other limits than the default ones.
///
/// # Errors
/// As [`parse`].
pub fn parse_within(
    bytes: &[u8],
    encoding: Encoding,
    limits: &ReadLimits,
) -> Result<Scan, FormatError> {
    let mut cursor = Cursor::new(bytes, encoding)?;
    let header = header::read(&mut cursor, encoding)?;
    let promised = header.width.saturating_mul(header.height);
    limits.check_points(promised, header.size_place)?;

    let length = cursor.u32("the length of data")? as usize;
    let start = cursor.position();
    let data = cursor.take(length, "data")?;
    cursor.bool("is_dense")?;
    if !is_padding(cursor.rest()) {
        return Err(Place::Byte(cursor.position()).error(Fault::Leftover { promised }));
    }
    let cloud = gather(&header, data, start, limits)?;
    let image_size =
        (header.width > 1 && header.height > 1).then_some((header.width, header.height));
    let cloud = PointCloud { image_size, ..cloud };
    Ok(Scan { cloud, frame_id: header.frame_id, stamp_ns: header.stamp_ns })
}

/// The frame of a scan, without a look at its points.
///
/// # Errors
/// When the bytes end before it, or it is no text.
pub fn frame_id(bytes: &[u8], encoding: Encoding) -> Result<String, FormatError> {
    let mut cursor = Cursor::new(bytes, encoding)?;
    Ok(header::stamp_and_frame(&mut cursor, encoding)?.1)
}

/// The points of the data, which begin at the byte `start` of the message.
fn gather(
    header: &Header,
    data: &[u8],
    start: usize,
    limits: &ReadLimits,
) -> Result<PointCloud, FormatError> {
    let (width, height, step) = (header.width, header.height, header.point_step);
    let promised = width * height;
    // Of no points there are no rows either, however many the message promises.
    let rows = if promised == 0 { 0 } else { height };
    let row = width.saturating_mul(step);
    let row_step = if height > 1 { header.row_step } else { row.max(header.row_step) };
    // The padding after the last row need not be there.
    let needed = match rows.checked_sub(1) {
        Some(full) => full.saturating_mul(row_step).saturating_add(row),
        None => 0,
    };
    if data.len() < needed {
        let fault = Fault::TooShort { promised, needed, available: data.len() };
        return Err(Place::Byte(start).error(fault));
    }
    let end = rows.saturating_mul(row_step).min(data.len());
    if !is_padding(&data[end..]) {
        return Err(Place::Byte(start + end).error(Fault::Leftover { promised }));
    }
    let indices: Vec<usize> = (0..header.columns.len()).collect();
    let mut cloud = CloudBuilder::new(&indices, promised, limits);
    let mut values: Row = Default::default();
    for at in (0..promised).map(|i| i / width * row_step + i % width * step) {
        for (value, column) in values.iter_mut().zip(&header.columns) {
            *value = column.scalar.read(&data[at + column.offset..], header.order);
        }
        cloud.push(&values, Place::Byte(start + at))?;
    }
    Ok(cloud.finish())
}
