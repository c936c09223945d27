//! What several tasks share: tables, statistics, drawing, and where a run took place.

pub(crate) mod draw;
pub(crate) mod files;
pub(crate) mod machine;
pub(crate) mod statistics;
pub(crate) mod table;
