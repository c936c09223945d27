//! Which points an SMO step moves.

use cloudtouch_geom::Vector3;

use crate::lanes::{Lane, Lanes, Largest};
use crate::problem::Problem;
use crate::problem::kernel::Kernel;
use crate::smo::rows::KernelRows;
use crate::smo::state::{Numbers, State};

/// Two points to move against one another, and what that gains about.
pub(crate) struct Pair {
    pub(crate) i: usize,
    pub(crate) j: usize,
    pub(crate) gain: f64,
}

/// The maximal violator among the points that may go up, and the partner of the largest
/// second-order gain; `None` when no pair violates the optimality conditions beyond rounding.
pub(crate) fn choose_pair(state: &State<'_>, rows: &mut KernelRows) -> Option<Pair> {
    let arch = pulp::Arch::new();
    let (i, highest) = arch.dispatch(Riser { problem: state.problem, numbers: &state.numbers })?;
    rows.ensure(state.problem, i);
    let (j, gain) = arch.dispatch(Partner {
        problem: state.problem,
        numbers: &state.numbers,
        x: &state.problem.points[i].x,
        row: rows.row(i),
        highest,
    })?;
    Some(Pair { i, j, gain })
}

/// The point whose cone vector, turned against the gradient, gains most, and how much.
pub(crate) fn most_misaligned(state: &State<'_>) -> (usize, f64) {
    pulp::Arch::new().dispatch(Misaligned { numbers: &state.numbers }).unwrap_or((0, 0.0))
}

/// By how much cα may still rise or, times −1, fall at each of some points; 0 beyond the last.
#[inline(always)]
fn room(upwards: bool, sign: Lane, alpha: Lane, penalty: Lane) -> Lane {
    let rest = penalty - alpha;
    let [of_a, of_b] = if upwards { [rest, alpha] } else { [alpha, rest] };
    Lane::from_fn(|k| if sign.0[k] > 0.0 { of_a.0[k] } else { of_b.0[k] })
}

/// c y: the value that b must not fall below where cα may rise, nor exceed where it may fall.
#[inline(always)]
fn bound_of_bias(sign: Lane, f: Lane, norm: Lane) -> Lane {
    sign * (Lane::splat(1.0) - sign * f + norm)
}

struct Riser<'a> {
    problem: &'a Problem,
    numbers: &'a Numbers,
}

impl pulp::NullaryFnOnce for Riser<'_> {
    type Output = Option<(usize, f64)>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (signs, penalties) = (self.problem.signs.lanes(), self.problem.penalties.lanes());
        let (alpha, field) = (self.numbers.alpha.lanes(), &self.numbers.field);
        let (f, norm) = (field.f.lanes(), field.norm.lanes());
        let n = alpha.len();
        let [signs, penalties, f, norm] = [signs, penalties, f, norm].map(|lanes| &lanes[..n]);
        let mut best = Largest::above(f64::NEG_INFINITY);
        for k in 0..n {
            let value = bound_of_bias(signs[k], f[k], norm[k]);
            let room = room(true, signs[k], alpha[k], penalties[k]);
            let may = |l: usize| if room.0[l] > 0.0 { value.0[l] } else { f64::NEG_INFINITY };
            best.see(k, Lane::from_fn(may));
        }
        best.found()
    }
}

struct Partner<'a> {
    problem: &'a Problem,
    numbers: &'a Numbers,
    x: &'a Vector3,
    row: &'a [Lane],
    highest: f64,
}

impl pulp::NullaryFnOnce for Partner<'_> {
    type Output = Option<(usize, f64)>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self { problem, numbers, x, row, highest } = self;
        let (signs, penalties) = (problem.signs.lanes(), problem.penalties.lanes());
        let places = problem.places.each_ref().map(Lanes::lanes);
        let from = [x.x, x.y, x.z].map(Lane::splat);
        let (alpha, field) = (numbers.alpha.lanes(), &numbers.field);
        let (f, norm) = (field.f.lanes(), field.norm.lanes());
        let n = alpha.len();
        let [signs, penalties, f, norm] = [signs, penalties, f, norm].map(|lanes| &lanes[..n]);
        let (places, row) = (places.map(|lanes| &lanes[..n]), &row[..n]);
        // In margins, as y is: what is left below this is rounding.
        let threshold = highest - 1e-14 * highest.abs().max(1.0);
        let mut best = Largest::above(0.0);
        for k in 0..n {
            let value = bound_of_bias(signs[k], f[k], norm[k]);
            let room = room(false, signs[k], alpha[k], penalties[k]);
            let curvature = match problem.kernel {
                Kernel::Gaussian { .. } => Lane::splat(-2.0) * row[k],
                Kernel::Linear => {
                    let d: [Lane; 3] = std::array::from_fn(|axis| from[axis] - places[axis][k]);
                    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
                }
            };
            let missing = Lane::splat(highest) - value;
            // Duplicates have no curvature: the step between them runs to a bound.
            let least = f64::MIN_POSITIVE;
            let curvature =
                Lane::from_fn(|l| if curvature.0[l] > least { curvature.0[l] } else { least });
            let gain = missing * missing / curvature;
            let gain = Lane::from_fn(|l| if value.0[l] < threshold { gain.0[l] } else { 0.0 });
            best.see(k, Lane::from_fn(|l| if room.0[l] > 0.0 { gain.0[l] } else { 0.0 }));
        }
        best.found()
    }
}

struct Misaligned<'a> {
    numbers: &'a Numbers,
}

impl pulp::NullaryFnOnce for Misaligned<'_> {
    type Output = Option<(usize, f64)>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (alpha, norm) = (self.numbers.alpha.lanes(), self.numbers.field.norm.lanes());
        let p = self.numbers.p_lanes().each_ref().map(Lanes::lanes);
        let g = self.numbers.field.scaled.each_ref().map(Lanes::lanes);
        let n = alpha.len();
        let (norm, p, g) = (&norm[..n], p.map(|p| &p[..n]), g.map(|g| &g[..n]));
        let mut best = Largest::above(0.0);
        for k in 0..n {
            let turned = p[0][k] * g[0][k] + p[1][k] * g[1][k] + p[2][k] * g[2][k];
            best.see(k, alpha[k] * norm[k] + turned);
        }
        best.found()
    }
}
