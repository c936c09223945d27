//! Log odds as a surface over two numbers: values at knots, straight lines between them, fitted by
//! penalised maximum likelihood (Newton's method) and monotone.

use std::array;

use cloudtouch::between_knots;
use nalgebra::{DMatrix, DVector};

/// Weighs how much neighbouring slopes may differ.
const SMOOTHNESS: f64 = 2.0;
/// Weighs slopes against the evidence: as good as forbidden.
const MONOTONE: f64 = 1e4;
/// Draws slopes to those of the prior where hardly a sample is.
const WEAK: f64 = 0.1;
/// Keeps values finite that no sample is near.
const RIDGE: f64 = 1e-3;
/// Holds the rows that are given.
const PINNED: f64 = 1e8;
/// Newton's method is done long before.
const MOST_STEPS: usize = 100;

/// One of the two numbers; more of it makes the event more probable.
#[derive(Debug, Clone, Copy)]
pub struct Axis<const N: usize> {
    /// Where the surface has values, ascending.
    pub knots: [f64; N],
    /// By how much a unit of it changes log odds where hardly a sample is.
    pub usual: f64,
}

/// What the surface is fitted to.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// The two numbers.
    pub at: [f64; 2],
    /// Whether the event came.
    pub came: bool,
    /// As how many samples it counts.
    pub weight: f64,
}

/// Fits values at the knots, by rows. The first and the last row are the knots themselves where
/// `pins_border`.
///
/// # Panics
/// When a knot is not finite: then nothing can be solved.
pub fn fit_surface<const N: usize, const M: usize>(
    samples: &[Sample],
    rows: Axis<N>,
    columns: Axis<M>,
    pins_border: bool,
) -> [[f64; M]; N] {
    let shares: Vec<([(usize, f64); 4], &Sample)> =
        samples.iter().map(|sample| (shares(&rows, &columns, sample.at), sample)).collect();
    let differences = differences(&rows, &columns);
    let pins: &[usize] = if pins_border { &[0, N - 1] } else { &[] };
    let mut values = DVector::zeros(N * M);
    for _ in 0..MOST_STEPS {
        let mut hessian = DMatrix::from_diagonal_element(N * M, N * M, RIDGE);
        let mut gradient = RIDGE * &values;
        let mut add = |terms: &[(usize, f64)], slope: f64, curvature: f64| {
            for &(i, w) in terms {
                gradient[i] += w * slope;
                for &(j, v) in terms {
                    hessian[(i, j)] += w * v * curvature;
                }
            }
        };
        for (at, Sample { came, weight, .. }) in &shares {
            let probability = 1.0 / (1.0 + (-value(at, &values)).exp());
            let error = probability - f64::from(u8::from(*came));
            add(at, weight * error, weight * (probability * (1.0 - probability)).max(1e-9));
        }
        for (terms, usual) in &differences {
            let found = value(terms, &values);
            let (penalty, excess) = match usual {
                None => (SMOOTHNESS, found),
                Some(_) if found < 0.0 => (MONOTONE, found),
                Some(usual) => (WEAK, found - usual),
            };
            add(terms, penalty * excess, penalty);
        }
        for &row in pins {
            for k in row * M..(row + 1) * M {
                add(&[(k, 1.0)], PINNED * (values[k] - rows.knots[row]), PINNED);
            }
        }
        let step = hessian.cholesky().expect("a positive definite matrix").solve(&gradient);
        // Full steps overshoot where everything is certain.
        let scale = (3.0 / step.amax().max(f64::MIN_POSITIVE)).min(1.0);
        values -= scale * &step;
        if step.amax() < 1e-8 {
            break;
        }
    }
    let mut table = array::from_fn(|i| array::from_fn(|j| values[i * M + j]));
    round(&mut table);
    if pins_border {
        let [least, most] = [rows.knots[0], rows.knots[N - 1]];
        table.as_flattened_mut().iter_mut().for_each(|value| *value = value.clamp(least, most));
        table[0].fill(least);
        table[N - 1].fill(most);
    }
    table
}

/// Which values a place between the knots is made from, and how much of each.
fn shares<const N: usize, const M: usize>(
    rows: &Axis<N>,
    columns: &Axis<M>,
    [x, y]: [f64; 2],
) -> [(usize, f64); 4] {
    let ((i, s), (j, t)) = (between_knots(&rows.knots, x), between_knots(&columns.knots, y));
    [
        (i * M + j, (1.0 - s) * (1.0 - t)),
        (i * M + j + 1, (1.0 - s) * t),
        ((i + 1) * M + j, s * (1.0 - t)),
        ((i + 1) * M + j + 1, s * t),
    ]
}

