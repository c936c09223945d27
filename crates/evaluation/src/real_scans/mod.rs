//! Stand-in until the real scans are here.

pub(crate) mod cases;
