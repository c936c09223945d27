//! How large a file may be: a header can promise anything, and memory ends before disks do.

use crate::fault::{Fault, FormatError, Place};

/// What is read at most; beyond it there is an error, before the memory is taken.
///
/// A body at the default limits takes about 3 GB, preparation for queries included. Larger scenes
/// are better thinned or split than read whole; whoever has the memory raises the limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadLimits {
    /// Bytes of a file, and of the points of a compressed one; 2 GiB.
    pub bytes: u64,
    /// Points of a cloud, missing ones included, or vertices of a mesh; 10 million. Those of an
    /// STL are not counted: it has three for each triangle.
    pub points: usize,
    /// Triangles of a mesh, after its polygons became triangles; 5 million.
    pub triangles: usize,
}

impl Default for ReadLimits {
    fn default() -> Self {
        Self { bytes: 2 << 30, points: 10_000_000, triangles: 5_000_000 }
    }
}

impl ReadLimits {
    /// Whether so many points may be read, which are promised or found at `place`.
    pub(crate) fn check_points(&self, found: usize, place: Place) -> Result<(), FormatError> {
        check("points", found, self.points, place)
    }

    /// Whether so many triangles may be read.
    pub(crate) fn check_triangles(&self, found: usize, place: Place) -> Result<(), FormatError> {
        check("triangles", found, self.triangles, place)
    }

    /// Whether the data may take so many bytes once it is unpacked.
    pub(crate) fn check_unpacked(&self, found: usize, place: Place) -> Result<(), FormatError> {
        let limit = usize::try_from(self.bytes).unwrap_or(usize::MAX);
        check("unpacked bytes", found, limit, place)
    }
}

fn check(what: &'static str, found: usize, limit: usize, place: Place) -> Result<(), FormatError> {
    if found <= limit { Ok(()) } else { Err(place.error(Fault::TooMany { what, found, limit })) }
}
