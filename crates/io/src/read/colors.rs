//! Reads the colours of clouds.

use std::path::Path;

use super::file::{extension, read};
use crate::{error::ReadError, limits::ReadLimits, pcd, ply};

/// Red, green and blue of every row of a cloud; `None` where the file has none, or is a pipe, whose contents went
/// to whoever read the points.
///
/// # Errors
/// As [`read_cloud`](super::read_cloud).
pub fn read_colors_within(
    path: impl AsRef<Path>,
    limits: &ReadLimits,
) -> Result<Option<Vec<[u8; 3]>>, ReadError> {
    let path = path.as_ref();
    match extension(path).as_str() {
        _ if path.metadata().is_ok_and(|about| !about.is_file()) => Ok(None),
        "pcd" => read(path, pcd::colors_within, limits),
        "ply" => read(path, ply::colors_within, limits),
        _ => Ok(None),
    }
}
