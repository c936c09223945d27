//! How large files may be.

use clap::Args;
use cloudtouch_io::ReadLimits;

use crate::args::parse::parse_whole;

/// How large a file may be.
#[derive(Debug, Args)]
pub(crate) struct LimitArguments {
    /// Read at most this many points of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().points,
          value_parser = parse_whole::<usize>, allow_negative_numbers = true,
          help_heading = "Limits")]
    max_points: usize,
    /// Read at most this many triangles of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().triangles,
          value_parser = parse_whole::<usize>, allow_negative_numbers = true,
          help_heading = "Limits")]
    max_triangles: usize,
    /// Read at most this many bytes of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().bytes,
          value_parser = parse_whole::<u64>, allow_negative_numbers = true,
          help_heading = "Limits")]
    max_bytes: u64,
}

impl LimitArguments {
    pub(crate) fn read_limits(&self) -> ReadLimits {
        ReadLimits { bytes: self.max_bytes, points: self.max_points, triangles: self.max_triangles }
    }
}
