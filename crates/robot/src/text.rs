//! The text of a description.

use std::io;
use std::path::Path;

use cloudtouch_io::{ReadError, read_bytes};

use crate::error::RobotFault;

/// What a file of at most `limit` bytes says.
pub(crate) fn read(path: &Path, limit: u64) -> Result<String, RobotFault> {
    // The file is named by who asks.
    let bytes = read_bytes(path, limit).map_err(|error| match error {
        ReadError::Io { cause, .. } => RobotFault::File { reason: cause },
        ReadError::TooLarge { limit, .. } => RobotFault::TooLarge { limit },
        other => RobotFault::File { reason: io::Error::other(other) },
    })?;
    String::from_utf8(bytes)
        .map_err(|error| RobotFault::Encoding { byte: error.utf8_error().valid_up_to() })
}
