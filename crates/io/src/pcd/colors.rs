//! The colours of a PCD file: packed in a field of four bytes, which calls itself a float at times.

use super::header::{self, Data};
use super::parse::parse_columns;
use crate::{fault::FormatError, limits::ReadLimits, scalar::Scalar, text::Lines};

/// Red, green and blue of every row; `None` for a file without `rgb` or `rgba`.
///
/// # Errors
/// As [`parse`](super::parse()).
pub fn colors_within(
    bytes: &[u8],
    limits: &ReadLimits,
) -> Result<Option<Vec<[u8; 3]>>, FormatError> {
    let mut lines = Lines::new(bytes);
    let mut header = header::read(&mut lines)?;
    let is_color = |name: &str| ["rgb", "rgba"].iter().any(|c| name.eq_ignore_ascii_case(c));
    let place = header
        .fields
        .iter()
        .position(|field| is_color(&field.name) && field.scalar.size() == 4 && field.count == 1);
    let Some(place) = place else { return Ok(None) };
    let is_float = header.fields[place].scalar.is_float();
    if is_float && header.data != Data::Ascii {
        // As a number it may be one that is none, whose bits do not survive.
        header.fields[place].scalar = Scalar::U32;
    }
    let packed = parse_columns(&header, &[place; 3], lines, limits)?;
    let unpack = |value: f64| {
        let is_text = header.data == Data::Ascii && is_float;
        let bits = if is_text { (value as f32).to_bits() } else { value as i64 as u32 };
        let [_, red, green, blue] = bits.to_be_bytes();
        [red, green, blue]
    };
    Ok(Some(packed.points.iter().map(|row| unpack(row.x)).collect()))
}
