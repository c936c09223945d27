//! What a variance may be.

/// Zero for a negative number and for −0, of which a root divides to the other infinity; NaN stays NaN, so that it
/// cannot pass for an exact point.
pub(super) fn not_negative(value: f64) -> f64 {
    if value <= 0.0 { 0.0 } else { value }
}
