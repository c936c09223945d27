//! Units of length that files are written in.

use std::{fmt, str::FromStr};

/// The unit of the coordinates in a file; STL, OBJ and PLY do not say which one they use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
#[non_exhaustive]
pub enum LengthUnit {
    /// Metres, `m`.
    #[default]
    Metres,
    /// Centimetres, `cm`.
    Centimetres,
    /// Millimetres, `mm`.
    Millimetres,
    /// Inches of 25.4 mm, `in`.
    Inches,
}

/// A unit of length with a name that is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{found:?} is not a unit of length: use m, cm, mm or in")]
pub struct UnknownUnit {
    /// The name.
    pub found: String,
}

impl LengthUnit {
    /// How many metres it has.
    pub fn in_metres(self) -> f64 {
        match self {
            Self::Metres => 1.0,
            Self::Centimetres => 0.01,
            Self::Millimetres => 0.001,
            Self::Inches => 0.0254,
        }
    }
}

impl FromStr for LengthUnit {
    type Err = UnknownUnit;

    fn from_str(name: &str) -> Result<Self, UnknownUnit> {
        match name {
            "m" => Ok(Self::Metres),
            "cm" => Ok(Self::Centimetres),
            "mm" => Ok(Self::Millimetres),
            "in" => Ok(Self::Inches),
            _ => Err(UnknownUnit { found: name.to_owned() }),
        }
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Metres => "m",
            Self::Centimetres => "cm",
            Self::Millimetres => "mm",
            Self::Inches => "in",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip_and_others_are_refused() {
        for (name, metres) in [("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("in", 0.0254)] {
            let unit: LengthUnit = name.parse().unwrap();
            assert_eq!((unit.to_string().as_str(), unit.in_metres()), (name, metres));
        }
        let error = "furlong".parse::<LengthUnit>().unwrap_err();
        assert_eq!(error.to_string(), "\"furlong\" is not a unit of length: use m, cm, mm or in");
    }
}
