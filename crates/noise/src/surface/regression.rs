//! The height of a surface about a point by weighted least squares, and how far it may be off.

use cloudtouch_geom::Vector3;

use crate::lanes::{Lanes, Machine};
use crate::surface::patch::Patch;
use crate::surface::reweight::{TUKEY_CUT, sums, tukey};

/// The variance of standard normal residuals weighted by Tukey factors that end at
/// [`TUKEY_CUT`]: ∫ t x² φ / ∫ t φ with t = (1 − x²/9)².
const TUKEY_VARIANCE: f64 = 0.632;
/// What is so many standard deviations less than expected was not left by chance.
const SELDOM: f64 = 2.5;
/// The squared radius of a ball over the variance of places all over it, along any axis.
const BALL: f64 = 5.0;
/// The largest variance of the normal that still says where the surface faces: about 20°.
const MOST_TILT_VARIANCE: f64 = 0.125;

/// Two tangents and a normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) tangents: [Vector3; 2],
    pub(crate) normal: Vector3,
}

impl Frame {
    #[inline(always)]
    pub(crate) fn new(normal: Vector3) -> Self {
        // The axis least along the normal gives the best conditioned tangent.
        let axis = Vector3::ith(normal.iamin(), 1.0);
        let first = normal.cross(&axis).normalize();
        Self { tangents: [first, normal.cross(&first)], normal }
    }

    /// Two coordinates across the normal and the height along it.
    #[inline(always)]
    pub(crate) fn coordinates<S: Machine>(&self, [x, y, z]: [Lanes<S>; 3]) -> [Lanes<S>; 3] {
        let [s, t] = &self.tangents;
        let n = &self.normal;
        [x * s.x + y * s.y + z * s.z, x * t.x + y * t.y + z * t.z, x * n.x + y * n.y + z * n.z]
    }
}

/// Coefficients of a height c₀ + c₁a + c₂b + c₃(a²+b²) over the tangents of a frame.
pub(crate) type Coefficients = [f64; 4];

/// How far places at these coordinates, of which the first two have the squares q, are above a
/// surface, m.
#[inline(always)]
pub(crate) fn residuals<S: Machine>(
    machine: S,
    [a, b, z]: [Lanes<S>; 3],
    q: Lanes<S>,
    coefficients: &Coefficients,
) -> Lanes<S> {
    let [c0, c1, c2, c3] = *coefficients;
    z - (Lanes::splat(machine, c0) + a * c1 + b * c2 + q * c3)
}

/// The squared distances of places from a surface along the normal of its frame, and from the point across it,
/// m²; the places are relative to the point.
#[inline(always)]
pub(crate) fn squared_residual_and_reach<S: Machine>(
    machine: S,
    offsets: [Lanes<S>; 3],
    (frame, coefficients): (&Frame, &Coefficients),
) -> [Lanes<S>; 2] {
    let coordinates = frame.coordinates(offsets);
    let [a, b, _] = coordinates;
    let reach = a * a + b * b;
    let residual = residuals(machine, coordinates, reach, coefficients);
    [residual * residual, reach]
}

/// Weighted sums over the neighbours of 1, a, b, q = a²+b², z and their products.
#[derive(Debug)]
struct Moments {
    /// Σw, with w relative to the point's own precision, so that leverage is in units of s².
    weight: f64,
    /// Weighted means of a, b, q and z.
    mean: [f64; 4],
    /// Weighted sums of products about these means; only the upper triangle.
    product: [[f64; 4]; 4],
    /// Σt of the Tukey factors alone, and Σt².
    agreement: f64,
    agreement_squared: f64,
}

impl Moments {
    /// Weighs the neighbours by their agreement with a surface of these coefficients.
    #[inline(always)]
    fn of<S: Machine>(
        machine: S,
        patch: &Patch,
        frame: &Frame,
        coefficients: &Coefficients,
    ) -> Self {
        let own = patch.own_variance(&frame.normal);
        let precisions = patch.precisions(&frame.normal);
        let inverse_cut = 1.0 / (TUKEY_CUT * TUKEY_CUT);
        let [mut total, mut agreed, mut agreed_squared] = [Lanes::zero(machine); 3];
        let mut first = [Lanes::zero(machine); 4];
        let mut second = [[Lanes::zero(machine); 4]; 4];
        for group in 0..patch.groups() {
            let offsets = patch.group(machine, group);
            let present = patch.present(machine, group);
            let precision = precisions.group(machine, group);
            let [a, b, z] = frame.coordinates(offsets);
            let q = a * a + b * b;
            let residual = residuals(machine, [a, b, z], q, coefficients);
            let agreement = tukey(machine, residual * residual * precision * inverse_cut) * present;
            let weight = agreement * precision * own;
            total += weight;
            agreed += agreement;
            agreed_squared += agreement * agreement;
            let values = [a, b, q, z];
            for r in 0..4 {
                let weighted = weight * values[r];
                first[r] += weighted;
                for c in r..4 {
                    second[r][c] += weighted * values[c];
                }
            }
        }
        let weight = total.sum();
        let per_weight = 1.0 / weight;
        let mean = sums(first).map(|sum| sum * per_weight);
        let [on_a, on_b, on_q, on_z] = second;
        let mut product = [sums(on_a), sums(on_b), sums(on_q), sums(on_z)];
        for r in 0..4 {
            for c in r..4 {
                product[r][c] -= weight * mean[r] * mean[c];
            }
        }
        let (agreement, agreement_squared) = (agreed.sum(), agreed_squared.sum());
        Self { weight, mean, product, agreement, agreement_squared }
    }

