//! Log odds as a surface over a few numbers: values at knots, straight lines between them, fitted by
//! penalised maximum likelihood (Newton's method) and monotone in what is evidence.

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

/// One of the numbers.
#[derive(Debug, Clone, Copy)]
pub struct Axis<'a> {
    /// Where the surface has values, ascending.
    pub knots: &'a [f64],
    /// Of evidence, more of which makes the event more probable, by how much a unit of it changes log odds
    /// where hardly a sample is; `None` of what is no evidence itself, and only says what the rest is worth:
    /// log odds are drawn to the same along it.
    pub usual: Option<f64>,
}

/// What the surface is fitted to.
#[derive(Debug, Clone, Copy)]
pub struct Sample<const D: usize> {
    /// The numbers.
    pub at: [f64; D],
    /// Whether the event came.
    pub came: bool,
    /// As how many samples it counts.
    pub weight: f64,
}

/// Pins of a surface whose first and last values along its first axis, each of so many, are its knots themselves.
pub fn border(axis: &[f64], row: usize) -> Vec<(usize, f64)> {
    let last = axis.len() - 1;
    [0, last]
        .into_iter()
        .flat_map(|k| (k * row..(k + 1) * row).map(move |i| (i, axis[k])))
        .collect()
}

/// Fits values at the knots, the last axis running fastest. Those that are pinned, by index, are what they
/// are, and the others between the least and the most of them.
///
/// # Panics
/// When a knot is not finite: then nothing can be solved.
pub fn fit_surface<const D: usize>(
    samples: &[Sample<D>],
    axes: [Axis<'_>; D],
    pins: &[(usize, f64)],
) -> Vec<f64> {
    let shares: Vec<(Terms, &Sample<D>)> =
        samples.iter().map(|sample| (shares(&axes, sample.at), sample)).collect();
    let penalties = penalties(&axes);
    let count: usize = axes.iter().map(|axis| axis.knots.len()).product();
    let mut values = DVector::zeros(count);
    for _ in 0..MOST_STEPS {
        let mut hessian = DMatrix::from_diagonal_element(count, count, RIDGE);
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
        for Penalty { terms, weight, usual } in &penalties {
            let found = value(terms, &values);
            let (penalty, excess) = match usual {
                Some(_) if found < 0.0 => (MONOTONE, found),
                Some(usual) => (*weight, found - usual),
                None => (*weight, found),
            };
            add(terms, penalty * excess, penalty);
        }
        for &(k, pinned) in pins {
            add(&[(k, 1.0)], PINNED * (values[k] - pinned), PINNED);
        }
        let step = hessian.cholesky().expect("a positive definite matrix").solve(&gradient);
        // Full steps overshoot where everything is certain.
        let scale = (3.0 / step.amax().max(f64::MIN_POSITIVE)).min(1.0);
        values -= scale * &step;
        if step.amax() < 1e-8 {
            break;
        }
    }
    let mut table: Vec<f64> = values.iter().copied().collect();
    round(&mut table, &axes);
    if !pins.is_empty() {
        let pinned = || pins.iter().map(|&(_, value)| value);
        let least = pinned().fold(f64::INFINITY, f64::min);
        let most = pinned().fold(f64::NEG_INFINITY, f64::max);
        table.iter_mut().for_each(|value| *value = value.clamp(least, most));
    }
    for &(k, pinned) in pins {
        table[k] = pinned;
    }
    table
}

type Terms = Vec<(usize, f64)>;

/// Which values a place between the knots is made from, and how much of each.
fn shares<const D: usize>(axes: &[Axis<'_>; D], at: [f64; D]) -> Terms {
    let mut terms = vec![(0, 1.0)];
    for (axis, x) in axes.iter().zip(at) {
        let (knot, part) = between_knots(axis.knots, x);
        let of = |&(index, weight): &(usize, f64)| {
            let first = index * axis.knots.len() + knot;
            [(first, (1.0 - part) * weight), (first + 1, part * weight)]
        };
        terms = terms.iter().flat_map(of).collect();
    }
    terms
}

fn value(terms: &[(usize, f64)], values: &DVector<f64>) -> f64 {
    terms.iter().map(|&(k, w)| w * values[k]).sum()
}

/// A difference of values that is to be small, or what it usually is where that is given.
struct Penalty {
    terms: Terms,
    weight: f64,
    usual: Option<f64>,
}

/// Of differences between neighbouring values, and between neighbouring slopes, scaled by the distances of
/// the knots. Surfaces beside one another along an axis that is no evidence share what holds one of them.
fn penalties<const D: usize>(axes: &[Axis<'_>; D]) -> Vec<Penalty> {
    let beside: usize =
        axes.iter().filter(|axis| axis.usual.is_none()).map(|axis| axis.knots.len()).product();
    let count: usize = axes.iter().map(|axis| axis.knots.len()).product();
    let mut all = Vec::new();
    let mut stride = count;
    for Axis { knots, usual } in axes {
        stride /= knots.len();
        let smoothness = if usual.is_some() { SMOOTHNESS / beside as f64 } else { SMOOTHNESS };
        let width = |k: usize| knots[k + 1] - knots[k];
        for index in 0..count {
            let k = index / stride % knots.len();
            if k + 1 < knots.len() {
                let terms = vec![(index + stride, 1.0), (index, -1.0)];
                all.push(Penalty {
                    terms,
                    weight: WEAK,
                    usual: usual.map(|usual| usual * width(k)),
                });
            }
            if k > 0 && k + 1 < knots.len() {
                let [before, after] = [width(k - 1), width(k)];
                let mean = 0.5 * (before + after);
                let (low, high) = (mean / before, mean / after);
                let terms =
                    vec![(index - stride, low), (index, -low - high), (index + stride, high)];
                all.push(Penalty { terms, weight: smoothness, usual: None });
            }
        }
    }
    all
}

/// To thousandths, and exactly monotone: what is left of slopes against the evidence is levelled.
fn round<const D: usize>(table: &mut [f64], axes: &[Axis<'_>; D]) {
    for index in 0..table.len() {
        let mut least = f64::NEG_INFINITY;
        let mut stride = table.len();
        for Axis { knots, usual } in axes {
            stride /= knots.len();
            if usual.is_some() && !(index / stride).is_multiple_of(knots.len()) {
                least = least.max(table[index - stride]);
            }
        }
        table[index] = ((1e3 * table[index]).round() / 1e3).max(least);
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    const ROWS: Axis<'_> = Axis { knots: &[0.0, 1.0, 2.0, 4.0], usual: Some(1.0) };
    const COLUMNS: Axis<'_> = Axis { knots: &[0.0, 1.0, 3.0], usual: Some(1.0) };

    fn unit(i: u64, k: u64) -> f64 {
        seed::unit(seed::derive(7, i, k))
    }

    fn drawn(log_odds: impl Fn(f64, f64) -> f64) -> Vec<Sample<2>> {
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
        let table = fit_surface(&drawn(plane), [ROWS, COLUMNS], &[]);
        for (row, x) in table.chunks(3).zip(ROWS.knots) {
            for (&found, y) in row.iter().zip(COLUMNS.knots) {
                assert!((found - plane(*x, *y)).abs() < 0.4, "{x} {y}: {found}");
            }
        }
    }

    #[test]
    fn what_evidence_is_worth_may_rise_and_fall_beside_it() {
        let worth = |noise: f64| 0.3 + 2.0 * (noise - 1.0).abs();
        let sample = |i| {
            let (noise, x) = (2.0 * unit(i, 0), 4.0 * unit(i, 1));
            let came = unit(i, 2) < 1.0 / (1.0 + (2.0 - worth(noise) * x).exp());
            Sample { at: [noise, x], came, weight: 1.0 }
        };
        let samples: Vec<_> = (0..20_000).map(sample).collect();
        let noise = Axis { knots: &[0.0, 1.0, 2.0], usual: None };
        let table = fit_surface(&samples, [noise, ROWS], &[]);
        for (row, at) in table.chunks(4).zip(noise.knots) {
            assert!(row.is_sorted(), "{row:?}");
            let slope = row[1] - row[0];
            assert!((slope - worth(*at)).abs() < 0.4, "{at}: {slope}");
        }
    }

    #[test]
    fn a_weight_is_so_many_samples() {
        let samples = drawn(|x, y| x + y - 3.0);
        let heavy = samples.iter().map(|sample| Sample { weight: 3.0, ..*sample });
        let heavy = fit_surface(&heavy.collect::<Vec<_>>(), [ROWS, COLUMNS], &[]);
        assert_eq!(heavy, fit_surface(&samples.repeat(3), [ROWS, COLUMNS], &[]));
    }

    #[test]
    fn what_goes_against_the_evidence_is_levelled_and_borders_are_kept() {
        let table = fit_surface(&drawn(|x, y| x - y), [ROWS, COLUMNS], &[]);
        let rows: Vec<&[f64]> = table.chunks(3).collect();
        for pair in rows.windows(2) {
            assert!(pair[0].is_sorted() && pair[0].iter().zip(pair[1]).all(|(a, b)| a <= b));
        }
        let pinned = fit_surface(&drawn(|x, y| x + y), [ROWS, COLUMNS], &border(ROWS.knots, 3));
        assert_eq!((pinned[2], pinned[9]), (0.0, 4.0));
    }
}
