//! Numbers as error messages spell them.

use crate::vectors::Point3;

/// A number, plainly where that is short and with an exponent where it would take hundreds of
/// digits: `0.25`, `5012345`, `1e300`, `NaN`.
pub fn number(value: f64) -> String {
    let is_ordinary = (1e-4..1e9).contains(&value.abs());
    if value == 0.0 || is_ordinary || !value.is_finite() {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// The same in four digits, of what is known no better: `2298`, `0.001234`.
pub fn rounded(value: f64) -> String {
    number(format!("{value:.3e}").parse().unwrap_or(value))
}

/// A position, m: `(0.5, -1e300, NaN)`.
pub fn position(point: &Point3) -> String {
    format!("({}, {}, {})", number(point.x), number(point.y), number(point.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_numbers_are_spelled_plainly_and_others_in_few_digits() {
        for (value, spelled) in [
            (0.0, "0"),
            (-0.25, "-0.25"),
            (1e-4, "0.0001"),
            (9.9e-5, "9.9e-5"),
            (5_012_345.5, "5012345.5"),
            (1e9, "1e9"),
            (-1e300, "-1e300"),
            (5e-324, "5e-324"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(number(value), spelled);
        }
        assert_eq!(position(&Point3::new(0.5, -1e300, f64::NAN)), "(0.5, -1e300, NaN)");
    }

    #[test]
    fn what_is_computed_has_four_digits() {
        for (value, spelled) in [
            (2_298.424_103_337_972_6, "2298"),
            (1.0 / 3.0, "0.3333"),
            (-0.000_123_45, "-0.0001234"),
            (0.5, "0.5"),
            (123_456.0, "123500"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(rounded(value), spelled);
        }
    }

    #[test]
    fn what_is_spelled_reads_as_the_same_number() {
        for exponent in -300..300 {
            let value = 1.234_567_890_123_456_7 * 10_f64.powi(exponent);
            assert_eq!(number(value).parse::<f64>(), Ok(value));
            assert!(number(value).len() < 25, "{}", number(value));
        }
    }
}
