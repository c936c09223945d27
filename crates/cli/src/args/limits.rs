//! How large files may be.

use clap::Args;
use cloudtouch_io::ReadLimits;

/// How large a file may be.
#[derive(Debug, Args)]
pub(crate) struct LimitArguments {
    /// Read at most this many points of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().points,
          allow_negative_numbers = true, help_heading = "Limits")]
    max_points: usize,
    /// Read at most this many triangles of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().triangles,
          allow_negative_numbers = true, help_heading = "Limits")]
    max_triangles: usize,
    /// Read at most this many bytes of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().bytes,
          allow_negative_numbers = true, help_heading = "Limits")]
    max_bytes: u64,
}

impl LimitArguments {
    pub(crate) fn read_limits(&self) -> ReadLimits {
        ReadLimits { bytes: self.max_bytes, points: self.max_points, triangles: self.max_triangles }
    }
}
