//! What a message says of its points before they come.

use super::cursor::{Cursor, Encoding};
use crate::{
    builder::find_columns,
    fault::{Fault, FormatError, Place},
    scalar::{ByteOrder, Scalar},
};

/// Everything up to the length of the data.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) stamp_ns: i64,
    pub(super) frame_id: String,
    pub(super) height: usize,
    pub(super) width: usize,
    /// Where height and width are, for errors about their product.
    pub(super) size_place: Place,
    /// Those for coordinates, and for covariances if there are any.
    pub(super) columns: Vec<Column>,
    pub(super) order: ByteOrder,
    pub(super) point_step: usize,
    pub(super) row_step: usize,
}

/// Where the values of one column are among the bytes of a point.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) offset: usize,
    pub(super) scalar: Scalar,
}

/// One entry of `fields`.
struct Field<'a> {
    place: Place,
    name: &'a str,
    offset: u32,
    datatype: u8,
    count: u32,
}

/// When a message was measured (ns) and in which frame.
pub(super) fn stamp_and_frame(
    cursor: &mut Cursor<'_>,
    encoding: Encoding,
) -> Result<(i64, String), FormatError> {
    if encoding == Encoding::Ros1 {
        cursor.u32("header.seq")?;
    }
    let seconds = cursor.u32("header.stamp")?;
    let nanoseconds = cursor.u32("header.stamp")?;
    // Only ROS 2 has a sign.
    let seconds = match encoding {
        Encoding::Cdr => i64::from(seconds.cast_signed()),
        Encoding::Ros1 => i64::from(seconds),
    };
    let frame_id = cursor.text("header.frame_id")?.to_owned();
    Ok((seconds * 1_000_000_000 + i64::from(nanoseconds), frame_id))
}

pub(super) fn read(cursor: &mut Cursor<'_>, encoding: Encoding) -> Result<Header, FormatError> {
    let (stamp_ns, frame_id) = stamp_and_frame(cursor, encoding)?;
    let size_place = cursor.place_of_u32();
    let height = cursor.u32("height")? as usize;
    let width = cursor.u32("width")? as usize;

    let fields_place = cursor.place_of_u32();
    let fields = fields(cursor)?;
    let found = find_columns(fields.iter().map(|field| field.name))
        .map_err(|fault| fields_place.error(fault))?;

    let order = if cursor.bool("is_bigendian")? { ByteOrder::Big } else { ByteOrder::Little };
    let point_step = cursor.u32("point_step")? as usize;
    let row_place = cursor.place_of_u32();
    let row_step = cursor.u32("row_step")? as usize;
    // Drivers leave it unset where there is one row, and there it says nothing.
    if height > 1 && width.checked_mul(point_step).is_none_or(|row| row_step < row) {
        return Err(row_place.error(Fault::BadEntry {
            entry: "row_step",
            found: row_step.to_string(),
            expected: "at least width times point_step",
        }));
    }
    let columns = found
        .iter()
        .map(|field| fields[*field].column(point_step))
        .collect::<Result<Vec<_>, _>>()?;
    if let Some(index) = first_within_another(&columns) {
        let Field { place, offset, .. } = fields[found[index]];
        return Err(place.error(Fault::BadEntry {
            entry: "the offset of a field",
            found: offset.to_string(),
            expected: "a place that no other coordinate or covariance has",
        }));
    }
    Ok(Header {
        stamp_ns,
        frame_id,
        height,
        width,
        size_place,
        columns,
        order,
        point_step,
        row_step,
    })
}

/// The first column some of whose bytes are also those of one before it: no writer means that.
fn first_within_another(columns: &[Column]) -> Option<usize> {
    let end = |column: &Column| column.offset + column.scalar.size();
    let overlap = |p: &Column, q: &Column| p.offset < end(q) && q.offset < end(p);
    (1..columns.len()).find(|&k| columns[..k].iter().any(|before| overlap(before, &columns[k])))
}

fn fields<'a>(cursor: &mut Cursor<'a>) -> Result<Vec<Field<'a>>, FormatError> {
    let count = cursor.u32("fields")?;
    // Not as many as promised at once: each has to be backed by bytes.
    let mut fields = Vec::new();
    for _ in 0..count {
        let place = cursor.place_of_u32();
        fields.push(Field {
            place,
            name: cursor.text("the name of a field")?,
            offset: cursor.u32("the offset of a field")?,
            datatype: cursor.u8("the datatype of a field")?,
            count: cursor.u32("the count of a field")?,
        });
    }
    Ok(fields)
}

impl Field<'_> {
    fn column(&self, point_step: usize) -> Result<Column, FormatError> {
        let bad = |entry, found: u32, expected| {
            self.place.error(Fault::BadEntry { entry, found: found.to_string(), expected })
        };
        let scalar = match self.datatype {
            1 => Scalar::I8,
            2 => Scalar::U8,
            3 => Scalar::I16,
            4 => Scalar::U16,
            5 => Scalar::I32,
            6 => Scalar::U32,
            7 => Scalar::F32,
            8 => Scalar::F64,
            other => {
                let expected = "1 to 8, INT8 to FLOAT64";
                return Err(bad("the datatype of a field", other.into(), expected));
            }
        };
        // Old drivers write 0 for a single value, and the Point Cloud Library reads it as one.
        if self.count > 1 {
            let expected = "1 for coordinates and covariances";
            return Err(bad("the count of a field", self.count, expected));
        }
        let offset = self.offset as usize;
        if offset.saturating_add(scalar.size()) > point_step {
            let expected = "a place within point_step";
            return Err(bad("the offset of a field", self.offset, expected));
        }
        Ok(Column { offset, scalar })
    }
}
