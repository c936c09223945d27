//! The numbers of a 16-bit greyscale PNG.

use std::io::{Cursor, ErrorKind};

use png::{BitDepth, ColorType, DecodeOptions, Decoder, DecodingError};

use crate::{
    fault::{Fault, FormatError, Place},
    limits::ReadLimits,
    text::{excerpt, is_padding},
};

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Where the header has width and height, and then what a pixel is.
const SIZE: Place = Place::Byte(16);
const PIXEL: Place = Place::Byte(24);
/// Deflate makes of two bits at most 258 bytes.
const LARGEST_EXPANSION: usize = 1032;
const BYTES_PER_PIXEL: usize = 2;

/// An image of 16-bit numbers.
pub(super) struct Image {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Row by row, two bytes each, the high one first.
    bytes: Vec<u8>,
}

impl Image {
    /// The pixels, row by row.
    pub(super) fn pixels(&self) -> impl Iterator<Item = u16> {
        self.bytes.chunks_exact(BYTES_PER_PIXEL).map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
    }
}

/// Unpacks a PNG, once it is known that the file backs what its header promises.
pub(super) fn decode(bytes: &[u8], limits: &ReadLimits) -> Result<Image, FormatError> {
    if bytes.is_empty() {
        return Err(Place::Whole.error(Fault::Empty));
    }
    if !bytes.starts_with(SIGNATURE) {
        let found = excerpt(&bytes[..bytes.len().min(SIGNATURE.len())]);
        return Err(Place::Byte(0).error(Fault::WrongMagic { expected: "a PNG", found }));
    }
    // Borrowed, so that it still tells how far the decoder came when that gave up.
    let mut cursor = Cursor::new(bytes);
    let image = unpack(&mut cursor, limits).map_err(|problem| match problem {
        Problem::Ours(error) => error,
        Problem::Decoder(error) => told(&error, cursor.position(), bytes.len()),
    })?;
    let end = usize::try_from(cursor.position()).unwrap_or(bytes.len()).min(bytes.len());
    if !is_padding(&bytes[end..]) {
        return Err(Place::Byte(end).error(Fault::Leftover { promised: image.height }));
    }
    Ok(image)
}

enum Problem {
    Ours(FormatError),
    Decoder(DecodingError),
}

impl From<FormatError> for Problem {
    fn from(error: FormatError) -> Self {
        Self::Ours(error)
    }
}

impl From<DecodingError> for Problem {
    fn from(error: DecodingError) -> Self {
        Self::Decoder(error)
    }
}

fn unpack(cursor: &mut Cursor<&[u8]>, limits: &ReadLimits) -> Result<Image, Problem> {
    let available = cursor.get_ref().len();
    let mut options = DecodeOptions::default();
    options.set_ignore_adler32(false);
    options.set_ignore_text_chunk(true);
    options.set_ignore_iccp_chunk(true);
    let mut decoder = Decoder::new_with_options(cursor, options);

    let header = decoder.read_header_info()?;
    let (width, height) = (header.width as usize, header.height as usize);
    check_kind(header.color_type, header.bit_depth)?;
    if width < 2 || height < 2 {
        return Err(SIZE.error(Fault::NoRowsAndColumns { width, height }).into());
    }
    let pixels = width.saturating_mul(height);
    limits.check_points(pixels, SIZE)?;
    let size = pixels.saturating_mul(BYTES_PER_PIXEL);
    limits.check_unpacked(size, SIZE)?;
    let needed = size.div_ceil(LARGEST_EXPANSION);
    if needed > available {
        return Err(SIZE.error(Fault::TooShort { promised: height, needed, available }).into());
    }

    let mut reader = decoder.read_info()?;
    if reader.info().is_animated() {
        let found = "an animation".to_owned();
        return Err(PIXEL.error(Fault::NoDepthImage { found }).into());
    }
    let mut bytes = vec![0; size];
    reader.next_frame(&mut bytes)?;
    // A file that ends before its end mark was not written completely.
    reader.finish()?;
    Ok(Image { width, height, bytes })
}

fn check_kind(color: ColorType, depth: BitDepth) -> Result<(), FormatError> {
    let bits = depth as u8;
    let kind = match color {
        ColorType::Grayscale if depth == BitDepth::Sixteen => return Ok(()),
        ColorType::Grayscale => "grey",
        ColorType::GrayscaleAlpha => "grey with transparency",
        ColorType::Indexed => "with a palette",
        ColorType::Rgb => "colour",
        ColorType::Rgba => "colour with transparency",
    };
    Err(PIXEL.error(Fault::NoDepthImage { found: format!("{bits}-bit {kind}") }))
}

/// What the decoder complained about after so many bytes.
fn told(error: &DecodingError, position: u64, length: usize) -> FormatError {
    let place = Place::Byte(usize::try_from(position).unwrap_or(length).min(length));
    place.error(match error {
        DecodingError::IoError(cause) if cause.kind() == ErrorKind::UnexpectedEof => {
            Fault::UnexpectedEnd { expected: "the rest of the image" }
        }
        other => {
            let message = other.to_string();
            Fault::DamagedImage { problem: message.trim_end_matches('.').to_owned() }
        }
    })
}
