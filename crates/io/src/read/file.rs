//! What a file holds, as bytes, and what its name says of it.

use std::{
    fs::File,
    io::{self, Read as _},
    path::Path,
};

use crate::{error::ReadError, fault::FormatError, limits::ReadLimits, recording::ScanName};

/// Whether the extension of a file is one that is read, without a look at the file; the name of a
/// scan in a recording has to be well formed. Depth images count, which only [`read_depth_image`](super::read_depth_image) reads.
///
/// # Errors
/// When it is not.
pub fn check_extension(path: impl AsRef<Path>) -> Result<(), ReadError> {
    let path = path.as_ref();
    match (extension(path).as_str(), ScanName::of(path)) {
        (_, Some(Ok(name))) if !cfg!(feature = "mcap") => {
            Err(ReadError::NoRecordings { path: name.file })
        }
        (_, Some(name)) => name.map(|_| ()),
        ("pcd" | "xyz" | "txt" | "csv" | "stl" | "obj" | "ply" | "png", None) => Ok(()),
        _ => Err(unsupported(path, WITH_IMAGES)),
    }
}

/// What [`read_geometry`](super::read_geometry) reads.
pub(super) const EVERYTHING: &str = ".pcd, .ply, .xyz, .txt, .csv, .stl, .obj";
/// The same with what [`read_depth_image`](super::read_depth_image) reads.
const WITH_IMAGES: &str = ".pcd, .ply, .xyz, .txt, .csv, .png (depth images), .stl, .obj";

pub(super) type Parser<T> = fn(&[u8], &ReadLimits) -> Result<T, FormatError>;

pub(super) fn read<T>(
    path: &Path,
    parse: impl FnOnce(&[u8], &ReadLimits) -> Result<T, FormatError>,
    limits: &ReadLimits,
) -> Result<T, ReadError> {
    let bytes = read_bytes(path, limits.bytes)?;
    parse(&bytes, limits)
        .map_err(|problem| ReadError::Format { path: path.to_owned(), problem: Box::new(problem) })
}

/// The contents of a file of at most `limit` bytes.
///
/// The limit holds whatever the file system says of its size: a device or a pipe has none.
///
/// # Errors
/// When it cannot be opened or read, or has more bytes.
pub fn read_bytes(path: impl AsRef<Path>, limit: u64) -> Result<Vec<u8>, ReadError> {
    let path = path.as_ref();
    let failed = |cause| ReadError::Io { path: path.to_owned(), cause };
    let too_large = || ReadError::TooLarge { path: path.to_owned(), limit };
    let file = File::open(path).map_err(|cause| ReadError::of_opening(path, cause))?;
    let about = file.metadata().map_err(failed)?;
    if about.is_dir() {
        return Err(failed(is_folder()));
    }
    let size = about.len();
    if size > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    let expected = usize::try_from(size).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(expected).map_err(|_| failed(io::ErrorKind::OutOfMemory.into()))?;
    let read = file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    if read as u64 > limit { Err(too_large()) } else { Ok(bytes) }
}

pub(super) fn extension(path: &Path) -> String {
    // A topic may end as a file does.
    if ScanName::of(path).is_some() {
        return "mcap".to_owned();
    }
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// What is said of a folder in the place of a file.
fn is_folder() -> io::Error {
    io::Error::new(io::ErrorKind::IsADirectory, "it is a folder: give a file in it")
}

pub(super) fn unsupported(path: &Path, supported: &'static str) -> ReadError {
    if path.is_dir() {
        return ReadError::Io { path: path.to_owned(), cause: is_folder() };
    }
    ReadError::Extension { path: path.to_owned(), found: extension(path), supported }
}
