//! Where log odds have their values, and the tables of these.

/// Deviations beyond this say no more than these, and no fewer below: what is looked for.
pub(crate) const MOST_DEVIATIONS: f64 = 6.0;
/// Keeps the logarithm of no misclassified point finite.
pub(super) const MISCLASSIFIED_FLOOR: f64 = 0.02;

/// For which noise over spacing of two bodies there is a surface over geometry. The last two serve clouds much
/// denser than their noise, of whose many pieces the nearest is near by chance; the one before repeats that at 2.
pub const NOISE_KNOTS: [f64; 6] = [0.0, 0.5, 2.0, 3.0, 5.0, 12.0];
/// Where each of these has its values: deviations by rows, crossing by columns.
pub const DEVIATION_KNOTS: [f64; 13] =
    [-6.0, -4.0, -2.5, -1.2, 0.0, 0.4, 0.8, 1.2, 1.7, 2.3, 3.0, 4.0, MOST_DEVIATIONS];
/// See [`DEVIATION_KNOTS`].
pub const CROSSING_KNOTS: [f64; 9] = [0.0, 0.5, 1.2, 1.8, 2.4, 3.0, 3.6, 4.2, 5.0];
/// Knots of the noise for which the extent changes log odds; from the next on it changes nothing.
pub const EXTENT_NOISES: usize = 2;
/// Where what the extent makes of log odds has its values: log odds by the place of contact by rows,
/// −ln(1 + what [`sharp_extent`](super::sharp_extent) makes of the pieces about as near) by columns. At the first
/// and the last row nothing is changed.
pub const ODDS_KNOTS: [f64; 9] = [-5.0, -3.0, -1.8, -0.8, 0.2, 1.2, 2.2, 3.3, 4.6];
/// See [`ODDS_KNOTS`].
pub const EXTENT_KNOTS: [f64; 7] = [-6.0, -5.0, -4.0, -3.0, -2.2, -1.4, -0.7];
/// Where the revision has its values: log odds by geometry by rows, ln(misclassified + 0.02) by
/// columns. At the first and the last row nothing is revised.
pub const DOUBT_KNOTS: [f64; 7] = [-2.2, -1.5, -0.8, 0.0, 0.8, 1.5, 2.2];
/// See [`DOUBT_KNOTS`].
pub const MISCLASSIFIED_KNOTS: [f64; 9] = [-3.92, -3.2, -2.4, -1.6, -0.8, 0.0, 1.0, 2.2, 3.6];

/// Log odds at [`DEVIATION_KNOTS`] by rows and [`CROSSING_KNOTS`] by columns.
pub type OverGeometry = [[f64; CROSSING_KNOTS.len()]; DEVIATION_KNOTS.len()];
/// Log odds at [`ODDS_KNOTS`] by rows and [`EXTENT_KNOTS`] by columns.
pub type OverExtent = [[f64; EXTENT_KNOTS.len()]; ODDS_KNOTS.len()];
/// Log odds at [`DOUBT_KNOTS`] by rows and [`MISCLASSIFIED_KNOTS`] by columns.
pub type OverDoubt = [[f64; MISCLASSIFIED_KNOTS.len()]; DOUBT_KNOTS.len()];
