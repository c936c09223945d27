//! Stated standard deviations are those of the errors, on faces and near edges.

use crate::common::sigma::{HONEST, Row, Spread, rows};

/// Where they are too large: near edges of boards with 2 mm of noise sampled more coarsely than they are
/// thick, where fits to both faces differ. At least this much.
const MISSED: [(&str, f64, f64, &str, f64, f64); 2] = [
    ("board, 30 mm", 0.035, 0.002, "edges", 0.7, 1.25),
    ("board, 15 mm", 0.035, 0.002, "edges", 0.72, 1.25),
];

#[test]
fn errors_are_as_large_as_stated() {
    let mut wrong = Vec::new();
    for row in rows() {
        for (place, spread) in [("faces", row.faces), ("edges", row.edges)] {
            let Some(Spread { standardised, .. }) = spread else { continue };
            let (low, high) = bounds(&row, place);
            if !(low..=high).contains(&standardised) {
                wrong.push(format!("{row:?} {place}: {standardised:.3} not in {low}..{high}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn bounds(row: &Row, place: &str) -> (f64, f64) {
    let here = |missed: &&(&str, f64, f64, &str, f64, f64)| {
        (missed.0, missed.1, missed.2, missed.3) == (row.shape, row.spacing, row.noise, place)
    };
    MISSED.iter().find(here).map_or(HONEST, |missed| (missed.4, missed.5))
}
