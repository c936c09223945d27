//! The bytes of a recording, which as a whole may be larger than memory.

use std::{
    fs::File,
    io::{self, Read as _, Seek as _, SeekFrom},
    path::{Path, PathBuf},
};

use crate::recording_fault::RecordingFault;
use crate::{error::ReadError, limits::ReadLimits};

/// Opcode and length of a record.
pub(super) const RECORD_HEAD: usize = 1 + 8;

/// An open file.
#[derive(Debug)]
pub(super) struct Source {
    path: PathBuf,
    file: File,
    pub(super) size: u64,
    pub(super) limits: ReadLimits,
}

impl Source {
    pub(super) fn open(path: &Path, limits: &ReadLimits) -> Result<Self, ReadError> {
        let failed = |cause| ReadError::Io { path: path.to_owned(), cause };
        let mut file = File::open(path).map_err(failed)?;
        // A pipe cannot be searched, and says so here.
        let size = file.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(Self { path: path.to_owned(), file, size, limits: *limits })
    }

    pub(super) fn error(&self, fault: RecordingFault) -> ReadError {
        ReadError::recording(&self.path, fault)
    }

    pub(super) fn damaged(&self, byte: u64, reason: impl Into<String>) -> ReadError {
        self.error(RecordingFault::Damaged { byte, reason: reason.into() })
    }

    /// Whether a part of so many bytes, which begins at `byte`, may be held in memory.
    pub(super) fn check_size(
        &self,
        byte: u64,
        found: u64,
        what: &'static str,
    ) -> Result<usize, ReadError> {
        let limit = self.limits.bytes;
        match usize::try_from(found) {
            Ok(length) if found <= limit => Ok(length),
            _ => Err(self.error(RecordingFault::TooLarge { byte, what, found, limit })),
        }
    }

    /// The bytes from `byte` on, of a part that is named in errors.
    pub(super) fn bytes(
        &mut self,
        byte: u64,
        length: u64,
        what: &'static str,
    ) -> Result<Vec<u8>, ReadError> {
        if byte.checked_add(length).is_none_or(|end| end > self.size) {
            return Err(self.damaged(byte, format!("{what} goes beyond the end of the file")));
        }
        let length = self.check_size(byte, length, what)?;
        let mut bytes = Vec::new();
        let read = match bytes.try_reserve_exact(length) {
            Ok(()) => {
                bytes.resize(length, 0);
                self.file.seek(SeekFrom::Start(byte)).and_then(|_| self.file.read_exact(&mut bytes))
            }
            Err(_) => Err(io::ErrorKind::OutOfMemory.into()),
        };
        read.map_err(|cause| ReadError::Io { path: self.path.clone(), cause })?;
        Ok(bytes)
    }
}