    /// Regression of the height on a, b and 1, and on q after these; `s2` is the point's own
    /// variance. `None` when the neighbours do not determine a plane.
    #[inline(always)]
    fn regress(&self, s2: f64) -> Option<Regression> {
        let [a, b, q, z] = self.mean;
        let [[aa, ab, aq, az], [_, bb, bq, bz], [_, _, qq, qz], [_, _, _, zz]] = self.product;
        // Smallest eigenvalue of the tangential scatter: where it is no more than noise, the
        // neighbours lie about one line and any plane through it would do.
        let determinant = aa * bb - ab * ab;
        let half_trace = 0.5 * (aa + bb);
        let least = determinant / (half_trace + (half_trace.powi(2) - determinant).max(0.0).sqrt());
        let degrees = self.agreement.powi(2) / self.agreement_squared - 3.0;
        // Written so that NaN, which a patch without any weight gives, counts as undetermined.
        if !(least * MOST_TILT_VARIANCE > s2 && degrees > 0.5) {
            return None;
        }
        let [aa_over, ab_over, bb_over] = [aa, ab, bb].map(|entry| entry / determinant);
        let solve = |on_a: f64, on_b: f64| {
            [bb_over * on_a - ab_over * on_b, aa_over * on_b - ab_over * on_a]
        };
        let slope = solve(az, bz);
        let centre = solve(a, b);
        let bend = solve(aq, bq);
        let curve_squares = qq - bend[0] * aq - bend[1] * bq;
        // Samples all at one distance cannot tell curvature from height.
        let determined = curve_squares > 1e-9 * qq;
        let curve_product = qz - bend[0] * az - bend[1] * bz;
        let curve_here = bend[0] * a + bend[1] * b - q;
        let curvature = if determined { curve_product / curve_squares } else { 0.0 };
        let flat_height = z - slope[0] * a - slope[1] * b;
        let flat_squares = (zz - slope[0] * az - slope[1] * bz).max(0.0);
        // What the residuals vary by beyond the noise, and how far that is by chance.
        let per_agreement = 1.0 / (TUKEY_VARIANCE * self.agreement);
        let beyond = |squares: f64| squares * per_agreement - s2;
        let chance = s2 * (2.0 / degrees).sqrt();
        let leverage = 1.0 / self.weight + centre[0] * a + centre[1] * b;
        let curved_squares = (flat_squares - curvature * curve_product).max(0.0);
        Some(Regression {
            flat: [flat_height, slope[0], slope[1], 0.0],
            curved: [
                flat_height + curvature * curve_here,
                slope[0] - curvature * bend[0],
                slope[1] - curvature * bend[1],
                curvature,
            ],
            flat_error: HeightError {
                leverage: s2 * leverage.min(1.0),
                bend: (curvature * curve_here).powi(2),
                beyond: beyond(flat_squares),
                chance,
            },
            curved_error: determined.then(|| HeightError {
                leverage: s2 * (leverage + curve_here.powi(2) / curve_squares).min(1.0),
                bend: 0.0,
                beyond: beyond(curved_squares),
                chance,
            }),
        })
    }
}

/// Fits a surface to the neighbours, weighted by their agreement with one of these coefficients.
/// `None` when they do not determine a plane.
#[inline(always)]
pub(crate) fn regress<S: Machine>(
    machine: S,
    patch: &Patch,
    frame: &Frame,
    coefficients: &Coefficients,
) -> Option<Regression> {
    let s2 = patch.own_variance(&frame.normal);
    Moments::of(machine, patch, frame, coefficients).regress(s2)
}

/// Two surfaces through the same neighbours, and what is known of the errors of their heights at the
/// point.
pub(crate) struct Regression {
    pub(crate) flat: Coefficients,
    pub(crate) curved: Coefficients,
    pub(crate) flat_error: HeightError,
    pub(crate) curved_error: Option<HeightError>,
}

impl Regression {
    /// Whether a curved surface may be the better one: not where noise and chance explain what is left of the
    /// plane, and a curvature makes the height less sure than it moves it.
    #[inline(always)]
    pub(crate) fn may_curve(&self) -> bool {
        let flat = &self.flat_error;
        flat.beyond > flat.chance
            || self.curved_error.is_some_and(|curved| curved.leverage < flat.leverage + flat.bend)
    }
}

/// What the error of a height is made of, m².
#[derive(Clone, Copy)]
pub(crate) struct HeightError {
    pub(crate) leverage: f64,
    pub(crate) bend: f64,
    /// What the residuals vary by beyond the noise; less than nothing by chance.
    pub(crate) beyond: f64,
    /// The standard deviation of that.
    pub(crate) chance: f64,
}

impl HeightError {
    /// The error to be expected, by which neighbourhoods and models are chosen.
    pub(crate) fn expected(&self) -> f64 {
        self.leverage + self.bend + 2.0 * (self.beyond - self.chance).max(0.0)
    }

    /// How much of a noise of this variance the residuals do not show, m²: all of it where they are nothing, less the
    /// more they vary, and none where by chance as little is left once in 160 times ([`SELDOM`]). Neighbours no
    /// farther away than the square root of `reach` (m²) show no more of it than a ball so large lets them.
    ///
    /// χ² of k degrees, over k, is less than (1 − 2/9k − 2.5 √(2/9k))³ so seldom (Wilson and Hilferty, 1931).
    pub(crate) fn shared(&self, noise: f64, reach: f64) -> f64 {
        if self.beyond >= 0.0 {
            return 0.0;
        }
        // √(2/k).
        let chance = self.chance / noise;
        let by_chance = (1.0 - chance * chance / 9.0 - SELDOM / 3.0 * chance).max(0.0).powi(3);
        let in_reach = reach / (reach + BALL * noise);
        let seen = 1.0 + self.beyond / noise;
        let least = by_chance * in_reach;
        if seen < least { noise * (1.0 - seen / least) } else { 0.0 }
    }
}
