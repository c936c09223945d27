//! Seeded data for the benchmarks in `benches/`; not published.

pub mod leaf;
pub mod piano_room;
pub mod sphere;
