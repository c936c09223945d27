//! Stated standard deviations are those of the errors, on faces and near edges.

use crate::common::sigma::{HONEST, Row, Spread, rows};

#[test]
fn errors_are_as_large_as_stated() {
    let mut wrong = Vec::new();
    for row in rows() {
        for (place, spread) in [("faces", row.faces), ("edges", row.edges)] {
            let Some(Spread { standardised, .. }) = spread else { continue };
            if !(HONEST.0..=HONEST.1).contains(&standardised) {
                let Row { shape, spacing, noise, .. } = row;
                let kind = format!("{place} of {shape}, {spacing} m apart, {noise} m of noise");
                wrong.push(format!("{kind}: {standardised:.3} not in {HONEST:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
