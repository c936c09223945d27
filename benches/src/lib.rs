//! Criterion benchmarks; not published.