type Terms = Vec<(usize, f64)>;

fn value(terms: &[(usize, f64)], values: &DVector<f64>) -> f64 {
    terms.iter().map(|&(k, w)| w * values[k]).sum()
}

/// Differences between neighbouring values with what they usually are, and without that between
/// neighbouring slopes, scaled by the distances of the knots.
fn differences<const N: usize, const M: usize>(
    rows: &Axis<N>,
    columns: &Axis<M>,
) -> Vec<(Terms, Option<f64>)> {
    let mut all = Vec::new();
    let mut along = |knots: &[f64], usual: f64, k: usize, index: &dyn Fn(usize) -> usize| {
        let width = |k: usize| knots[k + 1] - knots[k];
        if k + 1 < knots.len() {
            let rise = vec![(index(k + 1), 1.0), (index(k), -1.0)];
            all.push((rise, Some(usual * width(k))));
        }
        if k > 0 && k + 1 < knots.len() {
            let [before, after] = [width(k - 1), width(k)];
            let mean = 0.5 * (before + after);
            let (low, high) = (mean / before, mean / after);
            let bend = vec![(index(k - 1), low), (index(k), -low - high), (index(k + 1), high)];
            all.push((bend, None));
        }
    };
    for i in 0..N {
        for j in 0..M {
            along(&rows.knots, rows.usual, i, &|k| k * M + j);
            along(&columns.knots, columns.usual, j, &|k| i * M + k);
        }
    }
    all
}

/// To thousandths, and exactly monotone: what is left of slopes against the evidence is levelled.
fn round<const M: usize>(table: &mut [[f64; M]]) {
    for i in 0..table.len() {
        for j in 0..M {
            let above = if i > 0 { table[i - 1][j] } else { f64::NEG_INFINITY };
            let beside = if j > 0 { table[i][j - 1] } else { f64::NEG_INFINITY };
            table[i][j] = ((1e3 * table[i][j]).round() / 1e3).max(above).max(beside);
        }
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    const ROWS: Axis<4> = Axis { knots: [0.0, 1.0, 2.0, 4.0], usual: 1.0 };
    const COLUMNS: Axis<3> = Axis { knots: [0.0, 1.0, 3.0], usual: 1.0 };

    fn drawn(log_odds: impl Fn(f64, f64) -> f64) -> Vec<Sample> {
        let unit = |i, k| seed::unit(seed::derive(7, i, k));
        let sample = |i| {
            let (x, y) = (4.0 * unit(i, 0), 3.0 * unit(i, 1));
            let came = unit(i, 2) < 1.0 / (1.0 + (-log_odds(x, y)).exp());
            Sample { at: [x, y], came, weight: 1.0 }
        };
        (0..20_000).map(sample).collect()
    }

    #[test]
    fn a_plane_is_found_again() {
        let plane = |x: f64, y: f64| 0.5 + 0.8 * x + 1.1 * y;
        let table = fit_surface(&drawn(plane), ROWS, COLUMNS, false);
        for (row, x) in table.iter().zip(ROWS.knots) {
            for (&found, y) in row.iter().zip(COLUMNS.knots) {
                assert!((found - plane(x, y)).abs() < 0.4, "{x} {y}: {found}");
            }
        }
    }

    #[test]
    fn a_weight_is_so_many_samples() {
        let samples = drawn(|x, y| x + y - 3.0);
        let heavy = samples.iter().map(|sample| Sample { weight: 3.0, ..*sample });
        let heavy = fit_surface(&heavy.collect::<Vec<_>>(), ROWS, COLUMNS, false);
        assert_eq!(heavy, fit_surface(&samples.repeat(3), ROWS, COLUMNS, false));
    }

    #[test]
    fn what_goes_against_the_evidence_is_levelled_and_borders_are_kept() {
        let table = fit_surface(&drawn(|x, y| x - y), ROWS, COLUMNS, false);
        for (row, next) in table.iter().zip(&table[1..]) {
            assert!(row.is_sorted() && row.iter().zip(next).all(|(a, b)| a <= b), "{table:?}");
        }
        let pinned = fit_surface(&drawn(|x, y| x + y), ROWS, COLUMNS, true);
        assert_eq!((pinned[0][2], pinned[3][0]), (0.0, 4.0));
    }
}
